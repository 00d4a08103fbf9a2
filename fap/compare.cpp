#include "fap/compare.h"

#include <cmath>
#include <cstdlib>

#include "fap/detail/walk.h"
#include "fap/tables.h"

namespace animeme::fap {

void Comparer::only_a(const Frame& frame) {
  ++difference_.frames_a;
  note_difference(frame.number);
}

void Comparer::only_b(const Frame& frame) {
  ++difference_.frames_b;
  note_difference(frame.number);
}

void Comparer::both(const Frame& a, const Frame& b) {
  Difference& d = difference_;
  ++d.frames_a;
  ++d.frames_b;
  ++d.frames_both;
  if (a == b) {
    for (std::size_t fap = 1; fap <= kFapCount; ++fap) d.fap[fap].frames += a.mask[fap];
    return;
  }
  for (std::size_t fap = 1; fap <= kFapCount; ++fap) {
    if (a.mask[fap] && b.mask[fap]) {
      compare_values(fap, a, b);
    } else if (a.mask[fap] || b.mask[fap]) {
      ++(a.mask[fap] ? d.fap[fap].only_a : d.fap[fap].only_b);
      ++d.mask_differences;
      note_difference(a.number);
    }
  }
}

Difference Comparer::compared(Rate rate_a, Rate rate_b) const {
  Difference d = difference_;
  d.same_rate = rate_a == rate_b;
  double squares = 0;
  std::int64_t count = 0;
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    FapDifference& f = d.fap[fap];
    if (f.frames == 0) continue;
    const double step = info(int(fap)).quant_step;
    f.rms = std::sqrt(squares_[fap] / double(f.frames));
    f.rms_steps = f.rms / step;
    f.max_steps = double(f.max) / step;
    squares += squares_[fap] / (step * step);
    count += f.frames;
    if (f.max_steps > d.max_steps) {
      d.max_steps = f.max_steps;
      d.max_fap = int(fap);
    }
  }
  if (count > 0) d.rms_steps = std::sqrt(squares / double(count));
  return d;
}

void Comparer::note_difference(std::int64_t number) {
  if (difference_.first_difference < 0) difference_.first_difference = number;
}

void Comparer::compare_values(std::size_t fap, const Frame& a, const Frame& b) {
  FapDifference& f = difference_.fap[fap];
  ++f.frames;
  const bool same = fap == 1   ? a.viseme == b.viseme
                    : fap == 2 ? a.expression == b.expression
                               : a.value[fap] == b.value[fap];
  if (same) return;
  ++f.differing;
  ++difference_.value_differences;
  note_difference(a.number);
  if (fap < kFirstLowLevel) return;
  const std::int64_t distance = std::int64_t(a.value[fap]) - b.value[fap];
  squares_[fap] += double(distance) * double(distance);
  if (std::abs(distance) > f.max) {
    f.max = std::abs(distance);
    f.max_frame = a.number;
  }
}

Difference compare(const Sequence& a, const Sequence& b) {
  Comparer comparer;
  walk_side_by_side(
      each_of(a.frames), each_of(b.frames), [&](const Frame& one) { comparer.only_a(one); },
      [&](const Frame& one) { comparer.only_b(one); },
      [&](const Frame& left, const Frame& right) { comparer.both(left, right); });
  return comparer.compared(a.rate, b.rate);
}

}  // namespace animeme::fap
