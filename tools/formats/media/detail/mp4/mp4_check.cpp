#include "tools/formats/media/detail/mp4/mp4_check.h"

#include <array>
#include <vector>

#include "tools/formats/media/detail/mp4/boxes.h"

namespace animeme::media {
namespace {

constexpr int kMostTopBoxes = 4096;
constexpr std::uint64_t kLargestMoov = std::uint64_t(64) << 20;

struct TopBoxes {
  std::uint64_t moov = 0;
  std::uint64_t moov_size = 0;  // 0: there is none
  bool fragmented = false;
};

TopBoxes find_top_boxes(std::uint64_t size, const ReadAt& read) {
  TopBoxes top;
  std::uint64_t at = 0;
  for (int i = 0; i < kMostTopBoxes && size - at >= 8; ++i) {
    std::array<std::uint8_t, 16> header{};
    const std::size_t want = size - at >= 16 ? 16 : 8;
    if (!read(at, std::span(header).first(want))) break;
    const std::string_view type(reinterpret_cast<const char*>(header.data()) + 4, 4);
    std::uint64_t box_size = read_big_endian(header, 0, 4);
    if (box_size == 1) box_size = read_big_endian(header, 8, 8);
    if (box_size == 0 || box_size > size - at) box_size = size - at;
    if (type == "moof") top.fragmented = true;
    if (type == "moov" && top.moov_size == 0) {
      top.moov = at;
      top.moov_size = box_size;
    }
    if (box_size < 8 || (top.fragmented && top.moov_size != 0)) break;
    at += box_size;
  }
  return top;
}

}  // namespace

Result<std::vector<MetadataTrack>> look_at_mp4(std::uint64_t size, const ReadAt& read) {
  const TopBoxes top = find_top_boxes(size, read);
  if (top.moov_size == 0) return std::vector<MetadataTrack>();
  const Error damaged = make_error(Code::syntax, "the contents of this fragmented mp4 are damaged");
  std::vector<std::uint8_t> moov;
  if (top.moov_size <= kLargestMoov) moov.resize(static_cast<std::size_t>(top.moov_size));
  const bool whole = !moov.empty() && read(top.moov, moov);
  if (!top.fragmented) return whole ? metadata_tracks(moov) : std::vector<MetadataTrack>();
  const Box box = whole ? box_at(moov, 0, moov.size()) : Box();
  if (box.begin == 0) return damaged;
  bool good = true;
  const std::size_t end = for_each_box(moov, box.begin, box.end, [&](const Box& inner) {
    if (inner.type == "trak") good = good && track_id(moov, inner) - 1 < 0x7FFFFFFF;
  });
  if (!good || end != box.end) return damaged;
  return metadata_tracks(moov);
}

}  // namespace animeme::media
