/// @file
/// Several live addresses as one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "codec/encode/intra_on_request.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/live/sessions/address.h"

namespace animeme::live {

/// A destination and its state.
struct Address {
  std::string url;                        ///< as given
  std::unique_ptr<media::LiveSink> sink;  ///< never null
  bool broken = false;                    ///< not used any more
};

/// All addresses of a stream. If one breaks while another still works, it is dropped with a warning
/// (log.warn of open()).
class Sinks {
 public:
  /// `sdp`: file names for the session descriptions of the rtp addresses, in order; may be fewer.
  /// Errors: those of open_sink(), with the address.
  static Result<Sinks> open(const std::vector<std::string>& urls,
                            const std::vector<std::string>& sdp, const SinkOptions& options,
                            const tools::Log& log = {});

  /// Warns if a web server is open to other machines. Errors: of any address.
  Result<void> start(const media::LiveInfo& info);
  /// A unit of the face becomes an intra plane if a receiver of an address has asked for one, for
  /// all addresses. Errors: when the last address breaks.
  Result<void> send(const media::LiveUnit& unit);
  Result<void> tell(const std::string& json);  ///< LiveSink::tell() for all
  Result<void> poll();                         ///< LiveSink::poll() for all
  /// Finishes all; returns the first error.
  Result<void> finish();

  const std::vector<Address>& addresses() const { return addresses_; }  ///< in the order of open()
  /// Of all addresses: the sum of receivers, the largest loss.
  media::SendStats stats() const;

 private:
  template <class Act>
  Result<void> each(Act act);

  std::vector<Address> addresses_;
  fba::IntraOnRequest face_;
  tools::Log log_;
};

}  // namespace animeme::live
