// Walking the boxes of ISO files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {

using Bytes = ByteSpan;

struct Box {
  std::string_view type;
  std::size_t begin = 0;  ///< of the content; 0: there is no box
  std::size_t end = 0;
};

/// The box at `at`, which must end by `end`.
inline Box box_at(Bytes bytes, std::size_t at, std::size_t end) {
  if (end > bytes.size() || at > end || end - at < 8) return {};
  std::uint64_t size = read_big_endian(bytes, at, 4);
  std::size_t header = 8;
  if (size == 1 && end - at >= 16) {
    size = read_big_endian(bytes, at + 8, 8);
    header = 16;
  }
  if (size == 0) size = end - at;
  if (size < header || size > end - at) return {};
  return {{reinterpret_cast<const char*>(bytes.data()) + at + 4, 4},
          at + header,
          at + std::size_t(size)};
}

/// Visits the boxes from `begin` on; returns where it ended: `end` if all are whole.
template <class Visit>
std::size_t for_each_box(Bytes bytes, std::size_t begin, std::size_t end, const Visit& visit) {
  std::size_t at = begin;
  for (Box box = box_at(bytes, at, end); box.begin != 0; box = box_at(bytes, at, end)) {
    visit(box);
    at = box.end;
  }
  return at;
}

/// The first box of a type in another; begin 0: there is none.
inline Box find_box(Bytes bytes, const Box& parent, std::string_view type) {
  Box found;
  for_each_box(bytes, parent.begin, parent.end, [&](const Box& box) {
    if (found.begin == 0 && box.type == type) found = box;
  });
  return found;
}

/// Fields of sample entries behind the box header, in front of boxes: any, visual, of sound
/// (version 0).
inline constexpr std::size_t kPlainFields = 8, kVisualFields = 78, kAudioFields = 28;

inline constexpr std::uint8_t kEsDescriptor = 3;  ///< tag of a descriptor in esds

/// Number of a track by its header; 0: there is none.
inline std::uint32_t track_id(Bytes moov, const Box& trak) {
  std::uint32_t id = 0;
  for_each_box(moov, trak.begin, trak.end, [&](const Box& box) {
    if (box.type != "tkhd" || box.end == box.begin) return;
    const std::size_t at = box.begin + (moov[box.begin] == 1 ? 20 : 12);
    id = at + 4 <= box.end ? std::uint32_t(read_big_endian(moov, at, 4)) : 0;
  });
  return id;
}

}  // namespace animeme::media
