#include "fap/fill.h"

#include <cmath>
#include <optional>
#include <string>

#include "fap/receiver.h"

namespace animeme::fap {
namespace {

std::optional<Error> check(const Sequence& sequence, std::size_t rules,
                           const FillOptions& options) {
  if (rules != 0 && rules != sequence.frames.size()) {
    return make_error(Code::invalid_argument, "there are " + std::to_string(rules) + " rules for " +
                                                  std::to_string(sequence.frames.size()) +
                                                  " frames: give one for each, or none");
  }
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
  const std::int64_t missing = previous + 1 - std::int64_t(sequence.frames.size());
  if (missing > options.max_missing) {
    return make_error(Code::out_of_range,
                      "the clip runs to frame " + std::to_string(previous) + " but has only " +
                          std::to_string(sequence.frames.size()) + "; at most " +
                          std::to_string(options.max_missing) +
                          " frames that are missing are filled in: correct the frame numbers or "
                          "allow more");
  }
  return std::nullopt;
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
  return fill(sequence, {}, options);
}

Result<Sequence> fill(const Sequence& sequence, std::span<const GroupRules> rules,
                      const FillOptions& options) {
  if (auto error = check(sequence, rules.size(), options)) return std::move(*error);
  Sequence filled{sequence.rate, {}, sequence.name};
  if (sequence.frames.empty()) return filled;
  filled.frames.reserve(std::size_t(sequence.frames.back().number + 1));
  Receiver receiver(options);
  const auto show = [&](Frame shown) {
    shown.number = std::int64_t(filled.frames.size());
    filled.frames.push_back(shown);
  };
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    while (std::int64_t(filled.frames.size()) < sequence.frames[i].number) {
      show(receiver.hold());
    }
    show(receiver.receive(sequence.frames[i], rules.empty() ? GroupRules{} : rules[i]));
  }
  if (options.interpolate) {
    std::size_t previous = std::size_t(sequence.frames.front().number);
    for (const Frame& frame : sequence.frames) {
      interpolate(filled.frames, previous, std::size_t(frame.number));
      previous = std::size_t(frame.number);
    }
  }
  const Mask mask = receiver.mask();
  for (Frame& frame : filled.frames) frame = with_mask(frame, mask);
  return filled;
}

}  // namespace animeme::fap
