// Lag of the synthesis by cross-correlation of velocities.
#include <cmath>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

constexpr double kLargestLag = 0.300;  // seconds
// ITU-R BT.1359: ms of the face after the sound.
constexpr double kLateLimit = 45, kEarlyLimit = -125;

/// Sums for every lag from -largest to largest frames.
struct LagSums {
  std::size_t frames = 0;
  std::vector<double> ab, aa, bb;

  explicit LagSums(std::size_t lags) : ab(lags), aa(lags), bb(lags) {}
  double correlation(std::size_t lag) const {
    const double norm = aa[lag] * bb[lag];
    return norm > 0 ? ab[lag] / std::sqrt(norm) : 0;
  }
};

/// Adds the recorded velocities of one frame against the made ones of the frames around it.
void add_lags(const Layout& layout, const PairSeries& pair, std::size_t frame, LagSums& sums) {
  ++sums.frames;
  const auto largest = std::ptrdiff_t(sums.ab.size() / 2);
  for (std::ptrdiff_t lag = -largest; lag <= largest; ++lag) {
    const std::ptrdiff_t at = std::ptrdiff_t(frame) + lag;
    if (at < 1 || at + 1 >= std::ptrdiff_t(pair.frames())) continue;
    const auto k = std::size_t(lag + largest);
    for (std::size_t c = 0; c < layout.controls.size(); ++c) {
      if (!layout.scored[c]) continue;
      const double b = derivative(pair.recorded[c], frame, 1) / layout.controls[c].sd;
      const double a = derivative(pair.synthesised[c], std::size_t(at), 1) / layout.controls[c].sd;
      sums.ab[k] += a * b;
      sums.aa[k] += a * a;
      sums.bb[k] += b * b;
    }
  }
}

/// The peak, between frames by a parabola.
LagScore find_lag(const std::string& name, const LagSums& sums, fap::Rate rate) {
  LagScore score{name, sums.frames, std::nullopt, 0};
  std::size_t best = 0;
  for (std::size_t k = 0; k < sums.ab.size(); ++k)
    if (sums.correlation(k) > sums.correlation(best)) best = k;
  const double peak = sums.correlation(best);
  if (!(peak > 0)) return score;
  score.correlation = peak;
  if (best == 0 || best + 1 == sums.ab.size()) return score;
  const double before = sums.correlation(best - 1), after = sums.correlation(best + 1);
  const double bend = before - 2 * peak + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0;
  score.lag = rate.seconds(double(best) - double(sums.ab.size() / 2) + shift) * 1000;
  return score;
}

std::size_t class_at(const PairSeries& pair, std::size_t frame) {
  if (pair.phone[frame] < 0) return std::size_t(PhoneClass::silence);
  const PhoneInfo* info = find_phone(pair.script().phones[std::size_t(pair.phone[frame])].label);
  return std::size_t(info != nullptr ? info->phone_class : PhoneClass::silence);
}

Sync judge(const std::optional<double>& lag) {
  if (!lag) return Sync::unknown;
  if (*lag > kLateLimit) return Sync::face_late;
  return *lag < kEarlyLimit ? Sync::face_early : Sync::in_sync;
}

}  // namespace

const char* sync_text(Sync sync) {
  switch (sync) {
    case Sync::in_sync:
      return "in sync";
    case Sync::face_late:
      return "face late (sound early)";
    case Sync::face_early:
      return "face early (sound late)";
    case Sync::unknown:
      break;
  }
  return "unknown";
}

void score_timing(const Layout& layout, const AllSeries& all, Evaluation& result) {
  const fap::Rate rate = all[0].signal().rate;
  const auto largest = std::size_t(std::ceil(kLargestLag * rate.frames_per_second()));
  LagSums total(2 * largest + 1);
  std::vector<LagSums> classes(kPhoneClassCount, total);
  for (const PairSeries& pair : all)
    for (const FrameRun& run : frame_runs(pair.speech))
      for (std::size_t i = run.begin + 1; i + 1 < run.end; ++i)
        add_lags(layout, pair, i, classes[class_at(pair, i)]);
  for (std::size_t c = 0; c < kPhoneClassCount; ++c) {
    if (classes[c].frames == 0) continue;
    result.timing.classes.push_back(
        find_lag(std::string(phone_class_name(PhoneClass(c))), classes[c], rate));
    total.frames += classes[c].frames;
    for (std::size_t k = 0; k < total.ab.size(); ++k) {
      total.ab[k] += classes[c].ab[k];
      total.aa[k] += classes[c].aa[k];
      total.bb[k] += classes[c].bb[k];
    }
  }
  result.timing.all = find_lag("all", total, rate);
  result.timing.sync = judge(result.timing.all.lag);
}

}  // namespace animeme::dam
