/// @file
/// Several live addresses as one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/live/sessions/address.h"

namespace animeme::live {

/// What is sent to one address, and how that goes.
struct Address {
  std::string url;                        ///< as given
  std::unique_ptr<media::LiveSink> sink;  ///< never null
  bool broken = false;                    ///< nothing is sent there any more
};

/// All addresses of a stream. One that breaks while it runs is left behind with a warning (to
/// talk.warn of open()) as long as another one works.
class Sinks {
 public:
  /// `sdp` names the session descriptions of the rtp addresses, in their order; fewer will do.
  /// Errors: those of open_sink(), with the address.
  static Result<Sinks> open(const std::vector<std::string>& urls,
                            const std::vector<std::string>& sdp, const SinkOptions& options,
                            const tools::Log& log = {});

  /// A web server that is open to other machines is warned of. Errors: of any address.
  Result<void> start(const media::LiveInfo& info);
  /// Errors: when the last address breaks.
  Result<void> send(const media::LiveUnit& unit);
  Result<void> tell(const std::string& json);  ///< as LiveSink::tell(), everywhere
  Result<void> poll();                         ///< as LiveSink::poll(), everywhere
  /// Says goodbye everywhere; the first error.
  Result<void> finish();

  const std::vector<Address>& addresses() const { return addresses_; }  ///< in the order of open()
  /// Of all addresses: receivers are added up, the largest loss counts.
  media::SendStats stats() const;

 private:
  template <class Act>
  Result<void> each(Act act);

  std::vector<Address> addresses_;
  tools::Log log_;
};

}  // namespace animeme::live
