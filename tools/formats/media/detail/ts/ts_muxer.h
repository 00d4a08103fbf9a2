// libavformat's mpegts writer, into memory and one unit at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ts/ts_pmt.h"
#include "tools/formats/media/live/live.h"

namespace animeme::media {

class TsMuxer {
 public:
  /// `table_period`: seconds between PAT and PMT. Errors: invalid_argument (nothing to send, not
  /// the configuration of a face), unsupported (sound that TS cannot carry).
  static Result<std::unique_ptr<TsMuxer>> open(const LiveInfo& info, double table_period);
  ~TsMuxer();
  TsMuxer(const TsMuxer&) = delete;
  TsMuxer& operator=(const TsMuxer&) = delete;

  /// Transport packets of this unit, tables in front of it when they are due. Errors:
  /// invalid_argument (no such track, too early, times that do not ascend).
  Result<std::vector<std::uint8_t>> write(const LiveUnit& unit);

 private:
  TsMuxer() = default;
  Result<void> start(double table_period);
  Result<void> add_face();
  Result<void> add_sound();
  static int collect(void* self, std::uint8_t* bytes, int size);

  LiveInfo info_;
  ProgramMapFilter program_map_{0x61};
  std::vector<std::uint8_t> bytes_;
  AVFormatContext* context_ = nullptr;
  av::Io io_;
  AVStream* streams_[2] = {nullptr, nullptr};  // by LiveTrack
  std::int64_t last_[2] = {INT64_MIN, INT64_MIN};
  av::Packet packet_;
};

}  // namespace animeme::media
