// Datagrams of phones and avatar programs: whatever comes in, out come units that can be decoded,
// and not more of them than time and packets allow. The first byte chooses the protocol; a datagram
// is a byte of time, one of its sender, its length (big endian, two bytes) and its bytes.
#include <cstdint>
#include <deque>
#include <iterator>
#include <span>
#include <string>

#include "tests/fuzz/require.h"
#include "tools/formats/media/live/live_frames.h"
#include "tools/live/engines/detail/engine_input.h"

using animeme::test::require;

using namespace animeme;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1 || size > 100'000) return 0;
  std::span<const std::uint8_t> bytes(data, size);
  constexpr const char* kAddresses[] = {"livelink://",         "vmc://",          "osc://",
                                        "livelink://?rate=60", "vmc://?rate=120", "osc://?rate=15"};
  const auto address =
      engines::parse_engine_address(kAddresses[bytes[0] % std::size(kAddresses)], true);
  require(bool(address));
  bytes = bytes.subspan(1);
  engines::EngineInput input(*address, {.any_source = data[0] >= 128});
  std::deque<media::LiveEvent> events;
  double now = 1000;
  std::int64_t packets = 0;
  while (bytes.size() >= 4) {
    now += double(bytes[0]) / 500;
    const std::string host = "127.0.0." + std::to_string(1 + bytes[1] % 4);
    const std::size_t length = std::min(bytes.size() - 4, std::size_t(256 * bytes[2] + bytes[3]));
    const auto from = media::UdpAddress::resolve(host, 5000);
    require(from && input.tick(now, events));
    require(bool(input.push(bytes.subspan(4, length), *from, now, events)));
    bytes = bytes.subspan(4 + length);
    ++packets;
    const double most = 120 * (now - 1000 + 8 * double(input.stats().sessions + 1)) + 1000;
    require(double(events.size()) <= most);
  }
  require(input.stats().packets == packets && input.stats().foreign <= packets);
  media::LiveFrames frames(media::GapRule::skip, fap::FillOptions{.complete = true});
  std::int64_t last = -1;
  for (const media::LiveEvent& event : events) {
    if (const auto* unit = std::get_if<media::LiveUnit>(&event)) {
      require(unit->time > last && !frames.push(*unit, 90000, false).empty());
      last = unit->time;
    } else if (!std::holds_alternative<media::LiveGap>(event)) {
      last = -1;
      frames = media::LiveFrames(media::GapRule::skip, fap::FillOptions{.complete = true});
    }
  }
  return 0;
}
