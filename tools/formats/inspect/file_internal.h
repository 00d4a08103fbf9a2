/// @file
/// What models and scripts hold, as JSON; and any JSON as text for people.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dam/script/timings.h"
#include "fap/result.h"
#include "tools/formats/common/json.h"

namespace animeme::inspect {

/// A model file: method, phones, controls. Errors: those of dam::read_model().
Result<tools::Json> describe_model(std::span<const std::uint8_t> bytes);

/// A script of phones, or of words. Errors: those of dam::make_script().
Result<tools::Json> describe_script(const dam::Timings& timings);

/// An object as indented "name: value" lines; lists of objects as one line each. What is empty is
/// left out.
std::string tree_text(const tools::Json& object);

}  // namespace animeme::inspect
