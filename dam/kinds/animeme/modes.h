// Finding the modes of every phone (section V-A of the paper). Internal to training.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/kinds/animeme/fit.h"
#include "dam/model/model.h"

namespace animeme::dam {

/// Which modes belong to which phone: modes are numbered phone after phone.
struct ModeTable {
  std::vector<std::size_t> first;  ///< per phone, one more at the end
  std::size_t count() const { return first.back(); }
  std::size_t of(std::int32_t phone) const {
    return first[std::size_t(phone) + 1] - first[std::size_t(phone)];
  }
};

/// A mode that fewer occurrences support is no mode.
inline constexpr std::size_t kSmallestMode = 5;

/// Clusters the occurrences of every phone and sets FitOccurrence::mode. The vector of an
/// occurrence is its signal, spline through all frames, at resample_points over the phone.
ModeTable find_modes(FitData& data, std::size_t phones, const AnimemeOptions& options, int threads);

/// Counts modes by context into AnimemePhone::contexts. AnimemePhone::modes is resized.
void count_contexts(const FitData& data, const ModeTable& table, std::vector<AnimemePhone>& phones);

/// Moves occurrences one by one to the mode with the smallest squared error of the whole signal
/// around them plus `context_weight` * -log P(mode | context), the rest being as it is.
/// No mode becomes smaller than kSmallestMode. Returns the number of moves. Updates the counts.
std::size_t reassign_modes(FitData& data, const ModeTable& table, const FitState& state,
                           double context_weight, std::span<const std::uint32_t> classes,
                           std::vector<AnimemePhone>& phones);

}  // namespace animeme::dam
