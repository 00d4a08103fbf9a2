#include "tools/speech/voice/frame_scores.h"

#include <algorithm>
#include <cmath>

#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/hearing.h"

namespace animeme::voice {

namespace {

constexpr std::size_t kMeanReach = 1500;  // frames to either side that the mean is taken of
// The model has learned with a mean that some of the pauses are in. Chosen on grid_s1: less moves
// the starts of phones.
constexpr double kSpeechAndPauses = 1.4;
constexpr std::size_t kFrameHop = 160, kHalfWindow = 205;  // samples
constexpr std::size_t kLevelReach = 800;                   // samples to either side
constexpr double kFloor = 0.1;
constexpr float kAboveLowest = 6;  // dB, where there are no pauses
constexpr double kLoud = 0.87;     // of the frames with speech are less loud
constexpr float kNewPhone = 4.6f;  // a phone of the free path costs so much

// dB over 0.1 s around the middle of each frame.
std::vector<float> smooth_levels(const std::vector<std::int16_t>& samples, std::size_t frames) {
  std::vector<float> levels;
  for (std::size_t t = 0; t < frames; ++t) {
    const std::size_t middle = std::min(t * kFrameHop + kHalfWindow, samples.size());
    const std::size_t first = middle > kLevelReach ? middle - kLevelReach : 0;
    const std::size_t last = std::min(middle + kLevelReach, samples.size());
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += double(samples[i]) * double(samples[i]);
    const double mean = sum / double(std::max<std::size_t>(last - first, 1));
    levels.push_back(float(10 * std::log10(mean + 1)));
  }
  return levels;
}

// What a share of the levels lies below.
float exceeded(std::vector<float>& levels, double share) {
  const auto at = levels.begin() + std::ptrdiff_t(share * double(levels.size() - 1));
  std::nth_element(levels.begin(), at, levels.end());
  return *at;
}

// The best path of any phones, taken off the scores.
void take_free_path(const SoundModel& model, FrameScores& scores) {
  const std::size_t states = scores.states, frames = scores.frames();
  std::vector<float> stay(states), leave(states);
  for (std::size_t s = 0; s < states; ++s) {
    stay[s] = std::log(model.stay[s]);
    leave[s] = std::log(1 - model.stay[s]);
  }
  std::vector<float> best(states), next(states);
  std::vector<std::uint8_t> from(frames * states);  // 0: stayed, 1: from the state before
  std::vector<std::uint8_t> last(frames);           // the phone that a new one follows
  float exit = 0;
  for (std::size_t t = 0; t < frames; ++t) {
    const auto now = scores[t];
    for (std::size_t s = 0; s < states; ++s) {
      const bool first = s % kStatesPerPhone == 0;
      const float held = t == 0 ? -1e30f : best[s] + stay[s];
      const float come = first ? exit - kNewPhone : t == 0 ? -1e30f : best[s - 1] + leave[s - 1];
      from[t * states + s] = come > held;
      next[s] = std::max(held, come) + now[s];
    }
    std::swap(best, next);
    exit = -1e30f;
    for (std::size_t s = kStatesPerPhone - 1; s < states; s += kStatesPerPhone) {
      if (best[s] + leave[s] <= exit) continue;
      exit = best[s] + leave[s];
      last[t] = std::uint8_t(s / kStatesPerPhone);
    }
  }
  scores.free.resize(frames);
  auto state = std::size_t(std::max_element(best.begin(), best.end()) - best.begin());
  for (std::size_t t = frames; t-- > 0;) {
    scores.free[t] = std::uint8_t(state / kStatesPerPhone);
    float* row = &scores.values[t * states];
    const float free = row[state];
    for (std::size_t s = 0; s < states; ++s) row[s] -= free;
    if (from[t * states + state] == 0 || t == 0) continue;
    state = state % kStatesPerPhone == 0 ? last[t - 1] * kStatesPerPhone + kStatesPerPhone - 1
                                         : state - 1;
  }
}

}  // namespace

MeasuredSound measure_sound(CepstraReader& reader, const SpeechPart& part) {
  MeasuredSound sound;
  if (part.samples.empty()) return sound;
  std::vector<std::int16_t> whole;
  Trace trace{part.loud, 0};
  whole.reserve(part.samples.size());
  denoise(part.samples, part.snr,
          [&](std::span<const float> samples) { to_whole(samples, trace, whole); });
  sound.speech = part.speech;
  reader.push(whole, sound.cepstra);
  reader.finish(sound.cepstra);
  sound.levels = smooth_levels(whole, sound.cepstra.size());
  return sound;
}

FrameScores score_frames(const SoundModel& model, const MeasuredSound& sound, std::size_t first,
                         std::size_t count) {
  FrameScores scores;
  const auto& cepstra = sound.cepstra;
  if (first >= cepstra.size()) return scores;
  count = std::min(count, cepstra.size() - first);
  const std::size_t begin = first > kMeanReach ? first - kMeanReach : 0;
  const std::size_t end = std::min(first + count + kMeanReach, cepstra.size());
  const Cepstrum mean = mean_of_speech(
      std::span(cepstra).subspan(begin, end - begin),
      std::span(sound.speech).subspan(std::min(begin, sound.speech.size())), kSpeechAndPauses);
  std::vector<float> around, voices;
  for (std::size_t t = begin; t < end; ++t) {
    around.push_back(sound.levels[t]);
    if (is_speech(sound.speech, t)) voices.push_back(sound.levels[t]);
  }
  const float lowest = *std::min_element(around.begin(), around.end());
  const float quiet = std::min(exceeded(around, kFloor), lowest + kAboveLowest);
  scores.range = exceeded(voices.empty() ? around : voices, kLoud) - quiet;
  scores.states = model.states();
  scores.values.resize(count * scores.states);
  for (std::size_t t = 0; t < count; ++t) {
    score_states(model, features_of(cepstra, first + t, mean),
                 std::span(scores.values).subspan(t * scores.states, scores.states));
    scores.levels.push_back(sound.levels[first + t] - quiet);
  }
  take_free_path(model, scores);
  return scores;
}

}  // namespace animeme::voice
