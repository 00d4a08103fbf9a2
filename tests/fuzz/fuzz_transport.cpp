// libFuzzer entry: whatever comes over the network in place of a transport stream or a segment of
// sound, the readers give out units of sane sizes and hold a bounded amount back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <span>
#include <vector>

#include "tools/media/detail/ts_events.h"
#include "tools/media/live/audio_segments.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::media;
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0];  // the cut of the bytes must not matter
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  (void)read_audio_init(rest);
  if (const auto packets = read_audio_segment(rest)) {
    for (const AudioPacket& packet : *packets) {
      if (packet.bytes.empty() || packet.duration <= 0) std::abort();
    }
  }
  TsDemuxer demuxer;
  TsEvents parser;
  std::deque<LiveEvent> events;
  while (!rest.empty()) {
    std::vector<TsEvent> found;
    demuxer.push(rest.first(std::min(piece, rest.size())), found);
    rest = rest.subspan(std::min(piece, rest.size()));
    for (TsEvent& event : found) parser.push(std::move(event), events);
  }
  parser.finish(events);
  std::size_t bytes = 0;
  bool described = false;
  for (const LiveEvent& event : events) {
    described |= std::holds_alternative<LiveInfo>(event);
    if (const auto* unit = std::get_if<LiveUnit>(&event)) {
      if (unit->bytes.empty() || !described) std::abort();
      bytes += unit->bytes.size();
    }
  }
  if (bytes > size) std::abort();
  return 0;
}
