#include "tools/speech/voice/confidence.h"

#include <algorithm>
#include <cmath>

#include "dam/script/phones.h"

namespace animeme::voice {

namespace {

// The confidence of a recording is logistic in its score a frame and in the share of the sound that
// the text explains. Fitted to right texts, wrong ones and noise: forty sentences of grid_s1, clean
// and at 10 and 5 dB (`align_table --texts --every 12`, from 0 and 7), and to 48 recordings of
// Spanish, French and Italian (`--lines --every 6`). Others are reported
// (tools/speech/voice/measured.md). What more than `most_explained` tells is told by the score;
// half-spoken texts stay below 1.
struct Weights {
  double score, explained, most_explained, constant;
};
constexpr Weights kEnglishWeights{3.5, 6, 1, 5.4}, kOtherWeights{2.6, 58, 0.12, 3};
constexpr double kLeastScore = -4.2;  // below, the score says nothing
// A word that is not said counts as badly as one that does not fit at all; speech that the text
// does not have less: it may be right as far as it goes.
constexpr double kUnsaid = -5, kForeign = -1.5;

// Words and phones: a right word is now and then far off, and the fewer frames it has the less they
// tell, so that the confidence of a short one stays nearer to 0.5.
constexpr double kMiddleOfPart = -3.3, kWidthOfPart = 0.6, kFewFrames = 5;

struct Mean {
  double sum = 0, frames = 0;
  void add(const Segment& segment) {
    sum += segment.score * double(segment.frames);
    frames += double(segment.frames);
  }
  double confidence() const {
    if (frames == 0) return 0;
    const double weight = frames / (frames + kFewFrames);
    return 1 / (1 + std::exp(weight * (kMiddleOfPart - sum / frames) / kWidthOfPart));
  }
};

}  // namespace

double rate_phone(const Segment& segment) {
  if (segment.foreign) return 0;
  Mean mean;
  mean.add(segment);
  return mean.confidence();
}

std::vector<AlignedWord> rate_words(const std::vector<Segment>& segments,
                                    const std::vector<SpokenWord>& words, double duration) {
  std::vector<AlignedWord> rated;
  double now = 0;
  const auto miss = [&](std::size_t until) {
    while (rated.size() < until) {
      const SpokenWord& word = words[rated.size()];
      rated.push_back({word.text, now, now, 0, false, !word.variants.empty()});
    }
  };
  Mean mean;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const double end =
        std::min(i + 1 < segments.size() ? segments[i + 1].start : duration, duration);
    if (segment.word != kNoWord) {
      if (segment.word >= rated.size()) {
        miss(segment.word);
        mean = {};
        const SpokenWord& word = words[segment.word];
        rated.push_back({word.text, segment.start, 0, 0, true, !word.variants.empty()});
      }
      mean.add(segment);
      rated.back().end = end;
      rated.back().confidence = segment.foreign ? 0 : mean.confidence();
      now = end;
    }
  }
  miss(words.size());
  return rated;
}

double rate_recording(const Recognised& recognised, const std::vector<SpokenWord>& words,
                      bool english) {
  Mean mean;
  double phones = 0, said = 0, foreign = 0;
  std::size_t last = kNoWord;
  std::vector<bool> found(words.size());
  for (const Segment& segment : recognised.segments) {
    if (segment.foreign) {
      foreign += segment.label == dam::kSilence ? 0 : double(segment.frames);
      continue;
    }
    if (segment.word == kNoWord) continue;
    mean.add(segment);
    found[segment.word] = true;
    if (segment.word != last) said += double(words[segment.word].variants[0].size());
    last = segment.word;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    // A guess that is not found may be a wrong guess: it costs its word only.
    if (words[i].variants.empty() || (words[i].guessed && !found[i])) continue;
    phones += double(words[i].variants[0].size());
  }
  if (mean.frames == 0) return 0;
  const double share = said / phones;
  const double score = mean.sum / mean.frames * share + kUnsaid * (1 - share) +
                       kForeign * foreign / (mean.frames + foreign);
  const Weights& weights = english ? kEnglishWeights : kOtherWeights;
  return 1 /
         (1 + std::exp(-weights.score * std::max(score, kLeastScore) -
                       weights.explained * std::min(recognised.explained, weights.most_explained) -
                       weights.constant));
}

}  // namespace animeme::voice
