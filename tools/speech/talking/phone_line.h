/// @file
/// Phones as a speech engine tells them while it speaks: a line each.
#pragma once

#include <optional>
#include <string_view>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::speech {

/// "start_s end_s phone", in seconds, by blanks or tabs; more fields are ignored. Nothing for an
/// empty line, a comment (#) and a header ("start ..."). Errors: syntax (fewer fields, a time that
/// is no finite number), not_found (a phone that is not known; the message has the nearest).
Result<std::optional<dam::Phone>> parse_phone_line(std::string_view line);

}  // namespace animeme::speech
