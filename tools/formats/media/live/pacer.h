/// @file
/// When to send: a replaceable clock, and a pacer that follows it.
///
///     Pacer pacer(steady_clock());
///     while (auto due = input.next_due()) {
///       while (!pacer.wait_until(*due)) sink.poll();     // returns at least every 50 ms
///       for (LiveUnit& unit : input.take(*due)) sink.send(unit);
///       pacer.sent(*due);
///     }
///
/// Times are absolute: a unit is due at the start of the presentation plus its own time, not at a
/// distance from the previous unit. So errors do not accumulate, and the sender keeps to the
/// machine's steady clock for days.
#pragma once

#include <array>
#include <cstdint>

namespace animeme::media {

/// Monotonic seconds from an arbitrary origin.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() = 0;  ///< seconds, never less than before
  /// Returns at `instant` or a little later; immediately if it has passed.
  virtual void sleep_until(double instant) = 0;
};

/// The machine's steady clock, which really sleeps. Lives as long as the program.
Clock& steady_clock();

/// A simulated clock that jumps instead of sleeping, so that presentations run as fast as possible.
class JumpingClock : public Clock {
 public:
  double now() override { return now_; }  ///< where it jumped to
  void sleep_until(double instant) override {
    if (instant > now_) now_ = instant;
  }

 private:
  double now_ = 0;
};

/// Statistics of lateness in seconds, in constant memory. Negative values count as 0.
class LatenessMeter {
 public:
  void add(double seconds);                      ///< adds a value, seconds
  void add(const LatenessMeter& other);          ///< adds all values of another meter
  std::int64_t count() const { return count_; }  ///< values added
  std::int64_t count_below(
      double seconds) const;           ///< values below, to the precision of percentile()
  double sum() const { return sum_; }  ///< seconds
  /// Seconds; 0 if nothing was added.
  double mean() const { return count_ == 0 ? 0 : sum_ / double(count_); }
  double worst() const { return worst_; }  ///< seconds; 0 if nothing was added
  /// The value that a share of `part` (0..1) does not exceed: exact to 0.1 ms below 0.2 s, to 5 %
  /// above; 0 if nothing was added.
  double percentile(double part) const;

 private:
  // 0.1 ms steps up to 0.2 s, then steps that grow by 5 % up to about an hour.
  static constexpr int kFine = 2000, kCoarse = 202;
  static double upper_border(int bin);
  std::array<std::int64_t, kFine + kCoarse> bins_{};
  std::int64_t count_ = 0;
  double sum_ = 0, worst_ = 0;
};

/// Runs a presentation by a clock. Time 0 of the presentation is the instant of construction or of
/// the last restart().
class Pacer {
 public:
  /// wait_until() sleeps at most `slice` seconds. The clock must outlive the pacer.
  explicit Pacer(Clock& clock, double slice = 0.05);

  /// Time 0 is `lead` seconds from now (negative: ago).
  void restart(double lead = 0);
  /// Presentation time.
  double now() const;
  /// Sleeps towards presentation time `due`, for one slice at most. True once it is reached.
  bool wait_until(double due);
  /// Records that what was due at `due` has just been sent.
  void sent(double due);
  const LatenessMeter& lateness() const { return lateness_; }  ///< of everything sent

 private:
  Clock* clock_;
  double slice_;
  double start_;
  LatenessMeter lateness_;
};

}  // namespace animeme::media
