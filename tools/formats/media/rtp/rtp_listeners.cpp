#include "tools/formats/media/rtp/rtp_listeners.h"

#include <algorithm>

namespace animeme::media {
namespace {

constexpr double kGone = 30;
constexpr std::size_t kMost = 4096;

}  // namespace

void RtpListeners::add(std::uint32_t reporter, LiveTrack track, const ReportBlock& block,
                       double now) {
  std::erase_if(listeners_, [now](const auto& each) { return now - each.second.heard > kGone; });
  if (listeners_.size() >= kMost && !listeners_.contains(reporter)) return;
  Listener& listener = listeners_[reporter];
  listener.heard = now;
  listener.loss[std::size_t(track)] = block.fraction / 256.0;
}

std::int64_t RtpListeners::count(double now) const {
  return std::count_if(listeners_.begin(), listeners_.end(),
                       [now](const auto& each) { return now - each.second.heard <= kGone; });
}

double RtpListeners::loss(double now) const {
  double sum = 0;
  for (const auto& [id, listener] : listeners_) {
    if (now - listener.heard <= kGone) sum += std::max(listener.loss[0], listener.loss[1]);
  }
  const std::int64_t all = count(now);
  return all > 0 ? sum / double(all) : 0;
}

double RtpListeners::sound_loss(double now) const {
  double most = 0;
  for (const auto& [id, listener] : listeners_) {
    if (now - listener.heard > kGone) continue;
    most = std::max(most, listener.loss[std::size_t(LiveTrack::audio)]);
  }
  return most;
}

}  // namespace animeme::media
