#include "tools/speech/voice/review_words.h"

#include <algorithm>

#include "dam/script/timings.h"

namespace animeme::voice {

namespace {

constexpr double kFramesPerSecond = 100;
constexpr float kForbidden = 1e6f;
// Chosen on 20 pairs of sentences of grid_s1 (`align_table --edits --every 12`), clean and at 10
// dB: ten more of 33 missed words are found for seven of 1899 that are said.
constexpr double kSqueezed = 0.45;  // of the usual length, at the pace of the recording
constexpr double kLoss = -10;       // logarithm of the likelihood

struct Placed {
  std::size_t word = 0, variant = 0, first = 0, last = 0;  // frames, behind the last one
};

std::vector<Placed> said_words(std::span<const PathPart> parts) {
  std::vector<Placed> said;
  for (const PathPart& part : parts) {
    if (part.kind != PartKind::phone) continue;
    if (said.empty() || said.back().word != part.word) {
      said.push_back({part.word, part.variant, part.first, 0});
    }
    said.back().last = part.first + part.frames;
  }
  return said;
}

double usual_frames(const SoundModel& model, const WordModel& word, std::size_t variant) {
  double seconds = 0;
  for (const std::uint8_t phone : word.variants[variant]) {
    if (model.phones[phone] == "SIL") continue;  // between the words of a reading
    seconds += dam::usual_duration(model.phones[phone]);
  }
  return kFramesPerSecond * seconds;
}

FrameScores part_of(const FrameScores& scores, std::size_t first, std::size_t last) {
  FrameScores part;
  part.states = scores.states;
  part.values.assign(scores.values.begin() + std::ptrdiff_t(first * scores.states),
                     scores.values.begin() + std::ptrdiff_t(last * scores.states));
  return part;
}

// What the words around the i-th and itself score more than they do without it.
double gain_of(const SoundModel& model, const FrameScores& scores, std::span<const WordModel> words,
               std::span<const Placed> said, std::size_t i, const PathCosts& costs) {
  const std::size_t before = i > 0 ? i - 1 : 0, behind = std::min(i + 1, said.size() - 1);
  const std::size_t first = i > 0 ? said[before].first : 0;
  const std::size_t last = i < behind ? said[behind].last : scores.frames();
  const FrameScores around = part_of(scores, first, last);
  std::vector<WordModel> some;
  for (std::size_t k = before; k <= behind; ++k) some.push_back(words[said[k].word]);
  const double with = double(find_path(model, around, some, costs, false).total);
  some.erase(some.begin() + std::ptrdiff_t(i - before));
  return with - double(find_path(model, around, some, costs, false).total);
}

}  // namespace

std::vector<std::size_t> squeezed_words(const SoundModel& model, const FrameScores& scores,
                                        std::span<const WordModel> words,
                                        std::span<const PathPart> parts, const PathCosts& costs) {
  const auto said = said_words(parts);
  if (said.empty()) return {};
  std::vector<double> lengths;
  for (const Placed& one : said) {
    lengths.push_back(double(one.last - one.first) /
                      usual_frames(model, words[one.word], one.variant));
  }
  auto sorted = lengths;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  PathCosts all = costs;
  all.skip = all.skip_word = kForbidden;
  std::vector<double> losses(said.size(), 0);
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (words[said[i].word].weak || lengths[i] >= kSqueezed * *middle) continue;
    losses[i] = std::min(0.0, gain_of(model, scores, words, said, i, all) - kLoss);
  }
  // Of neighbours that squeeze each other only the worse one: the other then has its place.
  std::vector<std::size_t> squeezed;
  for (std::size_t i = 0; i < said.size(); ++i) {
    const bool worse_before = i > 0 && losses[i - 1] < losses[i];
    const bool worse_behind = i + 1 < said.size() && losses[i + 1] <= losses[i];
    if (losses[i] < 0 && !worse_before && !worse_behind) squeezed.push_back(said[i].word);
  }
  return squeezed;
}

}  // namespace animeme::voice
