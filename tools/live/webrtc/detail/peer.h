// What the module has of WebRTC: one connection to one browser. The module alone is linked with
// GStreamer; this header is what the program knows of it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace animeme::webrtc {

/// What a connection is opened with.
struct PeerSettings {
  std::string offer;   ///< session description of the other end; empty: we offer
  bool sound = false;  ///< there is Opus to send
  int redundant = -1;  ///< RTP payload type of sound of RFC 2198; -1: none is sent
  std::string stun;    ///< "host:port", empty: none is asked
  std::string turn;    ///< "user:password@host:port", empty: none
  /// Data channels that are opened, where we offer. Elsewhere the other end opens those it wants.
  std::vector<std::string> channels;
};

/// One connection. Its functions may be called from one thread at a time; none of them waits for
/// the network. The destructor closes the connection and waits for its threads.
class Peer {
 public:
  enum class State : std::uint8_t { connecting, connected, over };

  virtual ~Peer() = default;
  /// Where we offered: the answer.
  virtual void answered(const std::string& sdp) = 0;
  /// `over` once it failed, was closed or nothing was heard for long: then it can only be deleted.
  virtual State state() = 0;
  /// Why it is over; empty: as the other end wished.
  virtual std::string problem() = 0;
  /// The other end has opened a channel with this label.
  virtual bool has_channel(const std::string& label) = 0;
  /// That channel loses nothing and keeps the order: it is ordered, without limits of
  /// retransmission.
  virtual bool is_reliable(const std::string& label) = 0;
  /// False: dropped, as there is no such channel, or too much waits.
  virtual bool send(const std::string& label, std::span<const std::uint8_t> message, bool text) = 0;
  /// One packet of Opus; `time` of its first sample, 48000 a second, modulo 2^32: the RTP time.
  /// `redundant`: it is a payload of RFC 2198 (redundant_sound.h) whose newest packet has this
  /// time.
  virtual void send_sound(std::span<const std::uint8_t> packet, std::uint32_t time,
                          bool redundant) = 0;
  /// Share of the packets of sound that the other end lost, 0..1, by its newest report.
  virtual double reported_loss() = 0;
  /// Closes the channels, so that the other end knows soon; what was sent is on its way.
  virtual void goodbye() = 0;
};

/// `description` is ours, with all candidates, or empty with the reason in `problem`. Called once,
/// from another thread.
using Described = std::function<void(const std::string& description, const std::string& problem)>;

/// A request to a server of WHIP.
struct HttpRequest {
  std::string method, url;
  std::string token;    ///< bearer; empty: none
  std::string body;     ///< application/sdp; empty: none
  double seconds = 10;  ///< that it may take
};
struct HttpAnswer {
  int status = 0;             ///< 0: none came
  std::string location = {};  ///< a whole address; empty: none was given
  std::string body = {};
  std::string problem = {};  ///< why none came; empty: one came
};

/// The module's table.
struct Functions {
  /// Starts GStreamer, once. Empty, or what is missing.
  std::string (*begin)();
  std::unique_ptr<Peer> (*open)(const PeerSettings& settings, Described described);
  HttpAnswer (*exchange)(const HttpRequest& request);  ///< waits for the answer
};

}  // namespace animeme::webrtc
