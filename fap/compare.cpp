#include "fap/compare.h"

#include <cmath>
#include <cstdlib>

#include "fap/detail/walk.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

class Comparer {
 public:
  void frame_of_one_clip(const Frame& frame) { note_difference(frame.number); }

  void frame_of_both(const Frame& a, const Frame& b) {
    ++d_.frames_both;
    if (a == b) {
      for (std::size_t fap = 1; fap <= kFapCount; ++fap) d_.fap[fap].frames += a.mask[fap];
      return;
    }
    for (std::size_t fap = 1; fap <= kFapCount; ++fap) {
      if (a.mask[fap] && b.mask[fap]) {
        values(fap, a, b);
      } else if (a.mask[fap] || b.mask[fap]) {
        ++(a.mask[fap] ? d_.fap[fap].only_a : d_.fap[fap].only_b);
        ++d_.mask_differences;
        note_difference(a.number);
      }
    }
  }

  Difference finish() {
    double squares = 0;
    std::int64_t count = 0;
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      FapDifference& f = d_.fap[fap];
      if (f.frames == 0) continue;
      const double step = info(int(fap)).quant_step;
      f.rms = std::sqrt(squares_[fap] / double(f.frames));
      f.rms_steps = f.rms / step;
      f.max_steps = double(f.max) / step;
      squares += squares_[fap] / (step * step);
      count += f.frames;
      if (f.max_steps > d_.max_steps) {
        d_.max_steps = f.max_steps;
        d_.max_fap = int(fap);
      }
    }
    if (count > 0) d_.rms_steps = std::sqrt(squares / double(count));
    return d_;
  }

  Difference& difference() { return d_; }

 private:
  void note_difference(std::int64_t number) {
    if (d_.first_difference < 0) d_.first_difference = number;
  }

  void values(std::size_t fap, const Frame& a, const Frame& b) {
    FapDifference& f = d_.fap[fap];
    ++f.frames;
    const bool same = fap == 1   ? a.viseme == b.viseme
                      : fap == 2 ? a.expression == b.expression
                                 : a.value[fap] == b.value[fap];
    if (same) return;
    ++f.differing;
    ++d_.value_differences;
    note_difference(a.number);
    if (fap < kFirstLowLevel) return;
    const std::int64_t distance = std::int64_t(a.value[fap]) - b.value[fap];
    squares_[fap] += double(distance) * double(distance);
    if (std::abs(distance) > f.max) {
      f.max = std::abs(distance);
      f.max_frame = a.number;
    }
  }

  Difference d_;
  std::array<double, kFapCount + 1> squares_{};
};

}  // namespace

Difference compare(const Sequence& a, const Sequence& b) {
  Comparer comparer;
  Difference& d = comparer.difference();
  d.frames_a = std::int64_t(a.frames.size());
  d.frames_b = std::int64_t(b.frames.size());
  d.same_rate = a.rate == b.rate;
  walk_side_by_side(
      a.frames, b.frames, [&](const Frame& one) { comparer.frame_of_one_clip(one); },
      [&](const Frame& left, const Frame& right) { comparer.frame_of_both(left, right); });
  return comparer.finish();
}

}  // namespace animeme::fap
