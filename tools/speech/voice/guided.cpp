#include "tools/speech/voice/guided.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace animeme::voice {

namespace {

constexpr double kEarliest = 0.3;       // of a block: no cut before
constexpr std::size_t kShortPause = 8;  // frames

// Chosen on every fourth of Debian's English recordings and every tenth training sentence of GRID
// that has sound (listen_table); the tables have others.
constexpr double kLean = 12;          // what a word that is sure adds to the log likelihood
constexpr double kBeliefPower = 0.3;  // the library is too sure of what it prefers
constexpr std::size_t kBorder = 2;    // frames by which phones of words may move
// The evidence that these are the words at all: how usual they are beside each other, and how far
// the phones without words agree. It grows with their number.
constexpr double kEvidenceWords = 8, kPrior = -1.5;
constexpr double kUsual = 20, kUsualFrom = -0.25;  // of the log probability of a frame
constexpr double kAgree = 12, kAgreeFrom = 0.58;   // of the votes for phones of the same shape

// Of the phones of a word.
std::vector<std::size_t> numbers_of(const HearingModel& model, const FoundWord& word) {
  std::vector<std::size_t> numbers;
  for (const std::string& phone : word.phones) {
    const auto& all = model.sound.phones;
    const auto at = std::find(all.begin(), all.end(), phone);
    if (at != all.end()) numbers.push_back(std::size_t(at - all.begin()));
  }
  return numbers;
}

// The phone of each frame of a word: the best path through its states.
std::vector<std::size_t> spread(const std::vector<std::size_t>& phones,
                                std::span<const std::vector<float>> scores) {
  const std::size_t length = scores.size(), states = phones.size() * kStatesPerPhone;
  std::vector<std::size_t> out(length);
  if (length < states) {
    for (std::size_t i = 0; i < length; ++i) out[i] = phones[i * phones.size() / length];
    return out;
  }
  constexpr double kNever = -1e30;
  std::vector<std::vector<bool>> moved(length, std::vector<bool>(states));
  std::vector<double> best(states, kNever), next(states);
  for (std::size_t i = 0; i < length; ++i) {
    for (std::size_t s = 0; s < states; ++s) {
      const double move = s > 0 ? best[s - 1] : (i == 0 ? 0 : kNever);
      moved[i][s] = move > best[s];
      const std::size_t state = phones[s / kStatesPerPhone] * kStatesPerPhone + s % kStatesPerPhone;
      next[s] = std::max(best[s], move) + double(scores[i][state]);
    }
    std::swap(best, next);
  }
  std::size_t s = states - 1;
  for (std::size_t i = length; i-- > 0;) {
    out[i] = phones[s / kStatesPerPhone];
    if (moved[i][s] && s > 0) --s;
  }
  return out;
}

}  // namespace

std::size_t cut_in_pause(const HearingModel& model, const Path& path, std::size_t most) {
  const std::size_t end = std::min(path.size(), most);
  std::size_t best = end, longest = kShortPause, run = 0;
  for (std::size_t i = 0; i < end; ++i) {
    run = model.labels[path[i]] == dam::kSilence ? run + 1 : 0;
    const std::size_t middle = i + 1 - run / 2;
    if (run <= longest || double(middle) < kEarliest * double(most)) continue;
    longest = run;
    best = middle;
  }
  return best;
}

std::vector<WordPath> judge_words(const HearingModel& model,
                                  std::span<const std::vector<float>> scores, const Votes& votes,
                                  std::vector<FoundWord> words) {
  std::vector<WordPath> paths;
  double agreed = 0, usual = 0, count = 0;
  for (FoundWord& word : words) {
    word.end = std::min(word.end, scores.size());
    const auto numbers = numbers_of(model, word);
    if (word.first >= word.end || numbers.empty()) continue;
    WordPath path;
    path.phones = spread(numbers, scores.subspan(word.first, word.end - word.first));
    double kin = 0;
    for (std::size_t i = 0; i < path.phones.size(); ++i) {
      for (std::size_t p = 0; p < model.labels.size(); ++p) {
        const bool same = model.classes[p] == model.classes[path.phones[i]];
        kin += same ? double(votes[word.first + i][p]) : 0;
      }
    }
    const auto frames = double(path.phones.size());
    agreed += kin;
    usual += word.language;
    count += frames;
    path.word = std::move(word);
    path.word.belief = std::pow(path.word.belief, kBeliefPower) * kin / frames;
    paths.push_back(std::move(path));
  }
  if (paths.empty()) return paths;
  const double each =
      kUsual * (usual / count - kUsualFrom) + kAgree * (agreed / count - kAgreeFrom);
  const double evidence = double(paths.size()) / kEvidenceWords * each + kPrior;
  // What is not believed leaves no trace: a lean of each frame adds up over a phone.
  const double trust = evidence > 0 ? 1 - std::exp(-evidence) : 0;
  for (WordPath& path : paths) path.word.belief *= trust;
  return paths;
}

void lean_on_words(const std::vector<WordPath>& words, std::vector<std::vector<float>>& scores) {
  const std::vector<std::vector<float>> plain = scores;
  for (const WordPath& path : words) {
    const auto gain = float(kLean * path.word.belief);
    for (std::size_t i = 0; i < path.phones.size(); ++i) {
      const std::size_t at = path.word.first + i, state = path.phones[i] * kStatesPerPhone;
      const std::size_t first = at > kBorder ? at - kBorder : 0;
      for (std::size_t k = first; k < std::min(at + kBorder + 1, scores.size()); ++k) {
        for (std::size_t s = state; s < state + kStatesPerPhone; ++s) {
          scores[k][s] = std::max(scores[k][s], plain[k][s] + gain);
        }
      }
    }
  }
}

}  // namespace animeme::voice
