/// @file
/// The model that comes with the library, so that a face can talk without any model file.
#pragma once

#include <cstdint>
#include <span>

#include "dam/model/model.h"
#include "fap/result.h"

namespace animeme::dam {

/// The bytes of dam/model/builtin/grid_s1.dam: mouth FAPs of one British speaker at 25 frames per
/// second. Trained on the GRID corpus (CC BY 4.0, see the model's attribution, which has to be
/// kept); dam/model/builtin/README.md has the command that made it.
std::span<const std::uint8_t> builtin_model_bytes();

/// The built-in model. Errors: those of read_model(), which would be a defect of the build.
Result<Model> builtin_model();

}  // namespace animeme::dam
