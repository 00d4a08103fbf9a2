#include "tools/formats/media/live/pacer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace animeme::media {

namespace {

constexpr double kFineStep = 1e-4;    // seconds
constexpr double kCoarseStep = 1.05;  // ratio

class MachineClock : public Clock {
 public:
  double now() override { return std::chrono::duration<double>(Steady::now() - origin_).count(); }
  void sleep_until(double instant) override {
    const std::chrono::duration<double> since(instant);
    std::this_thread::sleep_until(origin_ + std::chrono::ceil<Steady::duration>(since));
  }

 private:
  using Steady = std::chrono::steady_clock;
  const Steady::time_point origin_ = Steady::now();
};

}  // namespace

Clock& steady_clock() {
  static MachineClock clock;
  return clock;
}

double LatenessMeter::upper_border(int bin) {
  if (bin < kFine) return kFineStep * (bin + 1);
  return kFineStep * kFine * std::pow(kCoarseStep, bin - kFine + 1);
}

void LatenessMeter::add(double seconds) {
  seconds = std::max(0.0, seconds);
  int bin = 0;
  if (seconds < kFineStep * kFine) {
    bin = int(seconds / kFineStep);
  } else {
    bin = kFine + int(std::log(seconds / (kFineStep * kFine)) / std::log(kCoarseStep));
  }
  ++bins_[std::size_t(std::min(bin, kFine + kCoarse - 1))];
  ++count_;
  sum_ += seconds;
  worst_ = std::max(worst_, seconds);
}

void LatenessMeter::add(const LatenessMeter& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  count_ += other.count_;
  sum_ += other.sum_;
  worst_ = std::max(worst_, other.worst_);
}

std::int64_t LatenessMeter::count_below(double seconds) const {
  std::int64_t count = 0;
  for (int bin = 0; bin < kFine + kCoarse && upper_border(bin) <= seconds + kFineStep / 2; ++bin) {
    count += bins_[std::size_t(bin)];
  }
  return count;
}

double LatenessMeter::percentile(double part) const {
  const auto wanted = std::int64_t(std::ceil(part * double(count_)));
  std::int64_t seen = 0;
  for (int bin = 0; bin < kFine + kCoarse; ++bin) {
    seen += bins_[std::size_t(bin)];
    if (seen >= wanted && seen > 0) return std::min(upper_border(bin), worst_);
  }
  return worst_;
}

Pacer::Pacer(Clock& clock, double slice) : clock_(&clock), slice_(slice), start_(clock.now()) {}

void Pacer::restart(double lead) { start_ = clock_->now() + lead; }

double Pacer::now() const { return clock_->now() - start_; }

bool Pacer::wait_until(double due) {
  const double instant = start_ + due;
  const double now = clock_->now();
  if (now >= instant) return true;
  clock_->sleep_until(std::min(instant, now + slice_));
  return clock_->now() >= instant;
}

void Pacer::sent(double due) { lateness_.add(now() - due); }

}  // namespace animeme::media
