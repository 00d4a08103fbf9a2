/// @file
/// A model for another face with the same controls, whose ranges differ (dam/signal/gain_offset.h).
#pragma once

#include <span>

#include "dam/model/model.h"
#include "dam/signal/gain_offset.h"
#include "fap/result.h"

namespace animeme::dam {

/// Makes the model speak gain * value + offset for every control: rest, mean, deviation, limits
/// and the place of the teeth (Model::lip_tooth_raise, a value of FAP 5) change with it, and the
/// curves of a control that goes the other way are turned round. Limits that the name of a control
/// tells (natural_limits()) stay as they are; pairs are freed if one of the two has an offset or
/// goes the other way. Widths and choices of modes stay: they are of the speech, not of the face.
/// Error: invalid_argument (another number of gains than controls, a gain or offset that is not
/// finite).
Result<void> rescale(Model& model, std::span<const GainOffset> gains);

}  // namespace animeme::dam
