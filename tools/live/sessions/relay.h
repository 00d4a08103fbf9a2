/// @file
/// Forwards what is received, for example from a phone to browsers.
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

/// Sends units immediately, with their times.
class Relay {
 public:
  /// Without addresses it does nothing. `sdp` as of Sinks::open(). Errors: those of Sinks::open().
  static Result<Relay> open(const std::vector<std::string>& urls,
                            const std::vector<std::string>& sdp, const tools::Log& log = {});

  bool wanted() const { return !sinks_.addresses().empty(); }  ///< whether there is an address
  /// `info` of the presentation is used with the first unit. Errors: those of Sinks.
  Result<void> send(const media::LiveInfo& info, const media::LiveUnit& unit);
  /// Call at least ten times a second. Errors: those of Sinks.
  Result<void> poll();
  /// Says goodbye everywhere. Errors: those of Sinks.
  Result<void> finish();

 private:
  Sinks sinks_;
  bool started_ = false;
};

}  // namespace animeme::live
