/// @file
/// Data of a corpus excluded from training or scoring, as text and JSON.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/corpus/glitches.h"

namespace animeme::inspect {

/// Sentences about the blanks of a corpus: at most ten corpus sentences by name, controls with the
/// same blanks together; empty if there are none.
std::vector<std::string> blanks_text(const dam::LeftOut& left_out);

/// The first eight glitches as sentences, and the number of further ones.
std::vector<std::string> glitches_text(std::span<const dam::Glitch> glitches);

/// All blanks as a JSON list: id, control, rows, of, first_line.
std::string blanks_json(const dam::LeftOut& left_out);

/// All glitches as a JSON list: id, control, kind, time_s, frames, bridged.
std::string glitches_json(std::span<const dam::Glitch> glitches);

}  // namespace animeme::inspect
