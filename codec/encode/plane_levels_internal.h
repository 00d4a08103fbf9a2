// The first half of coding a plane: checked settings, and the level of every value. Nothing is
// written here and no state changes. Not installed API.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/encode/encoder.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

/// Levels of one family's coded slots as symbols, and what they reconstruct to.
struct SlotLevels {
  std::vector<std::uint16_t> symbol;  // the level less the lowest one
  std::vector<std::int32_t> rec;
};

using HighLevels = std::array<std::int32_t, kHighLevelCount>;

/// What is wrong with a plane as far as that can be said without the state: invalid_argument as of
/// Encoder::write().
std::optional<Error> objection(const PlaneInput& plane);

/// What the settings of an intra plane make of the coding parameters `before` it.
void apply_settings(const SlotCoding& before, const FaceSettings& settings, SlotCoding& coding);
void apply_settings(const SlotCoding& before, const BodySettings& settings, SlotCoding& coding);

/// Levels of the coded slots; `values` by FAP or BAP number, `what` names the family. False:
/// `error` is out_of_range as of Encoder::write().
bool quantise_slots(const SlotState& state, const SlotCoding& coding, bool intra,
                    std::span<const std::int32_t> values, const char* what, SlotLevels& out,
                    std::optional<Error>& error);

/// The same of the high-level values `first` to `last`, at the fap_quant in force.
bool quantise_high(const HighLevelState& state, int fap_quant, bool intra, int first, int last,
                   const HighLevels& values, HighLevels& levels, std::optional<Error>& error);

}  // namespace animeme::fba::internal
