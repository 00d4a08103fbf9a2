// Who is connected from where, and what one address or all of them together may take. Knows nothing
// of sockets. Not thread safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace animeme::web {

/// What may be taken.
struct ConnectionLimits {
  int viewers = 64;      ///< all together
  int per_address = 32;  ///< connections; 0: any number, of requests, too
  double patience = 20;  ///< seconds after which an answer that is not read is dropped
};

class ConnectionLimiter {
 public:
  using Clock = std::chrono::steady_clock;
  using Key = const void*;  ///< a connection

  /// Connections that watch nothing (yet), from everywhere.
  static constexpr std::size_t kMostPassing = 192;
  /// Seconds for a whole request, from the connection or the last answer on.
  static constexpr double kRequestSeconds = 5;
  /// Requests of an address: so many at once, then so many a second.
  static constexpr double kBurst = 120, kRate = 20;

  explicit ConnectionLimiter(const ConnectionLimits& limits) : limits_(limits) {}

  /// May one more come from there? It may, too, if one that has asked for nothing yet can make
  /// room: overdue() then names it.
  bool may_enter(const std::string& address) const;
  void enter(Key key, const std::string& address, Clock::time_point now);
  void leave(Key key);  ///< known or not

  /// It has asked for something. False: its address asks too often.
  bool ask(Key key, Clock::time_point now);
  /// A part of the answer was taken.
  void progress(Key key, Clock::time_point now);
  /// It has its answer and may ask again.
  void answered(Key key, Clock::time_point now);
  /// It stays, for a sound or a face. False: there are as many viewers as there may be.
  bool watch(Key key, bool sound);

  /// Those that are to be disconnected; each is named once.
  std::vector<Key> overdue(Clock::time_point now);

  /// A viewer has a connection for the face, one for the sound, or both. Which belong together is
  /// not known within an address: there the larger number counts.
  int viewers() const;

 private:
  enum class Phase : std::uint8_t { asking, taking, watching_face, watching_sound, leaving };
  struct Connection {
    std::string address;
    Phase phase = Phase::asking;
    std::uint64_t number = 0;  // the lower, the longer it is here
    Clock::time_point since;   // of the phase, or of the last progress
  };
  struct Budget {
    double requests = kBurst;  // that may be made now
    Clock::time_point filled;
  };
  /// Of one address, or of all (nullptr).
  std::size_t passing(const std::string* address) const;
  std::size_t all_of(const std::string& address) const;
  Connection* longest_asking(const std::string* address, Key* key);

  ConnectionLimits limits_;
  std::map<Key, Connection> connections_;
  std::map<std::string, Budget> budgets_;  // of addresses that have asked lately
  std::uint64_t entered_ = 0;
};

}  // namespace animeme::web
