/// @file
/// The poses of a model for single sounds, which retargeting compares with those of another face
/// (dam/signal/gain_offset.h).
#pragma once

#include <span>
#include <string>

#include "dam/model/model.h"
#include "dam/signal/gain_offset.h"
#include "fap/result.h"

namespace animeme::dam {

/// A row of all controls for each label: "rest" (and its synonyms, see is_rest_pose()) is
/// Control::rest; a phone (dam/script/phones.h, in any case) is the pose in its middle when spoken
/// alone, for 0.3 s between pauses, with closed lips for P, B and M. Errors: invalid_argument (a
/// label that is not a phone), not_found (a phone that the model neither knows nor has a relative
/// of).
Result<Poses> poses_of(const Model& model, std::span<const std::string> labels);

}  // namespace animeme::dam
