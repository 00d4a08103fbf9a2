#include "tools/voice/confidence.h"

#include <algorithm>
#include <cmath>

#include "dam/script/phones.h"

namespace animeme::voice {

namespace {

// Where right and wrong texts meet, in scores a frame, and how fast one gives way to the other:
// twenty sentences of grid_s1 chose it, others are reported (tools/voice/README.md, "Measured").
constexpr double kMiddle = -2.15, kWidth = 0.3;
// A word that is not said counts as badly as one that does not fit at all; speech that the text
// does not have less: it may be right as far as it goes.
constexpr double kUnsaid = -5, kForeign = -1.5;

// Words and phones: a right word is now and then far off, and the fewer frames it has the less they
// tell, so that the confidence of a short one stays nearer to 0.5.
constexpr double kMiddleOfPart = -3.3, kWidthOfPart = 0.6, kFewFrames = 5;

double confidence_of(double score) { return 1 / (1 + std::exp((kMiddle - score) / kWidth)); }

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

double rate_recording(const std::vector<Segment>& segments, const std::vector<SpokenWord>& words) {
  Mean mean;
  double phones = 0, said = 0, foreign = 0;
  std::size_t last = kNoWord;
  std::vector<bool> found(words.size());
  for (const Segment& segment : segments) {
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
  return confidence_of(mean.sum / mean.frames * share + kUnsaid * (1 - share) +
                       kForeign * foreign / (mean.frames + foreign));
}

}  // namespace animeme::voice
