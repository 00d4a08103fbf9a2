// Faces as access units on a regular grid.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "codec/encode/live.h"
#include "tools/formats/media/live/live.h"
#include "tools/live/engines/detail/packet_reader.h"

namespace animeme::engines {

class FaceCoder {
 public:
  /// `rate`: planes a second; nothing: that of the first faces, which wait until it is known.
  FaceCoder(std::optional<int> rate, double intra_seconds);

  /// `seconds` ascend from 0. Appends LiveInfo, planes, and a LiveGap where more than a second
  /// is missing. Errors: those of the encoder.
  Result<void> push(double seconds, const ReceivedFace& face, std::deque<media::LiveEvent>& out);
  /// Another sender, or time begins again: LiveInfo comes once more, at the same rate.
  void restart();

  std::optional<int> rate() const { return rate_; }
  std::int64_t late() const { return late_; }  ///< faces that had no place of their own

 private:
  struct Waiting {
    double seconds;
    ReceivedFace face;
  };
  bool measure();
  Result<void> begin(const ReceivedFace& face, std::deque<media::LiveEvent>& out);
  Result<void> place(double seconds, const ReceivedFace& face, std::deque<media::LiveEvent>& out);
  Result<void> code(const fap::ArkitFrame& values, std::deque<media::LiveEvent>& out);

  std::optional<int> rate_;
  double intra_seconds_;
  std::vector<Waiting> waiting_;
  std::unique_ptr<fba::LiveEncoder> encoder_;
  bool fresh_ = false;  // the encoder has written nothing
  bool begun_ = false;  // another one has
  fap::ArkitChannels channels_;
  std::int64_t ticks_ = 0;            // of a plane
  std::optional<std::int64_t> last_;  // place of the last plane
  fap::ArkitFrame shown_{};           // what it shows
  std::int64_t late_ = 0;
};

}  // namespace animeme::engines
