// How likely a mode is between its neighbours: the likelihood behind E_c of Eq. 10, with back-off
// from the phones beside it over their classes to how common the mode is at all.
// Source: dam/lipsync.md, section 5.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dam/model/model.h"

namespace animeme::dam {

/// Trust in the coarser level, in examples.
inline constexpr double kBackOff = 4;

/// -log P(mode | left, right) for every mode of `phone` (values >= 0, finite).
/// `class_of` holds Model::phones[i].context_class; left and right are indices or kRestContext.
/// `leave_out` >= 0 takes one example of that mode in this very context away first, so that an
/// occurrence of the training set does not vote for itself.
std::vector<double> mode_costs(const AnimemePhone& phone, std::span<const std::uint32_t> class_of,
                               std::int32_t left, std::int32_t right, std::int32_t leave_out = -1);

/// context_class of all phones of a model, for mode_costs().
std::vector<std::uint32_t> context_classes(const Model& model);

}  // namespace animeme::dam
