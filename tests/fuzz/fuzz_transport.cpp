// libFuzzer entry: whatever comes over the network in place of a transport stream or a segment of
// sound, the readers give out units of sane sizes and hold a bounded amount back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tests/fuzz/require.h"
#include "tools/formats/media/detail/ts/ts_input.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/formats/media/rtp/session_clock.h"

using animeme::test::require;

namespace {

using animeme::media::UdpAddress;

const UdpAddress& address(int number) {
  static const UdpAddress all[4] = {{},
                                    *UdpAddress::resolve("192.0.2.1", 4000),
                                    *UdpAddress::resolve("192.0.2.1", 4001),
                                    *UdpAddress::resolve("192.0.2.2", 4000)};
  return all[number];
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::media;
  if (size == 0) return 0;
  std::optional<std::int64_t> ascending[2];
  const std::size_t piece = 1 + data[0];  // the cut of the bytes must not matter
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  (void)read_audio_init(rest);
  if (const auto packets = read_audio_segment(rest)) {
    for (const AudioPacket& packet : *packets) {
      require(!packet.bytes.empty() && packet.duration > 0);
    }
  }
  // The first byte of a piece says whose it is, where there are several senders.
  const bool several = data[0] % 4 == 3;
  TsInput input;
  SessionClock clock;
  double now = 0;
  std::deque<LiveEvent> events;
  while (!rest.empty()) {
    const UdpAddress& from = address(several ? rest[0] % 4 : 0);
    std::deque<LiveEvent> found, steady;
    input.push(rest.first(std::min(piece, rest.size())), from, now += 0.02, found);
    rest = rest.subspan(std::min(piece, rest.size()));
    for (LiveEvent& event : found) {
      events.push_back(event);
      clock.push(std::move(event), now, steady);
    }
    for (const LiveEvent& event : steady) {
      const auto* unit = std::get_if<LiveUnit>(&event);
      if (unit == nullptr) continue;
      std::optional<std::int64_t>& last = ascending[std::size_t(unit->track)];
      require(!last || unit->time > *last);
      last = unit->time;
    }
  }
  input.finish(events);
  std::size_t bytes = 0;
  bool described = false;
  for (const LiveEvent& event : events) {
    described |= std::holds_alternative<LiveInfo>(event);
    if (const auto* unit = std::get_if<LiveUnit>(&event)) {
      require(!unit->bytes.empty() && described);
      bytes += unit->bytes.size();
    }
  }
  require(bytes <= size);
  return 0;
}
