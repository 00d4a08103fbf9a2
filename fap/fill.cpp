#include "fap/fill.h"

#include <cmath>
#include <optional>
#include <string>

#include "fap/tables.h"

namespace animeme::fap {
namespace {

std::optional<Error> check(const Sequence& sequence, const FillOptions& options) {
  std::int64_t previous = -1;
  for (const Frame& frame : sequence.frames) {
    if (frame.number <= previous) {
      return make_error(Code::invalid_argument, "the frame numbers have to ascend from 0, but " +
                                                    std::to_string(frame.number) + " follows " +
                                                    std::to_string(previous));
    }
    previous = frame.number;
  }
  if (previous >= options.max_frames) {
    return make_error(Code::out_of_range, "the clip runs to frame " + std::to_string(previous) +
                                              ", allowed are " +
                                              std::to_string(options.max_frames) +
                                              " frames: correct the frame numbers or raise "
                                              "max_frames");
  }
  return std::nullopt;
}

// What the receiver shows, frame after frame.
class Receiver {
 public:
  explicit Receiver(const FillOptions& options) : options_(options) {}

  void receive(const Frame& frame) {
    hold_events();
    if (frame.mask[1]) shown_.viseme = frame.viseme;
    if (frame.mask[2]) shown_.expression = frame.expression;
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frame.mask[fap]) shown_.value[fap] = frame.value[fap];
    }
    sent_ |= frame.mask;
    const Mask known = options_.prefer_partner ? derive(frame.mask) | sent_ : sent_;
    shown_.mask = derive(known);
  }

  // A frame in which nothing arrives.
  void hold_events() {
    shown_.viseme.def = false;
    shown_.expression.def = false;
    shown_.expression.init_face = false;
  }

  const Frame& shown() const { return shown_; }

 private:
  // Gives values to the FAPs that follow from those in `known`.
  Mask derive(Mask known) {
    if (options_.mirror) known = copy(known, &FapInfo::mirror);
    if (options_.lips) known = copy(known, &FapInfo::partner);
    if (options_.mirror && options_.lips) known = copy(known, &FapInfo::mirror);
    return known;
  }

  Mask copy(const Mask& known, int FapInfo::*other) {
    Mask result = known;
    for (const FapInfo& fap : kFaps) {
      const std::size_t to = std::size_t(fap.number);
      const std::size_t from = std::size_t(fap.*other);
      if (from == 0 || known[to] || !known[from]) continue;
      shown_.value[to] = shown_.value[from];
      result.set(to);
    }
    return result;
  }

  const FillOptions& options_;
  Mask sent_;
  Frame shown_;
};

Mask final_mask(Mask mask, bool keep_high_level) {
  Mask low = mask;
  low.reset(1);
  low.reset(2);
  return keep_high_level || low.none() ? mask : low;
}

void apply_mask(Frame& frame, const Mask& mask) {
  frame.mask = mask;
  if (!mask[1]) frame.viseme = {};
  if (!mask[2]) frame.expression = {};
}

std::int32_t between(std::int32_t a, std::int32_t b, double part) {
  return std::int32_t(std::lround(double(a) + (double(b) - double(a)) * part));
}

// Replaces the low-level values of the frames strictly between `from` and `to`.
void interpolate(std::vector<Frame>& frames, std::size_t from, std::size_t to) {
  for (std::size_t i = from + 1; i < to; ++i) {
    const double part = double(i - from) / double(to - from);
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      frames[i].value[fap] = between(frames[from].value[fap], frames[to].value[fap], part);
    }
  }
}

}  // namespace

Result<Sequence> fill(const Sequence& sequence, const FillOptions& options) {
  if (auto error = check(sequence, options)) return std::move(*error);
  Sequence filled{sequence.rate, {}, sequence.name};
  if (sequence.frames.empty()) return filled;
  filled.frames.reserve(std::size_t(sequence.frames.back().number + 1));
  Receiver receiver(options);
  const auto show = [&] {
    filled.frames.push_back(receiver.shown());
    filled.frames.back().number = std::int64_t(filled.frames.size()) - 1;
  };
  for (const Frame& frame : sequence.frames) {
    while (std::int64_t(filled.frames.size()) < frame.number) {
      receiver.hold_events();
      show();
    }
    receiver.receive(frame);
    show();
  }
  if (options.interpolate) {
    std::size_t previous = std::size_t(sequence.frames.front().number);
    for (const Frame& frame : sequence.frames) {
      interpolate(filled.frames, previous, std::size_t(frame.number));
      previous = std::size_t(frame.number);
    }
  }
  const Mask mask = final_mask(receiver.shown().mask, options.keep_high_level);
  for (Frame& frame : filled.frames) apply_mask(frame, mask);
  return filled;
}

}  // namespace animeme::fap
