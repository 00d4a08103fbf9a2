#include "tools/live/engines/detail/live_link.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::engines {
namespace {

using media::ByteVector;
using media::put;
using media::WireReader;

constexpr std::uint8_t kVersion = 6;
constexpr std::size_t kMostText = 256;
constexpr std::int32_t kMostBelieved = 100'000;  // frames a second, for a rate that can be believed

// Channel of the value at a place of the packet.
constexpr std::array<std::size_t, fap::kArkitChannelCount> packet_order() {
  std::array<std::size_t, fap::kArkitChannelCount> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::swap(order[15], order[16]);  // jaw to the left, to the right
  std::swap(order[21], order[22]);  // mouth likewise
  return order;
}
constexpr auto kOrder = packet_order();

void put_name(ByteVector& out, const std::string& text) {
  put(out, text.size(), 4);
  out.insert(out.end(), text.begin(), text.end());
}

std::optional<std::string> take_name(WireReader& in) {
  const std::uint32_t size = in.u32();
  if (in.failed() || size > kMostText) return std::nullopt;
  const auto bytes = in.take(size);
  if (in.failed()) return std::nullopt;
  std::string text(bytes.begin(), bytes.end());
  return text.substr(0, text.find('\0'));  // some count the zero
}

void put_real(ByteVector& out, double value) {
  put(out, std::bit_cast<std::uint32_t>(float(value)), 4);
}

}  // namespace

std::optional<double> LiveLinkPacket::seconds() const {
  if (rate <= 0 || denominator <= 0 || rate > kMostBelieved || !(part >= 0 && part <= 1)) {
    return std::nullopt;
  }
  return (double(frame) + double(part)) * denominator / rate;
}

std::vector<std::uint8_t> write_live_link(const LiveLinkPacket& packet) {
  ByteVector out{kVersion};
  put_name(out, packet.device);
  put_name(out, packet.subject);
  if (!packet.face) return out;
  put(out, std::uint32_t(packet.frame), 4);
  put_real(out, double(packet.part));
  put(out, std::uint32_t(packet.rate), 4);
  put(out, std::uint32_t(packet.denominator), 4);
  put(out, kOrder.size(), 1);
  for (const std::size_t channel : kOrder) put_real(out, packet.values[channel]);
  return out;
}

std::optional<LiveLinkPacket> read_live_link(std::span<const std::uint8_t> bytes) {
  WireReader in(bytes);
  if (in.u8() != kVersion) return std::nullopt;
  LiveLinkPacket packet;
  auto device = take_name(in);
  if (!device) return std::nullopt;
  auto subject = take_name(in);
  if (!subject) return std::nullopt;
  packet.device = std::move(*device);
  packet.subject = std::move(*subject);
  packet.face = in.left() > 17;
  if (!packet.face) return packet;
  packet.frame = std::int32_t(in.u32());
  packet.part = std::bit_cast<float>(in.u32());
  packet.rate = std::int32_t(in.u32());
  packet.denominator = std::int32_t(in.u32());
  if (in.u8() != kOrder.size() || in.left() < 4 * kOrder.size()) return std::nullopt;
  for (const std::size_t channel : kOrder) {
    const float value = std::bit_cast<float>(in.u32());
    if (!std::isfinite(value)) return std::nullopt;
    packet.values[channel] = double(value);
  }
  return packet;
}

std::string device_of(const std::string& subject) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char c : subject) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3;
  char text[40];
  std::snprintf(text, sizeof text, "%08X-%04X-4000-8000-%012llX", unsigned(hash >> 32),
                unsigned(hash >> 16 & 0xFFFF),
                static_cast<unsigned long long>(hash & 0xFFFFFFFFFFFF));
  return text;
}

}  // namespace animeme::engines
