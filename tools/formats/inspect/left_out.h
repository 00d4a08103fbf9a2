/// @file
/// What of a corpus is not learned from or scored, as text and JSON.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/glitches.h"

namespace animeme::inspect {

/// Sentences for people about the blanks of a corpus: at most ten of its sentences by name,
/// controls with the same blanks together; nothing if there are none.
std::vector<std::string> blanks_text(const dam::LeftOut& left_out);

/// The first eight glitches as sentences for people, and how many more there are.
std::vector<std::string> glitches_text(std::span<const dam::Glitch> glitches);

/// All of it, as a list in JSON text: id, control, rows, of, first_line.
std::string blanks_json(const dam::LeftOut& left_out);

/// The same of glitches: id, control, kind, time_s, frames, bridged.
std::string glitches_json(std::span<const dam::Glitch> glitches);

}  // namespace animeme::inspect
