#include "tools/live/engines/detail/packet_reader.h"

#include <algorithm>
#include <utility>

#include "tools/live/engines/detail/live_link.h"

namespace animeme::engines {
namespace {

constexpr double kQuietSeconds = 0.004;  // between the packets of two frames, by 120 a second

}  // namespace

bool PacketReader::push(std::span<const std::uint8_t> bytes, double now,
                        std::vector<ReceivedFace>& out) {
  if (protocol_ == Protocol::live_link) {
    const auto packet = read_live_link(bytes);
    if (!packet) return false;
    if (packet->face) out.push_back({packet->values, fap::kAllArkit, packet->seconds(), now});
    return true;
  }
  const auto messages = read_osc(bytes);
  if (!messages) return false;
  tick(now, out);
  bool any = false;
  for (const OscMessage& message : *messages) any = push_osc(message, now, out) || any;
  return any;
}

bool PacketReader::push_osc(const OscMessage& message, double now, std::vector<ReceivedFace>& out) {
  if (protocol_ == Protocol::unified) {
    if (!unified_.take(message)) return false;
    if (!begun_) begun_ = now;
    latest_ = now;
    return true;
  }
  switch (vmc_.take(message)) {
    case VmcState::Effect::none:
      return false;
    case VmcState::Effect::some:
      return true;
    case VmcState::Effect::end:
      return end_ = true;
    case VmcState::Effect::frame:
      break;
  }
  out.push_back({vmc_.values(), vmc_.channels(), vmc_.seconds(), now});
  vmc_.next();
  return true;
}

void PacketReader::tick(double now, std::vector<ReceivedFace>& out) {
  if (!latest_ || now - *latest_ < kQuietSeconds) return;
  out.push_back({unified_.values(), unified_.channels(), std::nullopt, *begun_});
  begun_.reset();
  latest_.reset();
}

bool PacketReader::take_end() { return std::exchange(end_, false); }

std::optional<double> PacketReader::patience(double now) const {
  if (!latest_) return std::nullopt;
  return std::max(0.0, *latest_ + kQuietSeconds - now);
}

std::optional<std::string> sender_of(std::span<const std::uint8_t> bytes, Protocol protocol,
                                     const std::optional<std::string>& subject) {
  if (protocol != Protocol::live_link) return std::string();
  const auto packet = read_live_link(bytes);
  if (!packet || (subject && packet->subject != *subject)) return std::nullopt;
  return packet->device + '\n' + packet->subject;
}

}  // namespace animeme::engines
