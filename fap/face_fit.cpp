#include "fap/detail/face_fit.h"

#include <algorithm>
#include <cmath>

#include "fap/arkit.h"
#include "fap/detail/arkit_sparsity.h"
#include "fap/shape_fit.h"

namespace animeme::fap::internal {
namespace {

using Shapes = std::vector<std::vector<ShapeWeight>>;

constexpr int kTurns = 2000;         // units of angle (1e-5 rad): less is no gaze
constexpr double kMostlyLids = 0.6;  // of what a shape of lids and brows does, lids and brows
constexpr int kCloses = 500;         // units of a lid: a blink
constexpr int kOpens = 100;          // likewise, upwards: a wide eye
constexpr int kUpperLids[] = {19, 20};
constexpr double kLidsNearlyMeet = 985, kLidsMeet = 1023;  // FAP 19 and 21 together, rounded
// The lower lid goes so far in blinks, squints and smiles; the upper one closes what is left.
constexpr double kLowerLid = 330;
// Captured blinks of eyes that look down are 0.85 to 1 where lids meet.
constexpr double kBlinkLookingDown = 0.15, kLooksDown = 0.2;
constexpr double kBothLids = 0.04;  // opposite lids that are seen by nobody

bool is_gaze(int fap) { return fap >= 23 && fap <= 26; }

Mask mask_of(bool (*wanted)(int fap)) {
  Mask mask;
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) mask[std::size_t(fap)] = wanted(fap);
  return mask;
}

int value_of(const std::vector<ShapeWeight>& shape, int fap) {
  for (const ShapeWeight& weight : shape) {
    if (weight.fap == fap) return weight.value;
  }
  return 0;
}

bool turns_eyes(const std::vector<ShapeWeight>& shape) {
  return std::any_of(shape.begin(), shape.end(), [](const ShapeWeight& weight) {
    return is_gaze(weight.fap) && std::abs(weight.value) >= kTurns;
  });
}

bool moves_lids(const std::vector<ShapeWeight>& shape) {
  double lids = 0, all = 0;
  for (const ShapeWeight& weight : shape) {
    const double size = std::abs(double(weight.value));
    all += size;
    lids += is_lid_or_brow(weight.fap) ? size : 0;
  }
  return all > 0 && lids >= kMostlyLids * all;
}

// Whether nothing moves but lids: then nothing but lids is to be seen.
bool only_lids(const FapValues& target) {
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    const bool lid = fap >= 19 && fap <= 22, turned = is_gaze(fap) || (fap >= 48 && fap <= 50);
    if (!lid && !turned && target[std::size_t(fap)] != 0) return false;
  }
  return true;
}

template <class Wanted>
std::vector<std::size_t> indices(std::size_t count, Wanted wanted) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (wanted(i)) out.push_back(i);
  }
  return out;
}

Shapes some_of(const Shapes& shapes, const std::vector<std::size_t>& group) {
  Shapes out;
  for (const std::size_t i : group) out.push_back(shapes[i]);
  return out;
}

std::optional<int> channel_at(std::span<const std::optional<int>> channels, std::size_t i) {
  return i < channels.size() ? channels[i] : std::nullopt;
}

// One closes an eye, the other opens it.
bool are_opposite_lids(const std::vector<ShapeWeight>& a, const std::vector<ShapeWeight>& b) {
  return std::any_of(std::begin(kUpperLids), std::end(kUpperLids), [&](int fap) {
    const int one = value_of(a, fap), other = value_of(b, fap);
    return std::max(one, other) >= kCloses && std::min(one, other) <= -kOpens;
  });
}

// ARKit's that undo each other, beside lids.
bool are_opposite(std::optional<int> a, std::optional<int> b) {
  constexpr std::pair<std::string_view, std::string_view> kPairs[] = {
      {"jawLeft", "jawRight"},
      {"mouthLeft", "mouthRight"},
      {"mouthSmileLeft", "mouthFrownLeft"},
      {"mouthSmileRight", "mouthFrownRight"}};
  if (!a || !b || *a < 0 || *b < 0) return false;
  const std::string_view one = kArkitNames[std::size_t(*a)], other = kArkitNames[std::size_t(*b)];
  return std::any_of(std::begin(kPairs), std::end(kPairs), [&](const auto& pair) {
    return (pair.first == one && pair.second == other) ||
           (pair.first == other && pair.second == one);
  });
}

ExactFit exact_of(const Shapes& shapes, const std::vector<std::size_t>& group,
                  std::span<const std::optional<int>> channels) {
  const Shapes some = some_of(shapes, group);
  std::vector<Opponents> pairs, never;
  for (std::size_t a = 0; a < group.size(); ++a) {
    for (std::size_t b = a + 1; b < group.size(); ++b) {
      if (are_opposite_lids(some[a], some[b])) never.push_back({a, b});
      if (are_opposite(channel_at(channels, group[a]), channel_at(channels, group[b]))) {
        pairs.push_back({a, b});
      }
    }
  }
  return ExactFit(some, pairs, never);
}

Lips lips_of_group(Lips lips, const std::vector<std::size_t>& group) {
  if (lips.closing.empty()) return lips;
  std::vector<LipValues> closing;
  for (const std::size_t i : group) closing.push_back(lips.closing[i]);
  lips.closing = std::move(closing);
  return lips;
}

}  // namespace

FaceFit::FaceFit(Shapes shapes, std::span<const std::optional<int>> channels,
                 const FaceFitOptions& options, Lips lips)
    : shapes_(std::move(shapes)),
      gaze_(indices(shapes_.size(), [&](std::size_t i) { return turns_eyes(shapes_[i]); })),
      lids_(indices(shapes_.size(),
                    [&](std::size_t i) {
                      return options.sparsity > 0 && !turns_eyes(shapes_[i]) &&
                             moves_lids(shapes_[i]) && channel_at(channels, i) != kWholeFace;
                    })),
      others_(indices(shapes_.size(),
                      [&](std::size_t i) {
                        return !turns_eyes(shapes_[i]) &&
                               std::find(lids_.begin(), lids_.end(), i) == lids_.end();
                      })),
      made_(indices(shapes_.size(),
                    [&](std::size_t i) {
                      return !turns_eyes(shapes_[i]) && channel_at(channels, i) != kWholeFace;
                    })),
      few_of_(
          std::find(channels.begin(), channels.end(), kWholeFace) == channels.end()
              ? others_
              : indices(shapes_.size(), [&](std::size_t i) { return !turns_eyes(shapes_[i]); })),
      eyes_(exact_of(shapes_, gaze_, channels)),
      upper_(exact_of(shapes_, lids_, channels)),
      whole_(exact_of(shapes_, made_, channels)),
      few_(some_of(shapes_, few_of_), options.ridge, options.steadiness,
           std::numeric_limits<double>::infinity(), 0, lips_of_group(std::move(lips), few_of_)),
      sparse_(options.sparsity > 0),
      weights_(shapes_.size(), 0.0) {
  std::vector<std::optional<int>> some;
  for (const std::size_t i : few_of_) some.push_back(channel_at(channels, i));
  if (!channels.empty()) {
    Sparsity sparsity = sparsity_of(some, options.sparsity);
    for (const auto& [a, b] : sparsity.opponents) opponents_.push_back({few_of_[a], few_of_[b]});
    few_.set_sparsity(std::move(sparsity));
  }
  for (const std::size_t i : made_) {
    for (const ShapeWeight& weight : shapes_[i]) moved_.set(std::size_t(weight.fap));
  }
  for (const std::size_t a : made_) {
    for (const std::size_t b : made_) {
      for (const int fap : kUpperLids) {
        const double closes = value_of(shapes_[a], fap), opens = -value_of(shapes_[b], fap);
        if (closes >= kCloses && opens >= kOpens) opposite_lids_.push_back({a, b, opens / closes});
      }
    }
  }
  for (const std::size_t i : lids_) {
    for (int side = 0; side < 2; ++side) {
      if (value_of(shapes_[i], 19 + side) >= kCloses) blinks_[std::size_t(side)].push_back(i);
    }
  }
}

void FaceFit::take_off(std::size_t shape, double weight, FapValues& target) const {
  if (weight == 0) return;
  for (const ShapeWeight& one : shapes_[shape]) target[std::size_t(one.fap)] -= weight * one.value;
}

void FaceFit::turn_eyes(const Mask& mask, FapValues& target, std::array<double, 2>& looks_down) {
  if (gaze_.empty()) return;
  static const Mask kGaze = mask_of(is_gaze);
  const std::vector<double>& weights = eyes_.fit(mask & kGaze, target);
  for (std::size_t k = 0; k < gaze_.size(); ++k) {
    const std::size_t i = gaze_[k];
    weights_[i] = weights[k];
    take_off(i, weights[k], target);
    for (int side = 0; side < 2; ++side) {
      if (value_of(shapes_[i], 25 + side) > kTurns) looks_down[std::size_t(side)] += weights[k];
    }
  }
}

// Lids and brows by their FAPs, the rest by what is left of the others.
void FaceFit::fit_few(const Mask& mask, const FapValues& target) {
  static const Mask kLids = mask_of(is_lid_or_brow);
  const bool apart = !lids_.empty() && few_of_.size() == others_.size();
  const std::vector<double>& few = few_.fit(apart ? mask & ~kLids : mask, target);
  for (std::size_t k = 0; k < few_of_.size(); ++k) weights_[few_of_[k]] = few[k];
  FapValues left = target;
  for (const std::size_t i : others_) take_off(i, weights_[i], left);
  const std::vector<double>& upper = upper_.fit(mask & kLids, left);
  for (std::size_t k = 0; k < lids_.size(); ++k) weights_[lids_[k]] = upper[k];
}

// What is left of both, where a face is nearly made of the shapes, goes as it is less so.
void FaceFit::part_opponents(double certainty) {
  constexpr double kUnseen = 0.05, kNearlyMade = 0.8;
  const double share = std::clamp((certainty - kNearlyMade) / (1 - kNearlyMade), 0.0, 1.0);
  for (const auto& [a, b] : opponents_) {
    double& less = weights_[a] < weights_[b] ? weights_[a] : weights_[b];
    if (less > kUnseen) less = kUnseen + share * (less - kUnseen);
  }
}

// What is left of shapes that open and of those that close an eye goes, as the lid stays.
void FaceFit::part_lids() {
  for (const OppositeLids& pair : opposite_lids_) {
    const double least = std::min(weights_[pair.closes], weights_[pair.opens]);
    if (!sparse_ || least <= kBothLids) continue;
    const double opens = std::min(weights_[pair.opens] - kBothLids,
                                  (weights_[pair.closes] - kBothLids) / pair.ratio);
    weights_[pair.opens] -= opens;
    weights_[pair.closes] -= opens * pair.ratio;
  }
}

void FaceFit::close_lids(const Mask& mask, const FapValues& target,
                         const std::array<double, 2>& looks_down) {
  // 1 where they meet, from 0 where they nearly do, so that the blink does not jump.
  const auto meet = [&](std::size_t side) {
    if (!mask[19 + side] || !mask[21 + side]) return 0.0;
    const double closed = target[19 + side] + target[21 + side];
    return std::clamp((closed - kLidsNearlyMeet) / (kLidsMeet - kLidsNearlyMeet), 0.0, 1.0);
  };
  for (std::size_t side = 0; side < 2; ++side) {
    const double down = std::clamp(looks_down[side] / kLooksDown, 0.0, 1.0);
    for (const std::size_t i : blinks_[side]) {
      const bool both = std::find(blinks_[1 - side].begin(), blinks_[1 - side].end(), i) !=
                        blinks_[1 - side].end();
      const double closed = both ? std::min(meet(side), meet(1 - side)) : meet(side);
      const double whole = std::max(weights_[i], 1 - kBlinkLookingDown * down);
      weights_[i] += closed * (whole - weights_[i]);
    }
  }
}

const std::vector<double>& FaceFit::fit(const Frame& frame, FapValues target,
                                        std::array<double, 2> looks_down) {
  const FapValues given = target_of(frame);
  std::fill(weights_.begin(), weights_.end(), 0.0);
  turn_eyes(frame.mask, target, looks_down);
  const Mask measured = sparse_ ? without_unmeasured(frame) : frame.mask;
  double certainty = 0;
  if (sparse_ && !only_lids(target)) {
    // Turns of the head, and a gaze beyond that of the shapes, say nothing of who made the rest.
    made_weights_ = whole_.fit(frame.mask & moved_, target);
    certainty = whole_.certainty();
    if (certainty < 1 && measured != frame.mask) {
      const std::vector<double>& again = whole_.fit(measured & moved_, target);
      if (whole_.certainty() > certainty) {
        made_weights_ = again;
        certainty = whole_.certainty();
      }
    }
  }
  if (certainty < 1) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double over = target[21 + side] - kLowerLid;
      if (!(over > 0) || !frame.mask[19 + side]) continue;
      target[19 + side] += over;
      target[21 + side] -= over;
    }
    fit_few(measured, target);
  } else {
    few_.restart();
  }
  for (std::size_t k = 0; k < made_.size() && certainty > 0; ++k) {
    double& weight = weights_[made_[k]];
    weight += certainty * (made_weights_[k] - weight);
  }
  if (certainty < 1) part_opponents(certainty);
  close_lids(frame.mask, given, looks_down);
  part_lids();
  return weights_;
}

}  // namespace animeme::fap::internal
