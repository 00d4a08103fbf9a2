// A fragmented mp4 that is still being made, and is a whole file at every instant: its contents are
// complete from the first byte on, its length is corrected as it grows, and a fragment shows itself
// when all of it is there. Source: ISO/IEC 14496-12, sections 8.1.2 (free), 8.8.2 (mehd), 8.8.4
// (moof).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

class GrowingMp4 {
 public:
  GrowingMp4() = default;
  ~GrowingMp4();
  GrowingMp4(const GrowingMp4&) = delete;
  GrowingMp4& operator=(const GrowingMp4&) = delete;

  /// The file, which is there. Error: io.
  Result<void> open(const std::string& path);
  /// What libavformat writes: `ftyp`, `moov`, then fragments. Kept until write().
  void take(std::span<const std::uint8_t> bytes);
  /// Everything that was taken, which ends with a whole box, to the file; `ticks` of the movie is
  /// its length by then. Error: io.
  Result<void> write(std::uint64_t ticks);

 private:
  std::vector<std::uint8_t> complete_head(std::span<const std::uint8_t> bytes);
  bool put(std::uint64_t at, std::span<const std::uint8_t> bytes) const;

  int file_ = -1;
  std::vector<std::uint8_t> taken_;
  std::uint64_t end_ = 0;                   // of what is in the file
  std::optional<std::uint64_t> length_at_;  // in the file; known: the head is written
};

}  // namespace animeme::media
