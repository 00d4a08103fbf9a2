#include "fap/turns.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace animeme::fap {
namespace {

constexpr std::int32_t kFine = 60, kCoarse = 2000;  // 1e-5 rad
// Found by simulation of turns, nods, sways and still heads at 25 and 60 frames a second, coded
// with quantiser 1: acceleration that the coder added, RMS, is a third of that of coded values.
constexpr double kFollow = 0.15, kFollowSpeed = 0.005, kTakeSpeed = 0.35;
constexpr int kPasses = 8;
constexpr int kCertain = 3;  // changes from which on the step is known

bool is_eased(std::int32_t step) { return step >= kFine && step <= kCoarse; }

double within(double value, std::int32_t coded, std::int32_t step) {
  return std::clamp(value, coded - 0.5 * step, coded + 0.5 * step);
}

// One frame on: the value is taken along at its speed, and both go after what is coded.
void advance(std::int32_t coded, std::int32_t step, double& value, double& speed) {
  const double expected = value + speed, off = coded - expected;
  const double wanted = expected + kFollow * off;
  const double next = within(wanted, coded, step);
  if (next != wanted) {
    speed += kTakeSpeed * (next - value - speed);
  } else {
    speed += kFollowSpeed * off;
  }
  value = next;
}

std::vector<double> eased(const std::vector<std::int32_t>& coded, std::int32_t step) {
  const std::size_t n = coded.size();
  std::vector<double> out(n);
  double value = coded.front(), speed = 0;
  for (std::size_t i = 0; i < n; ++i) {
    advance(coded[i], step, value, speed);
    out[i] = 0.5 * value;
  }
  value = coded.back();
  speed = 0;
  for (std::size_t i = n; i-- > 0;) {
    advance(coded[i], step, value, speed);
    out[i] += 0.5 * value;
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    double before = out.front();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double mean = 0.25 * before + 0.5 * out[i] + 0.25 * out[i + 1];
      before = out[i];
      out[i] = within(mean, coded[i], step);
    }
  }
  return out;
}

}  // namespace

Frame TurnSmoother::next(const Frame& frame) {
  Frame out = frame;
  for (std::size_t k = 0; k < kTurnFaps.size(); ++k) {
    const auto fap = std::size_t(kTurnFaps[k]);
    Turn& turn = turns_[k];
    if (!frame.mask[fap]) {
      turn = {};
      continue;
    }
    const std::int32_t coded = frame.value[fap];
    turn.step = std::gcd(turn.step, coded);
    if (coded != turn.coded && turn.changes < kCertain) ++turn.changes;
    turn.coded = coded;
    if (turn.changes < kCertain || !is_eased(turn.step)) {
      turn.value = coded;
      turn.speed = 0;
      continue;
    }
    advance(coded, turn.step, turn.value, turn.speed);
    out.value[fap] = std::int32_t(std::lround(turn.value));
  }
  return out;
}

void smooth_turns(Sequence& clip) {
  std::vector<std::int32_t> coded;
  std::vector<Frame*> frames;
  for (const int fap : kTurnFaps) {
    coded.clear();
    frames.clear();
    std::int32_t step = 0;
    for (Frame& frame : clip.frames) {
      if (!frame.mask[std::size_t(fap)]) continue;
      frames.push_back(&frame);
      coded.push_back(frame.value[std::size_t(fap)]);
      step = std::gcd(step, coded.back());
    }
    if (!is_eased(step)) continue;
    const std::vector<double> values = eased(coded, step);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i]->value[std::size_t(fap)] = std::int32_t(std::lround(values[i]));
    }
  }
}

}  // namespace animeme::fap
