#include "tools/formats/media/live/recovery.h"

#include <algorithm>
#include <utility>

namespace animeme::media {
namespace {

constexpr std::size_t kMostIntervals = 4096;

bool same_face(const LiveInfo& a, const LiveInfo& b) {
  return a.face_config == b.face_config && a.timescale == b.timescale;
}

}  // namespace

std::optional<LiveUnit> FaceRecovery::accept(LiveEvent event) {
  if (LiveInfo* info = std::get_if<LiveInfo>(&event)) {
    if (!info_ || !same_face(*info_, *info)) {
      waiting_ = true;
      if (info_ && info_->timescale != info->timescale) shown_until_.reset();
    }
    info_ = std::move(*info);
  } else if (const LiveGap* gap = std::get_if<LiveGap>(&event)) {
    if (gap->track == LiveTrack::face) lose(gap->packets);
  } else if (std::holds_alternative<LiveEnd>(event) || std::holds_alternative<LiveRestart>(event)) {
    end_interval();
    waiting_ = true;
    shown_until_.reset();
  } else if (LiveUnit* unit = std::get_if<LiveUnit>(&event)) {
    if (unit->track == LiveTrack::audio) return std::move(*unit);
    return accept_plane(std::move(*unit));
  }
  return std::nullopt;
}

void FaceRecovery::lose(std::int64_t packets) {
  waiting_ = true;
  const std::int64_t planes = std::max<std::int64_t>(1, packets);
  stats_.lost += planes;
  if (interval_) interval_->planes += planes;
}

std::optional<LiveUnit> FaceRecovery::accept_plane(LiveUnit unit) {
  if (unit.intra) {
    begin_interval(unit);
  } else if (interval_) {
    ++interval_->planes;
  }
  if (waiting_) {
    ++stats_.dropped;
    return std::nullopt;
  }
  ++stats_.usable;
  ++interval_->usable;
  shown_until_ = double(unit.time) + double(unit.duration);
  return unit;
}

void FaceRecovery::begin_interval(const LiveUnit& unit) {
  end_interval();
  interval_ = IntraInterval{unit.time, 1, 0};
  if (waiting_ && shown_until_ && double(unit.time) > *shown_until_) {
    const double seconds =
        (double(unit.time) - *shown_until_) / (info_ ? info_->timescale : LiveInfo().timescale);
    ++stats_.freezes;
    stats_.frozen_seconds += seconds;
    stats_.longest_seconds = std::max(stats_.longest_seconds, seconds);
  }
  waiting_ = false;
}

void FaceRecovery::end_interval() {
  if (!interval_) return;
  if (complete_.size() >= kMostIntervals) complete_.pop_front();
  complete_.push_back(*std::exchange(interval_, std::nullopt));
}

std::vector<IntraInterval> FaceRecovery::take_intervals() {
  std::vector<IntraInterval> out(complete_.begin(), complete_.end());
  complete_.clear();
  return out;
}

}  // namespace animeme::media
