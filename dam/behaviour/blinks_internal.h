// When lids close, and how.
#pragma once

#include <cstddef>
#include <deque>

#include "dam/behaviour/curves_internal.h"
#include "dam/behaviour/mode_internal.h"

namespace animeme::dam::behaviour {

class Blinks {
 public:
  /// `frame`: seconds between moments; lids meet at one of them.
  Blinks(std::uint64_t seed, double liveliness, double end, double frame);
  /// A phrase ends at `time`: a good moment for a blink that is due about then.
  void expect_border(double time, double now);
  /// Borders from `now` on will not come.
  void hush(double now);
  /// The eyes make a saccade of `size` degrees.
  void shift(double time, double size);
  /// What begins before `until`.
  void advance(double now, double until, Mode mode);
  /// 0 open .. 1 closed.
  double at(double time) const;
  std::size_t count() const { return count_; }

 private:
  struct Blink {
    double start = 0, down = 0, shut = 0, up = 0, depth = 1;
    double end() const { return start + down + shut + up; }
  };
  double interval(Mode mode);
  void attract();
  void begin(double time);

  Draw draw_;
  double liveliness_, end_, frame_;
  Mode mode_ = Mode::idle;
  Blink blink_;           // the last one
  double next_ = 0;       // the next one
  double clock_ = 0;      // where it would be if nothing attracted it: keeps the rate
  bool doubled_ = false;  // the last one was the second of two
  std::deque<double> borders_;
  std::size_t count_ = 0;
};

}  // namespace animeme::dam::behaviour
