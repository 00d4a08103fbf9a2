/// @file
/// Several live addresses as one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/commands/common.h"
#include "tools/commands/live_address.h"

namespace animeme::tools {

/// What is sent to one address, and how that goes.
struct LiveAddress {
  std::string url;                        ///< as given
  std::unique_ptr<media::LiveSink> sink;  ///< never null
  bool broken = false;                    ///< left behind after an error
};

/// All addresses of a stream. One that breaks while it runs is left behind with a warning as long
/// as another one works.
class LiveSinks {
 public:
  /// `sdp` names the session descriptions of the rtp addresses, in their order; fewer will do.
  /// Errors: those of open_live_sink(), with the address.
  static Result<LiveSinks> open(const std::vector<std::string>& urls,
                                const std::vector<std::string>& sdp,
                                const LiveSinkOptions& options);

  /// Errors: of any address.
  Result<void> start(const media::LiveInfo& info);
  /// Errors: when the last address breaks.
  Result<void> send(const media::LiveUnit& unit);
  Result<void> poll();  ///< as LiveSink::poll(), everywhere
  /// Says goodbye everywhere; the first error.
  Result<void> finish();

  const std::vector<LiveAddress>& addresses() const { return addresses_; }  ///< in the order given
  /// Of all addresses: receivers are added up, the largest loss counts.
  media::SendStats stats() const;

 private:
  template <class Act>
  Result<void> each(Act act);

  std::vector<LiveAddress> addresses_;
};

}  // namespace animeme::tools
