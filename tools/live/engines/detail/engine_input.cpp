#include "tools/live/engines/detail/engine_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace animeme::engines {
namespace {

constexpr double kQuiet = 1;  // seconds: then another sender may take over
constexpr int kProof = 2;     // packets
constexpr std::size_t kMostStrangers = 8;

}  // namespace

Result<void> EngineInput::push(std::span<const std::uint8_t> bytes, const media::UdpAddress& from,
                               double now, std::deque<media::LiveEvent>& out) {
  ++stats_.packets;
  stats_.bytes += std::int64_t(bytes.size());
  const auto name = sender_of(bytes, address_.protocol, address_.subject);
  const bool heard = name && sender_ && (options_.any_source || from == sender_->from) &&
                     (options_.any_source || *name == sender_->name);
  if (!name) {
    ++stats_.foreign;
    return {};
  }
  if (!heard) return consider(bytes, from, *name, now, out);
  std::vector<ReceivedFace> faces;
  if (!sender_->reader.push(bytes, now, faces)) {
    ++stats_.foreign;
    return {};
  }
  sender_->last = now;
  auto given = give(faces, now, out);
  look_for_end(out);
  return given;
}

void EngineInput::look_for_end(std::deque<media::LiveEvent>& out) {
  if (!sender_ || !sender_->reader.take_end()) return;
  out.emplace_back(media::LiveEnd{});
  sender_.reset();
}

Result<void> EngineInput::consider(std::span<const std::uint8_t> bytes,
                                   const media::UdpAddress& from, const std::string& name,
                                   double now, std::deque<media::LiveEvent>& out) {
  ++stats_.foreign;
  auto who = std::find_if(others_.begin(), others_.end(), [&](const Sender& each) {
    return options_.any_source || (each.from == from && each.name == name);
  });
  if (who == others_.end()) {
    PacketReader reader(address_.protocol);
    std::vector<ReceivedFace> faces;
    if (!reader.push(bytes, now, faces)) return {};
    if (others_.size() >= kMostStrangers) {  // the one that was heard longest ago
      others_.erase(std::min_element(others_.begin(), others_.end(),
                                     [](const auto& a, const auto& b) { return a.last < b.last; }));
    }
    others_.push_back({from, name, std::move(reader), now, 1, std::move(faces)});
    return {};
  }
  std::vector<ReceivedFace> faces;
  if (!who->reader.push(bytes, now, faces)) return {};
  if (now - who->last > kQuiet) {  // one packet now and then proves nothing
    who->packets = 0;
    who->faces.clear();
  }
  who->last = now;
  ++who->packets;
  const bool free = !sender_ || now - sender_->last > kQuiet;
  if (!free || who->packets < kProof) {
    who->faces = std::move(faces);
    return {};
  }
  if (stats_.sessions > 0) out.emplace_back(media::LiveRestart{});
  ++stats_.sessions;
  sender_ = std::move(*who);
  others_.erase(who);
  stats_.foreign -= std::min<std::int64_t>(stats_.foreign, kProof);
  coder_.restart();
  clock_ = {};
  transit_.reset();
  std::vector<ReceivedFace> kept = std::exchange(sender_->faces, {});
  kept.insert(kept.end(), faces.begin(), faces.end());
  auto given = give(kept, now, out);
  look_for_end(out);
  return given;
}

Result<void> EngineInput::give(const std::vector<ReceivedFace>& faces, double now,
                               std::deque<media::LiveEvent>& out) {
  for (const ReceivedFace& face : faces) {
    const auto seconds = clock_.time(face.seconds, face.arrival);
    if (!seconds) {
      ++stats_.late;
      continue;
    }
    // RFC 3550, section 6.4.1.
    const double transit = now - *seconds;
    if (transit_) {
      stats_.jitter += (std::min(std::abs(transit - *transit_), 10.0) - stats_.jitter) / 16;
    }
    transit_ = transit;
    if (auto ok = coder_.push(*seconds, face, out); !ok) return ok;
  }
  return {};
}

Result<void> EngineInput::tick(double now, std::deque<media::LiveEvent>& out) {
  if (!sender_) return {};
  std::vector<ReceivedFace> faces;
  sender_->reader.tick(now, faces);
  return give(faces, now, out);
}

std::optional<double> EngineInput::patience(double now) const {
  return sender_ ? sender_->reader.patience(now) : std::nullopt;
}

media::ReceiveStats EngineInput::stats() const {
  media::ReceiveStats stats = stats_;
  stats.late += coder_.late();
  return stats;
}

}  // namespace animeme::engines
