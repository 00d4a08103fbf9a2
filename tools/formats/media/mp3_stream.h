/// @file
/// MP3 that comes in pieces, cut anywhere.
///
///     Mp3Stream stream;
///     for (const auto& piece : pieces_as_they_come) play(*stream.push(piece));
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::media {

/// Decodes the pieces of one sound as if they came at once. A frame of MP3 needs up to 511 bytes of
/// the frames before it, so pieces that are decoded each on its own lack their first frames.
/// Movable, not copyable.
class Mp3Stream {
 public:
  Mp3Stream();
  Mp3Stream(Mp3Stream&&) noexcept;  ///< movable
  Mp3Stream& operator=(Mp3Stream&&) noexcept;
  ~Mp3Stream();

  /// Whether bytes are the begin of an MP3: an ID3 tag, or two frames in a row.
  static bool begins(std::span<const std::uint8_t> bytes);

  /// The sound of all frames that are whole by now, mixed to one channel; empty: there is none.
  /// Encoder delay is skipped where a file begins that states it. A damaged frame is silence.
  /// Errors: syntax (64 kB without a frame), unsupported (this FFmpeg has no decoder; the rate
  /// changes), out_of_range (memory).
  Result<Pcm> push(std::span<const std::uint8_t> piece);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::media
