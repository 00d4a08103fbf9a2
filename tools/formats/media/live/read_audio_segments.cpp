#include <optional>
#include <string>

#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/live/audio_segments.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMostPackets = 4096;

Error damaged() { return make_error(Code::syntax, "not a segment of sound, or damaged"); }

/// Content of the box with this path of types below [begin, end).
std::optional<Box> find(Bytes bytes, std::size_t begin, std::size_t end, const std::string& path) {
  std::optional<Box> found;
  for_each_box(bytes, begin, end, [&](const Box& box) {
    if (found || box.type != path.substr(0, 4)) return;
    found = path.size() <= 4 ? box : find(bytes, box.begin, box.end, path.substr(5));
  });
  return found;
}

/// Content of the descriptor with this tag in [at, end).
std::optional<Box> find_descriptor(Bytes bytes, std::size_t at, std::size_t end, unsigned tag) {
  while (at + 2 <= end) {
    const unsigned found = bytes[at++];
    std::size_t size = 0;
    for (int i = 0; i < 4 && at < end; ++i) {
      size = size << 7 | (bytes[at] & 0x7F);
      if ((bytes[at++] & 0x80) == 0) break;
    }
    if (size > end - at) return {};
    if (found == tag) return Box{{}, at, at + size};
    at += size;
  }
  return {};
}

std::optional<std::vector<std::uint8_t>> read_esds(Bytes bytes, const Box& entry) {
  const auto esds = find(bytes, entry.begin, entry.end, "esds");
  if (!esds || esds->end - esds->begin < 4) return {};
  const auto stream = find_descriptor(bytes, esds->begin + 4, esds->end, 3);
  if (!stream || stream->end - stream->begin < 3) return {};
  const auto decoder = find_descriptor(bytes, stream->begin + 3, stream->end, 4);
  if (!decoder || decoder->end - decoder->begin < 13) return {};
  const auto config = find_descriptor(bytes, decoder->begin + 13, decoder->end, 5);
  if (!config) return {};
  const auto at = [&](std::size_t i) { return bytes.begin() + std::ptrdiff_t(i); };
  return std::vector<std::uint8_t>(at(config->begin), at(config->end));
}

}  // namespace

Result<AudioFormat> read_audio_init(Bytes segment) {
  const auto mdhd = find(segment, 0, segment.size(), "moov/trak/mdia/mdhd");
  const auto stsd = find(segment, 0, segment.size(), "moov/trak/mdia/minf/stbl/stsd");
  const auto trex = find(segment, 0, segment.size(), "moov/mvex/trex");
  if (!mdhd || !stsd || !trex) return damaged();
  if (mdhd->end - mdhd->begin < 24 || stsd->end - stsd->begin < 8 || trex->end - trex->begin < 24) {
    return damaged();
  }
  const Box entry = box_at(segment, stsd->begin + 8, stsd->end);
  if (entry.begin == 0 || entry.end - entry.begin < 28) return damaged();
  AudioFormat format;
  format.sample_rate = int(read_big_endian(segment, mdhd->begin + 12, 4) & 0xFFFFFF);
  format.channels = int(read_big_endian(segment, entry.begin + 16, 2));
  format.frame_samples = int(read_big_endian(segment, trex->begin + 12, 4) & 0xFFFFFF);
  Box inner = entry;
  inner.begin += 28;
  if (entry.type == "Opus") {
    const auto box = find(segment, inner.begin, inner.end, "dOps");
    if (!box || box->end - box->begin < 11) return damaged();
    format.codec = AudioCodec::opus;
    format.config =
        opus_head(format.channels, 0, unsigned(read_big_endian(segment, box->begin + 8, 2)));
  } else if (auto config = read_esds(segment, inner)) {
    format.config = std::move(*config);
  }
  if (format.config.empty() || format.sample_rate == 0 || format.channels == 0) return damaged();
  return format;
}

Result<std::vector<AudioPacket>> read_audio_segment(Bytes segment) {
  const auto tfdt = find(segment, 0, segment.size(), "moof/traf/tfdt");
  const auto trun = find(segment, 0, segment.size(), "moof/traf/trun");
  const auto mdat = find(segment, 0, segment.size(), "mdat");
  if (!tfdt || !trun || !mdat) return damaged();
  if (tfdt->end - tfdt->begin < 12 || trun->end - trun->begin < 12) return damaged();
  auto time = std::int64_t(read_big_endian(segment, tfdt->begin + 4, 8) & 0x7FFFFFFFFFFFF);
  const auto count = std::size_t(read_big_endian(segment, trun->begin + 4, 4));
  const std::size_t sizes_at = trun->begin + 12;
  if (count > kMostPackets || trun->end - sizes_at < 8 * count) return damaged();
  std::vector<AudioPacket> packets;
  std::size_t at = mdat->begin;
  for (std::size_t i = 0; i < count; ++i) {
    const auto duration = std::int64_t(read_big_endian(segment, sizes_at + 8 * i, 4));
    const auto size = std::size_t(read_big_endian(segment, sizes_at + 8 * i + 4, 4));
    if (size == 0 || size > mdat->end - at || duration == 0) return damaged();
    const auto begin = segment.begin() + std::ptrdiff_t(at);
    packets.push_back({{begin, begin + std::ptrdiff_t(size)}, time, duration});
    time += duration;
    at += size;
  }
  return packets;
}

}  // namespace animeme::media
