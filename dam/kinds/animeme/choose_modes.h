// Which mode every phone of a script takes: the costs of Eq. 10 on the animeme graph.
#pragma once

#include <cstddef>
#include <vector>

#include "dam/model/kind_internal.h"

namespace animeme::dam {

/// Modes of the occurrences, in order. The model must have AnimemeParameters.
///   E   = context_weight * E_c + smoothness_weight * E_s (SynthesisOptions)
///   E_c = -log P(mode | neighbours), see contexts.h
///   E_s = sum over controls of the squared jumps of value, first and second derivative (per frame
///         of the training rate, in standard deviations) where two polynomials meet; 0 across a
///         rest
std::vector<std::size_t> choose_modes(const Speech& speech);

}  // namespace animeme::dam
