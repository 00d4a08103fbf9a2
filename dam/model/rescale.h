/// @file
/// Adapts a model to a face with the same controls but other ranges (dam/signal/gain_offset.h).
#pragma once

#include <span>

#include "dam/model/model.h"
#include "dam/signal/gain_offset.h"
#include "fap/result.h"

namespace animeme::dam {

/// Makes the output of the model gain * value + offset for every control: rest, mean, deviation,
/// limits and the position of the teeth (Model::lip_tooth_raise, a value of FAP 5) change with it,
/// and the curves of a control with negative gain are inverted. Limits implied by the name of a
/// control (natural_limits()) stay as they are; pairs are released if one of the two has an offset
/// or a negative gain. Widths and choices of modes stay: they belong to the speech, not to the
/// face. Error: invalid_argument (the number of gains differs from that of controls, a gain or
/// offset that is not finite).
Result<void> rescale(Model& model, std::span<const GainOffset> gains);

}  // namespace animeme::dam
