#include "tools/voice/confidence.h"

#include <algorithm>
#include <cmath>

namespace animeme::voice {

namespace {

// Where right and wrong texts meet, in scores a frame, and how fast one gives way to the other:
// twenty sentences of grid_s1 chose it, others are reported (tools/voice/README.md, "Measured").
constexpr double kMiddle = -32, kWidth = 4;

double confidence_of(double score) { return 1 / (1 + std::exp((kMiddle - score) / kWidth)); }

struct Mean {
  double sum = 0, frames = 0;
  void add(const Segment& segment) {
    sum += segment.score * double(segment.frames);
    frames += double(segment.frames);
  }
  double confidence() const { return frames > 0 ? confidence_of(sum / frames) : 0; }
};

}  // namespace

std::vector<AlignedWord> rate_words(const std::vector<Segment>& segments,
                                    const std::vector<SpokenWord>& words, double duration) {
  std::vector<AlignedWord> rated;
  std::size_t last = kNoWord;
  Mean mean;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    if (segment.word == kNoWord) continue;
    if (segment.word != last) {
      mean = {};
      rated.push_back({words[segment.word].text, segment.start, 0, 0});
      last = segment.word;
    }
    mean.add(segment);
    const double end = i + 1 < segments.size() ? segments[i + 1].start : duration;
    rated.back().end = std::min(end, duration);
    rated.back().confidence = mean.confidence();
  }
  return rated;
}

double rate_recording(const std::vector<Segment>& segments) {
  Mean mean;
  for (const Segment& segment : segments) {
    if (segment.word != kNoWord) mean.add(segment);
  }
  return mean.confidence();
}

}  // namespace animeme::voice
