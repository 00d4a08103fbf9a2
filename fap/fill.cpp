#include "fap/fill.h"

#include <cmath>
#include <optional>
#include <string>

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
  return std::nullopt;
}

GroupRules same_rules(GroupRule rule) {
  GroupRules rules;
  rules.fill(rule);
  return rules;
}

// The FAPs whose groups have a rule.
Mask faps_with(const GroupRules& rules, GroupRule rule) {
  Mask mask;
  for (const FapInfo& fap : kFaps) {
    if (rules[std::size_t(fap.group - 1)] == rule) mask.set(std::size_t(fap.number));
  }
  return mask;
}

// The public decoder is this receiver with one rule and without lips.
FillOptions effective(FillOptions options) {
  if (options.like_public_decoder) {
    options.mirror = true;
    options.lips = false;
  }
  return options;
}

// What the receiver shows, frame after frame.
class Receiver {
 public:
  explicit Receiver(const FillOptions& options) : options_(effective(options)) {}

  void receive(const Frame& frame, const GroupRules& said) {
    const GroupRules rules =
        options_.like_public_decoder ? same_rules(GroupRule::interpolate) : said;
    hold_events();
    if (frame.mask[1]) shown_.viseme = frame.viseme;
    if (frame.mask[2]) shown_.expression = frame.expression;
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frame.mask[fap]) shown_.value[fap] = frame.value[fap];
    }
    has_value_ |= frame.mask;
    follow(frame, faps_with(rules, GroupRule::interpolate));
    // Text: nobody said what absent FAPs do.
    const Mask unruled = faps_with(rules, GroupRule::unknown);
    Mask known = has_value_;
    if (options_.prefer_partner) known |= derive(frame.mask, unruled);
    shown_.mask |= derive(known, unruled);
  }

  // A frame in which nothing arrives.
  void hold_events() {
    shown_.viseme.def = false;
    shown_.expression.def = false;
    shown_.expression.init_face = false;
  }

  const Frame& shown() const { return shown_; }

 private:
  // Mask type 2: absent FAPs among `faps` take values of this very frame.
  void follow(const Frame& frame, const Mask& faps) {
    const Mask absent = faps & ~frame.mask;
    for (const FapInfo& fap : kFaps) {
      if (!absent[std::size_t(fap.number)]) continue;
      const std::size_t source = source_of(fap, frame.mask);
      if (source == 0) continue;
      shown_.value[std::size_t(fap.number)] = frame.value[source];
      has_value_.set(std::size_t(fap.number));
    }
  }

  // The FAP in `coded` that `fap` follows; 0 is none, and bit 0 of a mask is never set.
  std::size_t source_of(const FapInfo& fap, const Mask& coded) const {
    const std::size_t side = options_.mirror ? std::size_t(fap.mirror) : 0;
    const std::size_t contour = options_.lips ? std::size_t(fap.partner) : 0;
    const std::size_t across =
        contour != 0 && options_.mirror ? std::size_t(info(fap.partner).mirror) : 0;
    for (const std::size_t source : {side, contour, across}) {
      if (coded[source]) return source;
    }
    return 0;
  }

  // Gives values to those of `targets` that follow from the FAPs in `known`.
  Mask derive(Mask known, const Mask& targets) {
    if (options_.mirror) known = copy(known, targets, &FapInfo::mirror);
    if (options_.lips) known = copy(known, targets, &FapInfo::partner);
    if (options_.mirror && options_.lips) known = copy(known, targets, &FapInfo::mirror);
    return known;
  }

  Mask copy(const Mask& known, const Mask& targets, int FapInfo::*other) {
    Mask result = known;
    for (const FapInfo& fap : kFaps) {
      const std::size_t to = std::size_t(fap.number);
      const std::size_t from = std::size_t(fap.*other);
      if (from == 0 || !targets[to] || known[to] || !known[from]) continue;
      shown_.value[to] = shown_.value[from];
      result.set(to);
    }
    return result;
  }

  const FillOptions options_;
  Mask has_value_;  // sent, or derived under rule interpolate
  Frame shown_;     // its mask grows: all FAPs that ever had a value
};

Mask final_mask(Mask mask, const FillOptions& options) {
  Mask low = mask;
  low.reset(1);
  low.reset(2);
  const bool high_level_alone = low.none() && mask.any();
  if (options.complete && !high_level_alone) {
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) low.set(fap);
  }
  return options.keep_high_level || high_level_alone ? mask | low : low;
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
  return fill(sequence, {}, options);
}

Result<Sequence> fill(const Sequence& sequence, std::span<const GroupRules> rules,
                      const FillOptions& options) {
  if (auto error = check(sequence, rules.size(), options)) return std::move(*error);
  Sequence filled{sequence.rate, {}, sequence.name};
  if (sequence.frames.empty()) return filled;
  filled.frames.reserve(std::size_t(sequence.frames.back().number + 1));
  Receiver receiver(options);
  const auto show = [&] {
    filled.frames.push_back(receiver.shown());
    filled.frames.back().number = std::int64_t(filled.frames.size()) - 1;
  };
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    while (std::int64_t(filled.frames.size()) < sequence.frames[i].number) {
      receiver.hold_events();
      show();
    }
    receiver.receive(sequence.frames[i], rules.empty() ? GroupRules{} : rules[i]);
    show();
  }
  if (options.interpolate) {
    std::size_t previous = std::size_t(sequence.frames.front().number);
    for (const Frame& frame : sequence.frames) {
      interpolate(filled.frames, previous, std::size_t(frame.number));
      previous = std::size_t(frame.number);
    }
  }
  const Mask mask = final_mask(receiver.shown().mask, options);
  for (Frame& frame : filled.frames) apply_mask(frame, mask);
  return filled;
}

}  // namespace animeme::fap
