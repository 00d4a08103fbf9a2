// Everything a Decoder says about a stream, to be compared.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"

namespace animeme::test {

inline bool same_body(const std::shared_ptr<const fba::BodyFrame>& a,
                      const std::shared_ptr<const fba::BodyFrame>& b) {
  return (a == nullptr) == (b == nullptr) && (a == nullptr || *a == *b);
}

struct TracedEvent {
  fba::Event event;
  Error error;  // if `failed`
  bool failed = false;

  bool operator==(const TracedEvent& other) const {
    if (failed != other.failed) return false;
    if (failed) {
      return error.code == other.error.code && error.message == other.error.message &&
             error.where.bit == other.error.where.bit;
    }
    const fba::Plane& a = event.plane;
    const fba::Plane& b = other.event.plane;
    return event.kind == other.event.kind && event.info == other.event.info &&
           event.text == other.event.text && event.bit == other.event.bit && a.intra == b.intra &&
           a.object_mask == b.object_mask && a.temporal == b.temporal && a.number == b.number &&
           a.seconds == b.seconds && a.rate == b.rate && a.face == b.face &&
           same_body(a.body, b.body) &&
           (a.face_settings == nullptr) == (b.face_settings == nullptr) &&
           a.start_code == b.start_code && a.bit_begin == b.bit_begin && a.bit_end == b.bit_end;
  }
};

/// Pushes `bytes` in pieces: `piece(i)` says how many bytes the i-th has (at least 1 are taken).
template <class Piece>
std::vector<TracedEvent> trace(std::span<const std::uint8_t> bytes, const Piece& piece) {
  fba::Decoder decoder;
  std::vector<TracedEvent> out;
  std::size_t at = 0;
  for (std::size_t i = 0;;) {
    auto event = decoder.next();
    if (event) {
      out.push_back({std::move(*event), {}, false});
      continue;
    }
    if (event.error().code == Code::need_data) {
      if (at == bytes.size()) {
        decoder.finish();
        continue;
      }
      const std::size_t size = std::max<std::size_t>(1, piece(i++));
      const std::size_t count = std::min(size, bytes.size() - at);
      decoder.push(bytes.subspan(at, count));
      at += count;
      continue;
    }
    out.push_back({{}, event.error(), true});
    if (event.error().code == Code::end_of_stream) return out;
  }
}

}  // namespace animeme::test
