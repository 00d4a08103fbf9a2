/// @file
/// Damaged streams: by default commands repair them, say so, and end with exit code 1 when the
/// output is written; with --strict they end at the first damage.
#pragma once

#include <span>
#include <string>

#include "codec/decode/repair.h"

namespace animeme::tools {

/// Set by main() from --strict.
void set_strict(bool strict);
/// Whether damage is an error.
bool is_strict();
/// Prints a warning for each damage, and remembers that there was one.
void report_damage(const std::string& path, std::span<const fba::Damage> damage);
/// Whether report_damage() was called with any.
bool damage_reported();

}  // namespace animeme::tools
