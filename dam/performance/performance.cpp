#include "dam/performance/performance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fap/detail/quantile.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {

constexpr double kPlayedSlowStep = 0.1;   // seconds between values of the slow part
constexpr double kPlayedWindow = 0.6;     // seconds on both sides, of the median
constexpr double kPlayedDeviation = 0.3;  // seconds, of the smoothing behind it
constexpr double kPlayedNearest = 0.2;    // quantile of the gap between the lips that is no speech

constexpr double kPlayedLidsMeet = 1024;     // FAP 19 + 21
constexpr double kPlayedFastLid = 2.5;       // of their way, a second: a blink
constexpr double kPlayedFastEye = 40;        // degrees a second: a saccade
constexpr double kPlayedNearFastest = 0.78;  // of the fastest motion; below 1 / (1 + kMostBend)
constexpr double kPlayedLeastStep = 8;       // FAP units: smaller steps are noise
constexpr double kPlayedBeside = 0.04,
                 kPlayedJoined = 0.12;  // seconds around what is fast, and between two

// Motion of a mouth that speaks.
constexpr double kPlayedBand = 0.25;                            // seconds on both sides
constexpr double kPlayedActive = 0.2, kPlayedLeastMotion = 40;  // of the largest motion; FAP units
constexpr double kPlayedPause = 0.25, kPlayedLeastPhrase = 0.2,
                 kPlayedAccentDistance = 0.3;  // seconds
constexpr double kPlayedLeastSyllables = 1.5;  // a second: slower motion is no speech

fap::Mask faps_of_regions(std::initializer_list<std::string_view> names) {
  fap::Mask mask;
  for (const std::string_view name : names) mask |= fap::region_faps(name).value_or(fap::Mask());
  return mask;
}

std::vector<float> smoothed_curve(const std::vector<float>& values, double deviation) {
  const auto reach = std::ptrdiff_t(std::ceil(3 * deviation));
  std::vector<float> weights;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    const double x = double(k) / deviation;
    weights.push_back(float(std::exp(-0.5 * x * x)));
  }
  std::vector<float> smooth(values.size());
  const auto last = std::ptrdiff_t(values.size()) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    float sum = 0, all = 0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const float weight = weights[std::size_t(k + reach)];
      sum += weight * values[std::size_t(std::clamp<std::ptrdiff_t>(i + k, 0, last))];
      all += weight;
    }
    smooth[std::size_t(i)] = sum / all;
  }
  return smooth;
}

// Lips that lie above each other: the inner pair, and the outer one.
struct LipRow {
  std::size_t upper, lower, outer_upper, outer_lower;
};
constexpr LipRow kPlayedLipRows[] = {{4, 5, 51, 52}, {8, 10, 55, 57}, {9, 11, 56, 58}};

float lip_gap(const fap::Frame& frame, const LipRow& row) {
  return float(-(frame.value[row.upper] + frame.value[row.lower]));
}

// How far a mouth is open, in FAP units.
float mouth_openness(const fap::Frame& frame) {
  return float(std::abs(frame.value[3])) + std::max(0.0f, lip_gap(frame, kPlayedLipRows[0]));
}

struct MouthMotion {
  std::vector<float> opening;  // one a frame
  std::vector<float> range;    // largest less smallest nearby
};

MouthMotion mouth_motion(const fap::Sequence& clip) {
  MouthMotion motion;
  for (const fap::Frame& frame : clip.frames) motion.opening.push_back(mouth_openness(frame));
  const auto count = std::ptrdiff_t(motion.opening.size());
  const auto reach = std::max<std::ptrdiff_t>(
      1, std::ptrdiff_t(std::lround(kPlayedBand * clip.rate.frames_per_second())));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto first = motion.opening.begin() + std::max<std::ptrdiff_t>(0, i - reach);
    const auto end = motion.opening.begin() + std::min(count, i + reach + 1);
    const auto [low, high] = std::minmax_element(first, end);
    motion.range.push_back(*high - *low);
  }
  return motion;
}

// Where the mouth is open most, syllable by syllable; weights by how wide.
std::vector<SpeechAccent> syllables_of(const MouthMotion& motion, const fap::Rate& rate,
                                       float least) {
  std::vector<SpeechAccent> list;
  std::vector<float> sorted = motion.opening;
  const float usual = std::max(1.0f, fap::detail::quantile(sorted, 0.9));
  const auto count = std::ptrdiff_t(motion.opening.size());
  const auto reach = std::max<std::ptrdiff_t>(1, std::ptrdiff_t(0.12 * rate.frames_per_second()));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto at = motion.opening.begin() + i;
    const auto first = motion.opening.begin() + std::max<std::ptrdiff_t>(0, i - reach);
    const auto end = motion.opening.begin() + std::min(count, i + reach + 1);
    if (motion.range[std::size_t(i)] < least || std::max_element(first, end) != at) continue;
    SpeechAccent accent;
    accent.start = accent.end = rate.seconds(double(i));
    accent.weight = std::clamp(double(*at / usual), 0.05, 1.0);
    list.push_back(accent);
  }
  return list;
}

}  // namespace

KeptShares::KeptShares() {
  of.fill(0);
  set(faps_of_regions({"brows", "lids", "gaze", "cheeks", "nose", "head", "ears", "lips"}), 1);
}

void KeptShares::set(const fap::Mask& faps, double share) {
  for (std::size_t fap = fap::kFirstLowLevel; fap < of.size(); ++fap)
    if (faps[fap]) of[fap] = share;
}

const fap::Mask& spoken_faps() {
  static const fap::Mask mask = faps_of_regions({"lips", "jaw", "tongue"});
  return mask;
}

Result<Performance> Performance::make(fap::Sequence clip, const Script& script, double start) {
  if (clip.frames.empty()) return make_error(Code::truncated, "the performance has no frames");
  if (!clip.rate.valid())
    return make_error(Code::invalid_argument, "the performance needs a frame rate above 0");
  if (!(start >= 0 && start <= kMaxScriptSeconds))
    return make_error(Code::invalid_argument, "the performance must not begin before its sound");
  Performance one;
  one.clip_ = std::move(clip);
  one.start_ = start;
  one.find_faps();
  one.find_slow();
  one.find_own_pace();
  one.find_plan(script);
  return one;
}

void Performance::find_faps() {
  for (const fap::Region& region : fap::regions()) {
    bool moves = false;
    for (const fap::Frame& frame : clip_.frames) {
      for (std::size_t fap = fap::kFirstLowLevel; fap < frame.value.size(); ++fap)
        moves = moves || (region.faps[fap] && frame.value[fap] != 0);
      if (moves) break;
    }
    if (moves) faps_ |= region.faps;
  }
  faps_.reset(1).reset(2);
  const double rate = clip_.rate.frames_per_second();
  for (std::size_t i = 1; i < clip_.frames.size(); ++i) {
    for (std::size_t fap = fap::kFirstLowLevel; fap < fastest_.size(); ++fap) {
      const auto& a = clip_.frames[i - 1].value;
      const double step = std::abs(double(clip_.frames[i].value[fap]) - a[fap]);
      fastest_[fap] = std::max(fastest_[fap], step * rate);
    }
  }
}

double Performance::frame_at(double seconds) const {
  const double at = (seconds - start_) * clip_.rate.frames_per_second();
  const double near = std::round(at);
  constexpr double kPlayedRounding = 1e-5;  // of sums of times
  return std::clamp(std::abs(at - near) < kPlayedRounding ? near : at, 0.0,
                    double(clip_.frames.size() - 1));
}

double Performance::value(int fap, double seconds, double window) const {
  const auto n = std::size_t(fap);
  const auto at_frame = [&](double at) {
    const auto before = std::size_t(at);
    const double share = at - double(before);
    const double a = clip_.frames[before].value[n];
    if (share <= 0) return a;
    return a + share * (clip_.frames[before + 1].value[n] - a);
  };
  const double middle = frame_at(seconds);
  if (window <= 0 || fap < 19 || fap > 22) return at_frame(middle);
  const double first = frame_at(seconds - window), last = frame_at(seconds + window);
  double most = std::max({at_frame(first), at_frame(middle), at_frame(last)});
  for (double at = std::ceil(first); at <= last; ++at) most = std::max(most, at_frame(at));
  return most;
}

void Performance::find_slow() {
  const double rate = clip_.rate.frames_per_second();
  const auto count =
      std::size_t(std::floor(double(clip_.frames.size() - 1) / rate / kPlayedSlowStep)) + 2;
  const auto last = std::ptrdiff_t(clip_.frames.size()) - 1;
  const auto around = [&](std::size_t i, const auto& read, double share) {
    std::vector<float> values;
    const double middle = double(i) * kPlayedSlowStep;
    const auto first = std::max<std::ptrdiff_t>(0, std::lround((middle - kPlayedWindow) * rate));
    const auto end = std::min<std::ptrdiff_t>(last, std::lround((middle + kPlayedWindow) * rate));
    for (auto f = std::min(first, end); f <= end; ++f)
      values.push_back(read(clip_.frames[std::size_t(f)]));
    return fap::detail::quantile(values, share);
  };
  const fap::Mask slow = faps_ & faps_of_regions({"lips", "jaw"});
  for (std::size_t fap = fap::kFirstLowLevel; fap < slow_.size(); ++fap) {
    if (!slow[fap]) continue;
    slow_[fap].resize(count);
    for (std::size_t i = 0; i < count; ++i)
      slow_[fap][i] = around(
          i, [&](const fap::Frame& frame) { return float(frame.value[fap]); }, 0.5);
  }
  for (const LipRow& row : kPlayedLipRows) {
    if (!slow[row.upper] || !slow[row.lower]) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const float apart = -(slow_[row.upper][i] + slow_[row.lower][i]);
      const float kept = std::max(
          0.0f,
          around(
              i, [&](const fap::Frame& frame) { return lip_gap(frame, row); }, kPlayedNearest));
      for (const std::size_t fap : {row.upper, row.lower, row.outer_upper, row.outer_lower})
        slow_[fap][i] += (apart - kept) / 2;
    }
  }
  // The jaw is as far down as it stays in syllables.
  if (slow[3]) {
    for (std::size_t i = 0; i < count; ++i)
      slow_[3][i] = around(
          i, [](const fap::Frame& frame) { return float(frame.value[3]); }, kPlayedNearest);
  }
  for (auto& values : slow_)
    if (!values.empty()) values = smoothed_curve(values, kPlayedDeviation / kPlayedSlowStep);
}

double Performance::slow(int fap, double seconds) const {
  const std::vector<float>& values = slow_[std::size_t(fap)];
  if (values.empty()) return 0;
  const double at =
      std::clamp((seconds - start_) / kPlayedSlowStep, 0.0, double(values.size() - 1));
  const auto before = std::min(std::size_t(at), values.size() - 1);
  const auto after = std::min(before + 1, values.size() - 1);
  const double share = at - double(before);
  return double(values[before]) + share * (double(values[after]) - double(values[before]));
}

void Performance::find_own_pace() {
  const double rate = clip_.rate.frames_per_second();
  std::array<double, fap::kFapCount + 1> most{};  // a frame
  most.fill(1e9);
  const fap::Mask kept = faps_ & ~spoken_faps();
  for (std::size_t fap = fap::kFirstLowLevel; fap < most.size(); ++fap) {
    if (!kept[fap]) continue;
    const double near = kPlayedNearFastest * fastest_[fap] / rate;
    if (near >= kPlayedLeastStep) most[fap] = near;
  }
  constexpr double kPlayedUnits = 1e5 * 3.14159265358979 / 180;  // FAP units of a degree
  for (const std::size_t eye : {23, 24, 25, 26})
    if (kept[eye]) most[eye] = std::min(most[eye], kPlayedFastEye * kPlayedUnits / rate);
  const double lid = kPlayedFastLid * kPlayedLidsMeet / rate;
  for (std::size_t i = 1; i < clip_.frames.size(); ++i) {
    const auto& a = clip_.frames[i - 1].value;
    const auto& b = clip_.frames[i].value;
    bool fast = false;
    for (std::size_t fap = fap::kFirstLowLevel; fap < most.size(); ++fap)
      fast = fast || std::abs(double(b[fap]) - a[fap]) > most[fap];
    for (const auto& [upper, lower] : {std::pair<std::size_t, std::size_t>(19, 21), {20, 22}}) {
      if (!kept[upper]) continue;
      fast = fast || std::abs(double(b[upper]) + b[lower] - a[upper] - a[lower]) > lid;
    }
    if (!fast) continue;
    const double start = start_ + clip_.rate.seconds(double(i) - 1) - kPlayedBeside;
    const double end = start_ + clip_.rate.seconds(double(i)) + kPlayedBeside;
    if (!own_pace_.empty() && start - own_pace_.back().end < kPlayedJoined) {
      own_pace_.back().end = end;
    } else {
      own_pace_.push_back({std::max(0.0, start), end});
    }
  }
}

void Performance::find_plan(const Script& script) {
  if (!script.phones.empty()) {
    plan_ = plan_speech(script);
    return;
  }
  if (!faps_[3] && !faps_[4]) return;
  const MouthMotion motion = mouth_motion(clip_);
  std::vector<float> sorted = motion.range;
  const float least = std::max(float(kPlayedActive) * fap::detail::quantile(sorted, 0.95),
                               float(kPlayedLeastMotion));
  std::vector<SpeechPhrase> phrases;
  double active = 0;
  for (std::size_t i = 0; i < motion.range.size(); ++i) {
    if (motion.range[i] < least) continue;
    const double start = clip_.rate.seconds(double(i)), end = clip_.rate.seconds(double(i + 1));
    active += end - start;
    if (!phrases.empty() && start - phrases.back().end < kPlayedPause) {
      phrases.back().end = end;
    } else {
      SpeechPhrase phrase;
      phrase.start = start;
      phrase.end = end;
      phrases.push_back(phrase);
    }
  }
  const std::vector<SpeechAccent> syllables = syllables_of(motion, clip_.rate, least);
  if (double(syllables.size()) < kPlayedLeastSyllables * active) return;
  // The band has seen the motion before it began, and still sees it when it has ended.
  for (SpeechPhrase& phrase : phrases) phrase.start += kPlayedBand, phrase.end -= kPlayedBand;
  std::erase_if(phrases, [](const auto& one) { return one.end - one.start < kPlayedLeastPhrase; });
  plan_.phrases = std::move(phrases);
  // The most open of those that are near each other.
  for (const SpeechAccent& one : syllables) {
    if (!plan_.accents.empty() && one.start - plan_.accents.back().start < kPlayedAccentDistance) {
      if (one.weight > plan_.accents.back().weight) plan_.accents.back() = one;
    } else {
      plan_.accents.push_back(one);
    }
  }
  for (SpeechPhrase& phrase : plan_.phrases) phrase.start += start_, phrase.end += start_;
  for (SpeechAccent& accent : plan_.accents) accent.start += start_, accent.end += start_;
}

}  // namespace animeme::dam
