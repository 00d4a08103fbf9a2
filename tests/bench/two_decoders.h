// One stream by the library and by its C interface, in pieces as it arrives.
#pragma once

#include <animeme/animeme.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <span>

#include "codec/decode/decoder.h"

namespace animeme::bench {

inline constexpr std::size_t kPiece = 100;  ///< bytes that arrive at a time

/// Seconds of the CPU that this thread has had.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
}

/// What was decoded: how many planes, and the sum of FAP 3, so that values are looked at.
struct Decoded {
  std::size_t planes = 0;
  std::int64_t sum = 0;
  bool operator==(const Decoded&) const = default;
};

inline Decoded decode_by_cpp(std::span<const std::uint8_t> stream) {
  fba::Decoder decoder;
  Decoded decoded;
  for (std::size_t at = 0; at < stream.size(); at += kPiece) {
    decoder.push(stream.subspan(at, std::min(kPiece, stream.size() - at)));
    while (const auto event = decoder.next()) {
      if (event->kind != fba::Event::Kind::plane) continue;
      ++decoded.planes;
      decoded.sum += event->plane.face.value[3];
    }
  }
  return decoded;
}

inline Decoded decode_by_c(std::span<const std::uint8_t> stream) {
  Decoded decoded;
  animeme_decoder* decoder = nullptr;
  if (animeme_decoder_new(&decoder, nullptr) != ANIMEME_OK) return decoded;
  animeme_frame frame;
  animeme_frame_init(&frame, sizeof frame);
  for (std::size_t at = 0; at < stream.size(); at += kPiece) {
    animeme_decoder_push(decoder, stream.data() + at, std::min(kPiece, stream.size() - at),
                         nullptr);
    while (animeme_decoder_next(decoder, &frame, nullptr, nullptr) == ANIMEME_OK) {
      ++decoded.planes;
      decoded.sum += frame.value[2];
    }
  }
  animeme_decoder_free(decoder);
  return decoded;
}

}  // namespace animeme::bench
