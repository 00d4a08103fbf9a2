#include "tools/live/sessions/receive_report.h"

#include <algorithm>
#include <cmath>

#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::live {

namespace {

double share_of(const media::IntraInterval& interval) {
  return interval.planes > 0 ? double(interval.usable) / double(interval.planes) : 1;
}

bool any_plane(const media::RecoveryStats& recovery) {
  return recovery.usable + recovery.dropped + recovery.lost > 0;
}

}  // namespace

std::optional<IntervalShares> shares_of(const std::vector<media::IntraInterval>& intervals) {
  if (intervals.empty()) return std::nullopt;
  IntervalShares shares;
  double sum = 0;
  for (const media::IntraInterval& interval : intervals) {
    const double share = share_of(interval);
    sum += share;
    shares.least = std::min(shares.least, share);
    shares.spoilt += interval.usable < interval.planes;
  }
  shares.mean = sum / double(intervals.size());
  return shares;
}

std::string receive_advice(const media::ReceiveStats& stats) {
  std::string out;
  if (stats.sessions > 1) {
    out += tools::format("sessions: %lld, joined on one clock\n", (long long)(stats.sessions));
  }
  if (stats.foreign > 0) {
    out += tools::format("ignored: %lld datagrams, damaged or not from the sender\n",
                         (long long)(stats.foreign));
  }
  if (stats.wait <= 0 || stats.latest <= 0.01) return out;
  out += tools::format("packets or copies were up to %.2f s late; waited up to %.2f s for them\n",
                       stats.latest, stats.wait);
  if (stats.late > 0 && stats.latest > stats.wait) {
    out += tools::format("%lld packets were too late: use --reorder-most %.1f to wait for them\n",
                         (long long)(stats.late), std::ceil(12.5 * stats.latest) / 10);
  }
  return out;
}

std::string receive_line(double seconds, const media::Recorder& recorder,
                         const media::ReceiveStats& stats) {
  return tools::format(
      "%.0f s: %lld planes usable, %lld unusable, packets %lld, lost %lld, late %lld, "
      "jitter %.2f ms, sound %.1f s",
      seconds, (long long)(recorder.recovery().usable), (long long)(recorder.recovery().dropped),
      (long long)(stats.packets), (long long)(stats.lost), (long long)(stats.late),
      1e3 * stats.jitter, recorder.sound_seconds());
}

std::string receive_summary(const media::Recorder& recorder, const media::ReceiveStats& stats,
                            const std::vector<media::IntraInterval>& intervals) {
  const media::RecoveryStats& recovery = recorder.recovery();
  std::string out = receive_advice(stats);
  if (stats.packets > 0) {
    out += tools::format(
        "packets: %lld, lost %lld, late %lld, duplicates %lld, reordered %lld; jitter %.2f ms\n",
        (long long)(stats.packets), (long long)(stats.lost), (long long)(stats.late),
        (long long)(stats.duplicates), (long long)(stats.reordered), 1e3 * stats.jitter);
  }
  if (any_plane(recovery)) {
    out += tools::format(
        "planes: %lld usable, %lld unusable, %.2f %% usable; frozen for %.2f s, longest %.2f s\n",
        (long long)(recovery.usable), (long long)(recovery.dropped), 100 * recovery.share(),
        recovery.frozen_seconds, recovery.longest_seconds);
  }
  if (const std::optional<IntervalShares> shares = shares_of(intervals)) {
    out += tools::format("intra intervals: %zu, usable on average %.2f %%, in the worst %.2f %%\n",
                         intervals.size(), 100 * shares->mean, 100 * shares->least);
  }
  if (any_plane(recovery) || recorder.sound_seconds() > 0) {
    out += tools::format("face %.2f s, sound %.2f s", recorder.face_seconds(),
                         recorder.sound_seconds());
  }
  while (out.ends_with('\n')) out.pop_back();
  return out;
}

std::string receive_json(const media::Recorder& recorder, const media::ReceiveStats& stats,
                         const std::vector<media::IntraInterval>& intervals) {
  using tools::Json;
  const media::RecoveryStats& recovery = recorder.recovery();
  const std::optional<IntervalShares> shares = shares_of(intervals);
  const auto known = [](bool there, double value) { return there ? Json(value) : Json(nullptr); };
  const double scale = recorder.info() ? recorder.info()->timescale : 1;
  Json rows = Json::array();
  for (const media::IntraInterval& interval : intervals) {
    rows.push_back({{"begin_s", double(interval.begin) / scale},
                    {"planes", interval.planes},
                    {"usable", interval.usable}});
  }
  const Json json = {
      {"packets", stats.packets},
      {"bytes", stats.bytes},
      {"lost", stats.lost},
      {"late", stats.late},
      {"duplicates", stats.duplicates},
      {"reordered", stats.reordered},
      {"jitter_ms", known(stats.packets > 0, 1e3 * stats.jitter)},
      {"latest_seconds", known(stats.packets > 0, stats.latest)},
      {"wait_seconds", stats.wait},
      {"sessions", stats.sessions},
      {"ignored", stats.foreign},
      {"planes_usable", recovery.usable},
      {"planes_dropped", recovery.dropped},
      {"usable_share", known(any_plane(recovery), recovery.share())},
      {"freezes", recovery.freezes},
      {"frozen_seconds", recovery.frozen_seconds},
      {"longest_freeze_seconds", recovery.longest_seconds},
      {"interval_share_mean", known(shares.has_value(), shares ? shares->mean : 0)},
      {"interval_share_least", known(shares.has_value(), shares ? shares->least : 0)},
      {"intervals", rows},
      {"face_seconds", recorder.face_seconds()},
      {"sound_seconds", recorder.sound_seconds()}};
  return tools::pretty(json);
}

}  // namespace animeme::live
