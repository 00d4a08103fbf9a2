/// @file
/// What models and scripts hold, as JSON; and any JSON as text for people.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "dam/script/timings.h"
#include "fap/result.h"

namespace animeme::inspect {

/// A model file: method, phones, controls. Errors: those of dam::read_model().
Result<nlohmann::ordered_json> describe_model(std::span<const std::uint8_t> bytes);

/// A script of phones, or of words. Errors: those of dam::make_script().
Result<nlohmann::ordered_json> describe_script(const dam::Timings& timings);

/// An object as indented "name: value" lines; lists of objects as one line each. What is empty is
/// left out.
std::string tree_text(const nlohmann::ordered_json& object);

}  // namespace animeme::inspect
