#include "tools/formats/inspect/body_difference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace animeme::inspect {

namespace {

void note(BodyDifference& d, std::int64_t number) {
  if (d.first_difference < 0) d.first_difference = number;
}

void compare_frames(BodyDifference& d, const fba::BodyFrame& a, const fba::BodyFrame& b) {
  ++d.frames_both;
  for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) {
    BapDifference& one = d.bap[bap];
    if (a.mask[bap] != b.mask[bap]) {
      ++(a.mask[bap] ? one.only_a : one.only_b);
      ++d.mask_differences;
      note(d, a.number);
    }
    if (!a.mask[bap] || !b.mask[bap]) continue;
    ++one.frames;
    const std::int64_t distance = std::int64_t(a.value[bap]) - b.value[bap];
    if (distance == 0) continue;
    ++one.differing;
    ++d.value_differences;
    note(d, a.number);
    one.squares += double(distance) * double(distance);
    if (std::abs(distance) > one.max) {
      one.max = std::abs(distance);
      one.max_frame = a.number;
    }
  }
}

}  // namespace

double BapDifference::rms() const { return frames == 0 ? 0 : std::sqrt(squares / double(frames)); }

int bap_step(int number) {
  static const auto steps = [] {
    std::array<int, fba::kBapCount + 1> by_number{};
    for (std::size_t slot = 0; slot < fba::kBapOrder.size(); ++slot) {
      by_number[fba::kBapOrder[slot]] = fba::kBapSteps[slot];
    }
    return by_number;
  }();
  return steps[std::size_t(number)];
}

void BodyComparer::only_a(const fba::BodyFrame& frame) {
  ++difference_.frames_a;
  note(difference_, frame.number);
}

void BodyComparer::only_b(const fba::BodyFrame& frame) {
  ++difference_.frames_b;
  note(difference_, frame.number);
}

void BodyComparer::both(const fba::BodyFrame& a, const fba::BodyFrame& b) {
  ++difference_.frames_a;
  ++difference_.frames_b;
  compare_frames(difference_, a, b);
}

BodyDifference BodyComparer::compared(fap::Rate rate_a, fap::Rate rate_b) const {
  BodyDifference d = difference_;
  d.same_rate = rate_a == rate_b;
  double squares = 0;
  std::int64_t count = 0;
  for (int number = 1; number <= fba::kBapCount; ++number) {
    const BapDifference& one = d.bap[std::size_t(number)];
    const double step = bap_step(number);
    squares += one.squares / (step * step);
    count += one.frames;
    d.max_steps = std::max(d.max_steps, double(one.max) / step);
  }
  if (count > 0) d.rms_steps = std::sqrt(squares / double(count));
  return d;
}

}  // namespace animeme::inspect
