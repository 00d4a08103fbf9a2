// How much of a mood a talking mouth can show.
#include <algorithm>
#include <cmath>

#include "dam/maths/raised_cosine.h"
#include "dam/script/features.h"
#include "dam/script/phones.h"
#include "dam/script/timeline_internal.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/moods.h"

namespace animeme::dam {
namespace {

// Seconds beside speech that count as speech, and in which it comes and goes.
constexpr double kSpeechBeside = 0.08, kSpeechTurn = 0.27;
constexpr double kContactTurn = 0.07;  // seconds beside the stretch in which a contact is made
constexpr double kTeethTurn = 0.14;
// Likewise of the jaw, which is slower than the lips: people move it by 200 mm/s at most.
constexpr double kJawTurn = 0.25;
constexpr double kLipsWait =
    0.7;  // of the lips' opening goes with the jaw, so that they need not hurry
constexpr double kQuiteRound = 0.45;  // of LipRounding, which neighbours pull down

constexpr double kSpokenOpening = 0.35;  // lips and jaw open as far in speech as in silence
constexpr double kOpenGap = 320;         // FAP units beyond kClosedGap: lips that are free
constexpr double kTeethTaken = 0.8;      // of the jaw is taken where the teeth are together
constexpr double kRoundCorners = 1.0 / 6, kKeptRounding = 0.65;
constexpr double kRoundHeight = 0.5;  // corners go up and down half as far
constexpr double kSpokenNarrow = 0.5, kSpokenPush = 0.5, kSpokenChin = 0.3;
constexpr double kMostPressed = -60;  // FAP units: the least gap that a mood makes
constexpr double kLidsMeet = 1024;

bool teeth_together(std::string_view label) {
  for (const Features& sound : phone_features(label)) {
    const bool hiss = sound.manner == Manner::fricative || sound.manner == Manner::affricate;
    if (hiss && sound.place >= Place::alveolar && sound.place <= Place::alveolopalatal) return true;
  }
  return false;
}

}  // namespace

MoodMouth::MoodMouth(const Script& script) : rounding_(script) {
  for (const Stretch& stretch : speech_stretches(script))
    speech_.push_back({stretch.start - kSpeechBeside, stretch.end + kSpeechBeside});
  for (const Phone& phone : script.phones) {
    const Window contact{phone.start - kClosureSearch, phone.end + kClosureSearch};
    if (is_labiodental(phone.label)) bites_.push_back(contact);
    if (is_bilabial(phone.label)) shuts_.push_back(contact);
    if (teeth_together(phone.label)) teeth_.push_back({phone.start, phone.end});
  }
}

// Windows are in order by their ends, too.
double MoodMouth::inside(const std::vector<Window>& windows, double seconds, double ramp) {
  auto window = std::partition_point(windows.begin(), windows.end(),
                                     [&](const Window& one) { return one.end + ramp <= seconds; });
  double most = 0;
  for (; window != windows.end() && window->start - ramp < seconds; ++window) {
    most = std::max(most, raised_step((seconds - window->start) / ramp + 1) *
                              raised_step((window->end - seconds) / ramp + 1));
  }
  return most;
}

MoodMouth::Shares MoodMouth::at(double seconds) const {
  Shares shares;
  shares.speech = inside(speech_, seconds, kSpeechTurn);
  shares.teeth = inside(teeth_, seconds, kTeethTurn);
  shares.bite = inside(bites_, seconds, kContactTurn);
  shares.shut = inside(shuts_, seconds, kContactTurn);
  shares.jaw = std::max(inside(bites_, seconds, kJawTurn), inside(shuts_, seconds, kJawTurn));
  shares.round = raised_step(rounding_(seconds) / kQuiteRound);
  return shares;
}

MoodLayer::MoodLayer(std::span<const std::string> names) {
  channel_.fill(-1);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const int fap = fap_of_channel(names[c]);
    if (fap >= fap::kFirstLowLevel) channel_[std::size_t(fap)] = std::ptrdiff_t(c);
  }
}

MoodLayer::MoodLayer() {
  channel_.fill(-1);
  for (std::size_t f = fap::kFirstLowLevel; f < channel_.size(); ++f)
    channel_[f] = std::ptrdiff_t(f);
}

void MoodLayer::move_mouth(const MoodPose& pose, const MoodMouth::Shares& shares,
                           std::span<double> row) const {
  double nothing = 0;
  const auto value = [&](std::size_t fap) -> double& {
    nothing = 0;
    return channel_[fap] < 0 ? nothing : row[std::size_t(channel_[fap])];
  };
  const bool lips = channel_[4] >= 0 && channel_[5] >= 0;
  const double gap = lips ? -(value(4) + value(5)) : 0;
  const double free = lips ? raised_step((gap - kClosedGap) / kOpenGap) : 1 - shares.shut;
  const double loose = 1 - shares.bite;
  const double opening = loose * (1 - kLipsWait * shares.jaw) *
                         (shares.speech * kSpokenOpening * free + 1 - shares.speech);
  const double jaw = (1 - shares.jaw) * (1 - (1 - kSpokenOpening) * shares.speech) *
                     (1 - kTeethTaken * shares.teeth * shares.speech);
  const double louder = 1 + (pose.style - 1) * free * loose;
  const double jaw_louder = 1 + (louder - 1) * (1 - shares.teeth);
  value(3) = jaw_louder * value(3) + jaw * pose.fap[3];
  for (const std::size_t f : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58})
    value(f) = louder * value(f) + opening * pose.fap[f];
  for (const auto& [upper, lower] : {std::pair(4, 5), {8, 10}, {9, 11}}) {
    double& above = value(std::size_t(upper));
    const double below = value(std::size_t(lower));
    const double missing = kMostPressed + above + below;  // > 0: pressed too much
    const double made = opening * (pose.fap[std::size_t(upper)] + pose.fap[std::size_t(lower)]);
    const double given = std::clamp(missing, 0.0, std::max(made, 0.0)) / 2;
    if (!(given > 0) || channel_[std::size_t(upper)] < 0 || channel_[std::size_t(lower)] < 0)
      continue;
    row[std::size_t(channel_[std::size_t(upper)])] -= given;
    row[std::size_t(channel_[std::size_t(lower)])] -= given;
  }
  for (const std::size_t f : {6, 7, 53, 54}) {
    double& width = value(f);
    const double before = width, own = pose.style * width, wide = pose.fap[f];
    width = shares.speech * own + (1 - shares.speech) * width;
    if (wide > 0) {
      const double most = std::max(kKeptRounding * before - own, 0.0);
      width += (1 - shares.round) * wide + shares.round * std::min(kRoundCorners * wide, most);
    } else {
      width += (1 - (1 - kSpokenNarrow) * shares.speech) * wide;
    }
  }
  for (const std::size_t f : {12, 13, 59, 60})
    value(f) += (1 - (1 - kRoundHeight) * shares.round) * pose.fap[f];
  for (const std::size_t f : {14, 15, 16, 17})
    value(f) += (1 - (1 - kSpokenPush) * shares.speech) * pose.fap[f];
  value(18) += loose * (1 - (1 - kSpokenChin) * shares.speech) * pose.fap[18];
}

void MoodLayer::add(const MoodPose& pose, const MoodMouth::Shares& shares,
                    std::span<double> row) const {
  move_mouth(pose, shares, row);
  const auto column = [&](std::size_t fap) -> double* {
    return channel_[fap] < 0 ? nullptr : &row[std::size_t(channel_[fap])];
  };
  // A lid that blinks shuts all the way.
  for (const auto& [upper, lower] : {std::pair<std::size_t, std::size_t>(19, 21), {20, 22}}) {
    double* above = column(upper);
    double* below = column(lower);
    const double shut = (above != nullptr ? *above : 0) + (below != nullptr ? *below : 0);
    const double left = 1 - std::clamp(shut / kLidsMeet, 0.0, 1.0);
    if (above != nullptr) *above += left * pose.fap[upper];
    if (below != nullptr) *below += left * pose.fap[lower];
  }
  for (std::size_t f = 23; f < channel_.size(); ++f) {
    const int group = fap::info(int(f)).group;
    if (group != 8 && channel_[f] >= 0) *column(f) += pose.fap[f];
  }
}

void add_mood(const MoodPose& pose, const MoodMouth::Shares& shares, fap::Frame& frame) {
  static const MoodLayer layer;
  std::array<double, fap::kFapCount + 1> row{};
  std::copy(frame.value.begin(), frame.value.end(), row.begin());
  layer.add(pose, shares, row);
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    const auto i = std::size_t(f);
    if (row[i] == frame.value[i]) continue;
    const auto& info = fap::info(f);
    const double range = double(info.default_i_range) * double(info.quant_step);
    frame.set(f, std::int32_t(std::round(std::clamp(row[i], -range, range))));
  }
}

}  // namespace animeme::dam
