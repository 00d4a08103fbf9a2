/// @file
/// Phones from a live speech engine, one per line.
#pragma once

#include <optional>
#include <string_view>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::speech {

/// "start_s end_s phone", in seconds, separated by blanks or tabs; further fields are ignored.
/// nullopt for an empty line, a comment (#) and a header ("start ..."). Errors: syntax (too few
/// fields, an invalid time), not_found (an unknown phone; the message suggests similar ones).
Result<std::optional<dam::Phone>> parse_phone_line(std::string_view line);

}  // namespace animeme::speech
