#include "fap/receiver.h"

#include "fap/tables.h"

namespace animeme::fap {
namespace {

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

}  // namespace

Receiver::Receiver(const FillOptions& options) : options_(effective(options)) {}

const Frame& Receiver::receive(const Frame& frame, const GroupRules& said) {
  const GroupRules rules = options_.like_public_decoder ? same_rules(GroupRule::interpolate) : said;
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
  shown_.number = frame.number;
  if (!options_.expand) return shown_;
  if (!expander_) expander_.emplace();
  expander_->receive(frame);
  return expand();
}

const Frame& Receiver::hold() {
  hold_events();
  ++shown_.number;
  return options_.expand ? expand() : shown_;
}

const Frame& Receiver::expand() {
  if (!expander_) expander_.emplace();
  if (options_.keep_expressions && shown_.mask[2]) {
    Frame others = shown_;
    others.mask.reset(2);
    expanded_ = expander_->expand(others);
    expanded_.mask.set(2);
    expanded_.expression = shown_.expression;
  } else {
    expanded_ = expander_->expand(shown_);
  }
  ever_ |= expanded_.mask;
  expanded_.mask = ever_;
  return expanded_;
}

Mask Receiver::mask() const {
  const Mask mask = options_.expand ? ever_ : shown_.mask;
  Mask low = mask;
  low.reset(1);
  low.reset(2);
  const bool high_level_alone = low.none() && mask.any();
  if (options_.complete && !high_level_alone) {
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) low.set(fap);
  }
  if (options_.expand && options_.keep_expressions && mask[2]) low.set(2);
  return options_.keep_high_level || high_level_alone ? mask | low : low;
}

void Receiver::hold_events() {
  shown_.viseme.def = false;
  shown_.expression.def = false;
  shown_.expression.init_face = false;
}

// Mask type 2: absent FAPs among `faps` take values of this very frame.
void Receiver::follow(const Frame& frame, const Mask& faps) {
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
std::size_t Receiver::source_of(const FapInfo& fap, const Mask& coded) const {
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
Mask Receiver::derive(Mask known, const Mask& targets) {
  if (options_.mirror) known = copy(known, targets, &FapInfo::mirror);
  if (options_.lips) known = copy(known, targets, &FapInfo::partner);
  if (options_.mirror && options_.lips) known = copy(known, targets, &FapInfo::mirror);
  return known;
}

Mask Receiver::copy(const Mask& known, const Mask& targets, int FapInfo::*other) {
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

Frame with_mask(Frame frame, const Mask& mask) {
  frame.mask = mask;
  if (!mask[1]) frame.viseme = {};
  if (!mask[2]) frame.expression = {};
  return frame;
}

}  // namespace animeme::fap
