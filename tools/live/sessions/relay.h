/// @file
/// What is received, sent on while it comes: from a phone to browsers, from a browser's sender to
/// an engine.
///
///     auto relay = Relay::open({"http://127.0.0.1:8080"}, {}, talk);
///     while (auto event = source->next(0.1)) {
///       if (auto unit = recorder.accept(*event)) relay->send(*recorder.info(), *unit);
///       relay->poll();
///     }
///     relay->finish();
#pragma once

#include <string>
#include <vector>

#include "tools/live/sessions/sinks.h"

namespace animeme::live {

/// Sends at once what it is given, with the times that it has.
class Relay {
 public:
  /// No address: it does nothing. `sdp` as of Sinks::open(). Errors: those of Sinks::open().
  static Result<Relay> open(const std::vector<std::string>& urls,
                            const std::vector<std::string>& sdp, const tools::Log& log = {});

  bool wanted() const { return !sinks_.addresses().empty(); }  ///< there is an address
  /// `info`, of the presentation, counts with the first unit. Errors: those of Sinks.
  Result<void> send(const media::LiveInfo& info, const media::LiveUnit& unit);
  /// To be called at least ten times a second. Errors: those of Sinks.
  Result<void> poll();
  /// Says goodbye everywhere. Errors: those of Sinks.
  Result<void> finish();

 private:
  Sinks sinks_;
  bool started_ = false;
};

}  // namespace animeme::live
