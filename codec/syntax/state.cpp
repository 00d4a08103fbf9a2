
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

struct FaceSlotArrays {
  std::array<std::uint8_t, fap::kGroupCount - 1> group_sizes{};
  std::array<std::uint16_t, fap::kLowLevelCount> number{};
  std::array<std::uint16_t, fap::kLowLevelCount> step{};
  std::array<std::uint16_t, fap::kLowLevelCount> default_range[2]{};

  FaceSlotArrays() {
    for (std::size_t group = 1; group < fap::kGroupCount; ++group) {
      group_sizes[group - 1] = std::uint8_t(fap::kGroups[group].size);
    }
    for (int number_ = fap::kFirstLowLevel; number_ <= fap::kFapCount; ++number_) {
      const std::size_t slot = std::size_t(number_ - fap::kFirstLowLevel);
      number[slot] = std::uint16_t(number_);
      step[slot] = std::uint16_t(fap::info(number_).quant_step);
      default_range[0][slot] = std::uint16_t(fap::info(number_).default_i_range);
      default_range[1][slot] = std::uint16_t(fap::info(number_).default_p_range);
    }
  }
};

}  // namespace

const SlotTable& face_slots() {
  static const FaceSlotArrays arrays;
  static const SlotTable table{arrays.group_sizes,
                               arrays.number,
                               arrays.step,
                               {arrays.default_range[0], arrays.default_range[1]}};
  return table;
}

const SlotTable& body_slots() {
  // No default ranges: the known codec always sends those of the body (codec/bitstream.md, section
  // 7.1).
  static const SlotTable table{kBodyGroupSizes, kBapOrder, kBapSteps, {}};
  return table;
}

SlotCoding::SlotCoding(const SlotTable& slot_table) : table(&slot_table) {
  for (auto& set : range) set.assign(table->number.size(), 0);
}

void SlotCoding::set_default_ranges() {
  if (ranges_known) return;
  ranges_known = true;
  for (std::size_t kind = 0; kind < 4; ++kind) {
    const auto& defaults = table->default_range[kind / 2];
    for (std::size_t slot = 0; slot < defaults.size(); ++slot) {
      range[kind][slot] = level_range((defaults[slot] + 59) / 60, scale);
    }
  }
}

std::size_t SlotCoding::range_bits() const {
  std::size_t bits = coded.size() * 5;
  for (const std::uint8_t size : table->group_sizes) bits += (size + 3U) / 4U;
  return bits;
}

void HighLevelState::reset_models() {
  for (int which = 0; which < kHighLevelCount; ++which) {
    max[std::size_t(which)] = high_level_max(which, fap_quant);
    step[std::size_t(which)] = high_level_step(which, fap_quant);
    model[std::size_t(which)].reset(std::uint32_t(2 * max_level(which) + 1));
  }
}

std::array<std::int32_t, kHighLevelCount> high_level_values(const fap::Frame& frame) {
  return {frame.viseme.select1,       frame.viseme.select2,        frame.viseme.blend,
          frame.expression.select1,   frame.expression.intensity1, frame.expression.select2,
          frame.expression.intensity2};
}

void set_high_level_values(std::span<const std::int32_t, kHighLevelCount> values,
                           fap::Frame& frame) {
  if (frame.mask[1]) {
    frame.viseme.select1 = values[kVisemeSelect1];
    frame.viseme.select2 = values[kVisemeSelect2];
    frame.viseme.blend = values[kVisemeBlend];
  }
  if (frame.mask[2]) {
    frame.expression.select1 = values[kExpressionSelect1];
    frame.expression.intensity1 = values[kExpressionIntensity1];
    frame.expression.select2 = values[kExpressionSelect2];
    frame.expression.intensity2 = values[kExpressionIntensity2];
  }
}

}  // namespace animeme::fba::internal
