#include "fap/resample.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fap/rate_text.h"

namespace animeme::fap {
namespace {

Frame on_the_way(const Frame& from, const Frame& to, double part) {
  Frame frame = part < 0.5 ? from : to;
  frame.mask = from.mask | to.mask;
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    const double a = from.value[fap];
    frame.value[fap] = std::int32_t(std::lround(a + (to.value[fap] - a) * part));
  }
  return frame;
}

}  // namespace

Resampler::Resampler(Rate from, Rate to)
    : step_(from.frames_per_second() / to.frames_per_second()) {}

void Resampler::push(const Frame& frame, const Emit& emit) {
  const double now = double(in_++);
  for (double at = double(out_) * step_; at <= now; at = double(out_) * step_) {
    Frame between = in_ == 1 ? frame : on_the_way(last_, frame, at - (now - 1));
    between.number = out_++;
    emit(between);
  }
  last_ = frame;
}

void Resampler::finish(const Emit& emit) {
  for (const std::int64_t all = frames(in_); out_ < all; ++out_) {
    last_.number = out_;
    emit(last_);
  }
}

std::int64_t Resampler::frames(std::int64_t frames) const {
  if (frames <= 0) return 0;
  // Those that push() gives out are there in any case, by the same sums.
  auto last = std::int64_t(double(frames - 1) / step_);
  while (double(last + 1) * step_ <= double(frames - 1)) ++last;
  while (double(last) * step_ > double(frames - 1)) --last;
  return std::max(last + 1, std::int64_t(std::llround(double(frames) / step_)));
}

Result<void> check_resampling(Rate from, Rate to, std::int64_t frames) {
  if (!from.valid() || !to.valid()) {
    return make_error(Code::invalid_argument, "a frame rate is above 0");
  }
  const double of_one = to.frames_per_second() / from.frames_per_second();
  if (of_one <= double(kMostOfOne) && double(frames) * of_one <= double(kMostResampled)) return {};
  return make_error(Code::out_of_range,
                    std::to_string(frames) + " frames at " + format_rate(from) +
                        " frames per second are too long for " + format_rate(to) +
                        " frames per second: at most " + std::to_string(kMostResampled) +
                        " frames are made, and " + std::to_string(kMostOfOne) +
                        " of a single one; choose a lower rate, or correct that of the input");
}

Sequence resample(const Sequence& filled, Rate to) {
  Sequence result{to, {}, filled.name};
  Resampler resampler(filled.rate, to);
  const auto emit = [&](const Frame& frame) { result.frames.push_back(frame); };
  for (const Frame& frame : filled.frames) resampler.push(frame, emit);
  resampler.finish(emit);
  return result;
}

}  // namespace animeme::fap
