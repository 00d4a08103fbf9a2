#include "dam/speaking/moods.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dam/signal/arkit_signal.h"
#include "dam/signal/fap_signal.h"
#include "dam/signal/limits.h"
#include "fap/arkit.h"

namespace animeme::dam {
namespace {

constexpr double kFullIntensity = 63;  // of FAP 2

// Room for further channels in every row.
void widen_rows(Signal& signal, const std::vector<std::string>& added) {
  if (added.empty()) return;
  const std::size_t frames = signal.frames(), before = signal.names.size();
  signal.names.insert(signal.names.end(), added.begin(), added.end());
  std::vector<double> values(frames * signal.names.size(), 0.0);
  for (std::size_t i = 0; i < frames; ++i)
    std::copy_n(&signal.values[i * before], before, &values[i * signal.names.size()]);
  signal.values = std::move(values);
}

std::span<double> row_of(Signal& signal, std::size_t frame) {
  const std::size_t channels = signal.names.size();
  return std::span(signal.values).subspan(frame * channels, channels);
}

void add_to_faps(Signal& signal, const MoodMouth& mouth, const MoodTrack& track) {
  fap::Mask wanted;
  for (const MoodTrack::Part& part : track.parts()) wanted |= mood_pose(part.mood).faps();
  for (const std::string& name : signal.names) wanted.reset(std::size_t(fap_of_channel(name)));
  std::vector<std::string> added;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f)
    if (wanted[std::size_t(f)]) added.push_back(fap_channel(f));
  widen_rows(signal, added);
  const MoodLayer layer(signal.names);
  const MoodBlend blend = track.blend();
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double time = signal.time(i);
    const MoodPose pose = blend.at(time);
    if (!pose.neutral()) layer.add(pose, mouth.at(time), row_of(signal, i));
  }
}

// What a mouth that speaks leaves to a shape of ARKit.
double arkit_share(std::string_view shape, const MoodMouth::Shares& mouth) {
  const double free = (1 - mouth.shut) * (1 - mouth.bite);
  const double opening = 1 - mouth.speech + mouth.speech * 0.35 * free;
  if (shape == "jawOpen")
    return (1 - mouth.jaw) * (1 - 0.65 * mouth.speech) * (1 - 0.8 * mouth.teeth * mouth.speech);
  if (shape.starts_with("mouthSmile") || shape.starts_with("mouthStretch") ||
      shape.starts_with("mouthDimple")) {
    return 1 - mouth.round * 5 / 6;
  }
  if (shape.starts_with("mouthFrown")) return 1 - mouth.round / 2;
  return shape.starts_with("mouth") || shape.starts_with("jaw") ? opening : 1;
}

// Shapes of ARKit for a mood, by the FAPs of its pose.
fap::ArkitFrame arkit_of_pose(const MoodPose& pose) {
  fap::Frame frame;
  for (std::size_t f = fap::kFirstLowLevel; f < pose.fap.size(); ++f)
    frame.set(int(f), std::int32_t(std::lround(pose.fap[f])));
  return fap::ArkitFitter().fit(frame);
}

void add_to_arkit(Signal& signal, const MoodMouth& mouth, const MoodTrack& track) {
  constexpr double kSeen = 0.02;
  std::map<std::string, fap::ArkitFrame> faces;
  fap::ArkitChannels wanted;
  for (const MoodTrack::Part& part : track.parts()) {
    const fap::ArkitFrame face = arkit_of_pose(mood_pose(part.mood));
    for (std::size_t s = 0; s < fap::kArkitShapeCount; ++s)
      if (face[s] >= kSeen) wanted.set(s);
    faces[mood_text(part.mood)] = face;
  }
  std::vector<std::string> added;
  const auto before = find_arkit_layout(signal.names);
  for (std::size_t s = 0; s < fap::kArkitShapeCount; ++s)
    if (wanted[s] && before && !before->has[s])
      added.push_back(arkit_spelling(int(s), signal.names));
  widen_rows(signal, added);
  const auto layout = find_arkit_layout(signal.names);
  const MoodBlend blend = track.blend();
  const auto lids = std::pair(fap::find_arkit("eyeBlinkLeft"), fap::find_arkit("eyeBlinkRight"));
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double time = signal.time(i);
    const auto shares = blend.shares(time);
    const MoodMouth::Shares left = mouth.at(time);
    const std::span<double> row = row_of(signal, i);
    const fap::ArkitFrame shown = layout->frame(row);
    for (std::size_t c = 0; c < row.size(); ++c) {
      const int shape = layout->channel[c];
      if (shape < 0 || shape >= fap::kArkitShapeCount || !wanted[std::size_t(shape)]) continue;
      double more = 0;
      for (const MoodBlend::Share& one : shares)
        more += one.share * faces[mood_text(*one.mood)][std::size_t(shape)];
      const std::string_view name = fap::kArkitNames[std::size_t(shape)];
      more *= arkit_share(name, left);
      if (name.starts_with("eye")) {
        const auto lid = name.ends_with("Left") ? lids.first : lids.second;
        more *= 1 - std::clamp(shown[std::size_t(lid.value_or(0))], 0.0, 1.0);
      }
      row[c] += more;
    }
  }
  apply_limits(signal, natural_limits(signal.names));
}

// The two strongest.
fap::Expression coded_expression(const MoodPose& pose) {
  fap::Expression coded;
  std::size_t first = 0, second = 0;
  for (std::size_t e = 1; e < pose.expression.size(); ++e) {
    if (first == 0 || pose.expression[e] > pose.expression[first]) {
      second = first;
      first = e;
    } else if (second == 0 || pose.expression[e] > pose.expression[second]) {
      second = e;
    }
  }
  const auto intensity = [&](std::size_t e) {
    return std::int32_t(std::lround(kFullIntensity * std::clamp(pose.expression[e], 0.0, 1.0)));
  };
  // By number, so that two that change places in strength do not change places in the stream.
  if (second < first) std::swap(first, second);
  if (intensity(first) == 0) std::swap(first, second);
  if (intensity(first) > 0)
    coded.select1 = std::int32_t(first), coded.intensity1 = intensity(first);
  if (intensity(second) > 0 && second != first)
    coded.select2 = std::int32_t(second), coded.intensity2 = intensity(second);
  return coded;
}

}  // namespace

Result<void> add_moods(Signal& signal, const Script& script, const MoodTrack& track) {
  if (track.neutral()) return {};
  const bool faps = std::any_of(signal.names.begin(), signal.names.end(), [](const auto& name) {
    return fap_of_channel(name) >= fap::kFirstLowLevel;
  });
  const MoodMouth mouth(script);
  if (faps) {
    add_to_faps(signal, mouth, track);
  } else if (find_arkit_layout(signal.names)) {
    add_to_arkit(signal, mouth, track);
  } else {
    return make_error(Code::unsupported,
                      "moods move FAPs or ARKit's shapes, and the controls of this model are "
                      "neither; speak without --mood");
  }
  return {};
}

void show_expressions(const MoodTrack& track, fap::Sequence& clip, ExpressionPlace place) {
  const MoodBlend blend = track.blend();
  for (fap::Frame& frame : clip.frames) {
    for (const fap::FapInfo& fap : fap::kFaps) {
      const bool shown = fap.group == 4 || fap.group == 5 || fap.group == 9;
      if (place != ExpressionPlace::instead || !shown) continue;
      frame.mask.reset(std::size_t(fap.number));
      frame.value[std::size_t(fap.number)] = 0;
    }
    frame.mask.set(2);
    frame.expression = coded_expression(blend.at(clip.rate.seconds(double(frame.number))));
  }
}

}  // namespace animeme::dam
