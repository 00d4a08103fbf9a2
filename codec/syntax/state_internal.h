// State that encoder and decoder carry between planes. Not installed API.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/syntax/arith.h"
#include "codec/syntax/plane.h"

namespace animeme::fba::internal {

/// More skipped frames than this (about 9 hours at 30/s) is damage, and bounds the work on one
/// header.
inline constexpr std::uint32_t kMaxSkip = 1U << 20;

/// A parameter family (low-level FAPs, BAPs) by slots, that is in coding order.
struct SlotTable {
  std::span<const std::uint8_t> group_sizes;
  std::span<const std::uint16_t> number;            // FAP or BAP number of each slot
  std::span<const std::uint16_t> step;              // quantiser step of each slot
  std::span<const std::uint16_t> default_range[2];  // I, P; empty: no defaults in use
};
const SlotTable& face_slots();
const SlotTable& body_slots();

/// The settings of one family from an intra plane to the next.
struct SlotCoding {
  explicit SlotCoding(const SlotTable& slot_table);

  const SlotTable* table;
  int scale = 1;                                   // fap_quant or body scale, 0 counts as 1
  bool quantised = true;                           // false: quantiser 0, every step is 1
  std::vector<std::uint16_t> coded;                // slots that are masked, ascending
  std::array<std::vector<std::int16_t>, 4> range;  // by RangeKind, level magnitude >= 0
  bool ranges_known = false;                       // a first intra plane has set the defaults
  bool valid = false;                              // an intra plane has been seen

  // What an intra plane begins with that codes the parameters of `mask`.
  template <class Mask>
  void begin(const SlotCoding& before, const Mask& mask, int quant, int new_scale) {
    *this = before;
    valid = true;
    scale = new_scale;
    quantised = quant != 0;
    const std::span<const std::uint16_t> numbers = table->number;
    coded.clear();
    for (std::size_t slot = 0; slot < numbers.size(); ++slot) {
      if (mask[numbers[slot]]) coded.push_back(std::uint16_t(slot));
    }
    set_default_ranges();
  }
  // At the first intra plane: the default ranges, scaled by that plane's quantiser.
  void set_default_ranges();
  // Bits of one set of ranges in the stream.
  std::size_t range_bits() const;
  std::uint32_t alphabet(bool intra, std::size_t slot) const {
    const std::size_t first = intra ? kIntraMax : kPredictiveMax;
    return std::uint32_t(range[first][slot] + range[first + 1][slot] + 1);
  }
  std::int32_t lowest_level(bool intra, std::size_t slot) const {
    return -range[intra ? kIntraMin : kPredictiveMin][slot];
  }
  std::int32_t highest_level(bool intra, std::size_t slot) const {
    return range[intra ? kIntraMax : kPredictiveMax][slot];
  }
  std::int32_t step_of(std::size_t slot) const { return quantised ? table->step[slot] * scale : 1; }
};

/// The coding parameters and the memory of one family.
struct SlotState {
  explicit SlotState(const SlotTable& slot_table)
      : coding(slot_table), value(slot_table.number.size()), model(slot_table.number.size()) {}

  SlotCoding coding;
  std::vector<std::int32_t> value;   // last reconstruction of each slot
  std::vector<AdaptiveModel> model;  // P models

  // After an intra plane: every coded slot starts with a flat P model.
  void reset_models() {
    for (const std::uint16_t slot : coding.coded) model[slot].reset(coding.alphabet(false, slot));
  }
};

/// Level range of the 5-bit number m.
inline std::int16_t level_range(int m, int scale) { return std::int16_t(m * 60 / scale); }

// The seven high-level values in coding order.
enum HighLevel : std::uint8_t {
  kVisemeSelect1,
  kVisemeSelect2,
  kVisemeBlend,
  kExpressionSelect1,
  kExpressionIntensity1,
  kExpressionSelect2,
  kExpressionIntensity2,
  kHighLevelCount
};

/// Largest level of a high-level value; symbols are 0..max in I planes, -max..max in P planes.
inline std::int32_t high_level_max(int which, int fap_quant) {
  switch (which) {
    case kVisemeSelect1:
    case kVisemeSelect2:
      return 14;
    case kExpressionSelect1:
    case kExpressionSelect2:
      return 6;
    default:
      return blend_range(fap_quant);
  }
}

/// Quantiser step of a high-level value; selections are not quantised.
inline std::int32_t high_level_step(int which, int fap_quant) {
  const bool select = which == kVisemeSelect1 || which == kVisemeSelect2 ||
                      which == kExpressionSelect1 || which == kExpressionSelect2;
  return select ? 1 : fap_scale(fap_quant);
}

/// Memory of FAP 1 and 2.
struct HighLevelState {
  std::array<std::int32_t, kHighLevelCount> value{};
  std::array<AdaptiveModel, kHighLevelCount> model;
  int fap_quant = 1;
  // Largest levels and quantiser steps at that, since reset_models().
  std::array<std::int32_t, kHighLevelCount> max{};
  std::array<std::int32_t, kHighLevelCount> step{};

  std::int32_t max_level(int which) const { return max[std::size_t(which)]; }
  std::int32_t step_of(int which) const { return step[std::size_t(which)]; }
  void reset_models();
};

/// The values of a frame in coding order, and back.
std::array<std::int32_t, kHighLevelCount> high_level_values(const fap::Frame& frame);
void set_high_level_values(std::span<const std::int32_t, kHighLevelCount> values,
                           fap::Frame& frame);

}  // namespace animeme::fba::internal
