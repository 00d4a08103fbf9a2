#include "dam/training/reference_motion_internal.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dam/corpus/statistics_internal.h"
#include "dam/maths/parallel.h"
#include "dam/model/builtin.h"
#include "dam/script/timeline_internal.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

constexpr std::uint32_t kFine = 100;  // a second
constexpr double kAround = 0.3;       // seconds beside the speech that count
constexpr double kLeastSpeech = 0.5;  // seconds

/// FAPs and their weights.
struct ShapeInfo {
  int fap;
  std::size_t shape;
  double weight;
};
constexpr ShapeInfo kShapeInfo[] = {{3, 0, 1}, {4, 1, -1}, {5, 1, -1},   {6, 2, 1},
                                    {7, 2, 1}, {4, 3, 1},  {12, 4, 0.5}, {13, 4, 0.5}};

Result<std::vector<Shapes>> asked_for(const Model& speaker, const Script& script) {
  SynthesisOptions options;
  options.rate = {kFine, 1};
  options.tail = 0.5;
  options.closure = false;
  const auto made = synthesise(speaker, script, options);
  if (!made) return made.error();
  std::vector<Shapes> shapes(made->frames(), Shapes{});
  for (const ShapeInfo& info : kShapeInfo) {
    const std::int32_t control = speaker.find_control(fap_channel(info.fap));
    for (std::size_t i = 0; control >= 0 && i < shapes.size(); ++i)
      shapes[i][info.shape] += info.weight * made->at(i, std::size_t(control));
  }
  return shapes;
}

/// The frames near speech that were measured, in deviations of the controls, about their mean.
void add_motion(const Utterance& u, std::span<const Control> controls, SentenceTrack& track) {
  const auto stretches = speech_stretches(u.script);
  const std::size_t k = controls.size();
  std::vector<double> mean(k, 0.0);
  for (std::size_t i = 0; i < u.signal.frames(); ++i) {
    const double time = u.signal.time(i);
    if (!is_measured(u.signal, i) || distance_to_speech(stretches, time) > kAround) continue;
    track.times.push_back(time);
    for (std::size_t c = 0; c < k; ++c) {
      const double sd = controls[c].sd;
      track.motion.push_back(sd > 0 ? u.signal.at(i, c) / sd : 0.0);
      mean[c] += track.motion.back();
    }
  }
  for (std::size_t i = 0; i < track.motion.size(); ++i)
    track.motion[i] -= mean[i % k] / double(track.times.size());
}

}  // namespace

const Shapes& SentenceTrack::at(double time) const {
  const double place = std::round(time * kFine);
  return asked[std::size_t(std::clamp(place, 0.0, double(asked.size() - 1)))];
}

Result<std::vector<SentenceTrack>> make_tracks(std::span<const Utterance* const> sentences,
                                               int threads) {
  const auto speaker = builtin_model();
  if (!speaker) return speaker.error();
  const auto controls = control_statistics(sentences, speaker->pause_edge);
  std::vector<std::optional<SentenceTrack>> made(sentences.size());
  parallel_for(sentences.size(), threads, [&](std::size_t s) {
    const Utterance& u = *sentences[s];
    auto asked = asked_for(*speaker, u.script);
    if (!asked) return;  // a phone that he cannot say
    SentenceTrack track;
    track.id = u.id;
    track.asked = std::move(*asked);
    add_motion(u, controls, track);
    if (u.signal.rate.seconds(double(track.frames())) >= kLeastSpeech) made[s] = std::move(track);
  });
  std::vector<SentenceTrack> tracks;
  for (auto& track : made)
    if (track) tracks.push_back(std::move(*track));
  return tracks;
}

}  // namespace animeme::dam
