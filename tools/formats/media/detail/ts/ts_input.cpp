#include "tools/formats/media/detail/ts/ts_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr double kQuiet = 1;  // seconds: then another sender may take over
constexpr std::size_t kMostStrangers = 4;
constexpr std::size_t kMostKept = std::size_t(1) << 18;  // bytes of units of a stranger

void add_to(ReceiveStats& sum, const ReceiveStats& more) {
  sum.packets += more.packets;
  sum.bytes += more.bytes;
  sum.lost += more.lost;
  sum.duplicates += more.duplicates;
}

}  // namespace

void TsInput::push(std::span<const std::uint8_t> bytes, const UdpAddress& from, double now,
                   std::deque<LiveEvent>& out) {
  if (sender_ && (any_source_ || from == sender_->from)) return hear(*sender_, bytes, now, out);
  consider(bytes, from, now, out);
}

void TsInput::hear(Sender& sender, std::span<const std::uint8_t> bytes, double now,
                   std::deque<LiveEvent>& out) {
  sender.last = now;
  std::vector<TsEvent> found;
  sender.demuxer.push(bytes, found);
  for (TsEvent& event : found) give(std::move(event), now, out);
  if (std::exchange(over_, false)) leave();
}

void TsInput::give(TsEvent event, double now, std::deque<LiveEvent>& out) {
  if (const auto* pes = std::get_if<TsPes>(&event)) measure(*pes, now);
  if (std::holds_alternative<TsOver>(event)) over_ = true;
  parser_.push(std::move(event), out);
}

void TsInput::leave() {
  if (sender_) add_to(before_, sender_->demuxer.stats());
  sender_.reset();
}

void TsInput::consider(std::span<const std::uint8_t> bytes, const UdpAddress& from, double now,
                       std::deque<LiveEvent>& out) {
  auto who = std::find_if(candidates_.begin(), candidates_.end(),
                          [&](const Sender& each) { return any_source_ || each.from == from; });
  if (who == candidates_.end()) {
    if (candidates_.size() >= kMostStrangers) {  // the one that was heard longest ago
      candidates_.erase(
          std::min_element(candidates_.begin(), candidates_.end(),
                           [](const auto& a, const auto& b) { return a.last < b.last; }));
    }
    candidates_.emplace_back().from = from;
    who = std::prev(candidates_.end());
  }
  ++foreign_;
  ++who->datagrams;
  std::vector<TsEvent> found;
  who->last = now;
  who->demuxer.push(bytes, found);
  keep(*who, std::move(found));
  const bool free = !sender_ || now - sender_->last > kQuiet;
  if (!free || !who->program || (sender_ && !who->unit)) return;
  if (sender_) {
    parser_ = {};
    out.emplace_back(LiveRestart{});
  } else if (sessions_ > 0) {
    out.emplace_back(LiveRestart{});
  }
  leave();
  sender_ = std::move(*who);
  candidates_.erase(who);
  foreign_ -= sender_->datagrams;
  ++sessions_;
  for (TsEvent& event : std::exchange(sender_->found, {})) give(std::move(event), now, out);
  if (std::exchange(over_, false)) leave();
}

void TsInput::keep(Sender& sender, std::vector<TsEvent> found) {
  for (TsEvent& event : found) {
    if (std::holds_alternative<TsOver>(event)) {
      sender.found.clear();
      sender.program = sender.unit = false;
      sender.bytes = 0;
      continue;
    }
    sender.program = sender.program || std::holds_alternative<TsMap>(event);
    if (const auto* pes = std::get_if<TsPes>(&event)) {
      sender.unit = true;
      sender.bytes += pes->bytes.size() + sizeof *pes;
    }
    sender.found.push_back(std::move(event));
  }
  if (sender.bytes <= kMostKept && sender.found.size() <= kMostKept / 256) return;
  std::optional<TsEvent> program;  // the last one; the rest is lost
  for (TsEvent& event : sender.found) {
    if (std::holds_alternative<TsMap>(event)) program = std::move(event);
  }
  sender.found.clear();
  sender.bytes = 0;
  if (program) sender.found.push_back(std::move(*program));
  sender.found.emplace_back(LiveGap{LiveTrack::face, 0});
  sender.found.emplace_back(LiveGap{LiveTrack::audio, 0});
}

// RFC 3550, section 6.4.1.
void TsInput::measure(const TsPes& pes, double now) {
  if (pes.track != LiveTrack::face || !pes.stamp) return;
  const double transit = now - double(*pes.stamp) / 90000;
  if (transit_ != 0) jitter_ += (std::min(std::abs(transit - transit_), 10.0) - jitter_) / 16;
  transit_ = transit;
}

ReceiveStats TsInput::stats() const {
  ReceiveStats stats = before_;
  if (sender_) add_to(stats, sender_->demuxer.stats());
  stats.foreign = foreign_;
  stats.sessions = sessions_;
  stats.jitter = jitter_;
  return stats;
}

}  // namespace animeme::media
