/// @file
/// Turns a row of a manifest into command lines of the program.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/app/batch/manifest.h"

namespace animeme::batch {

/// Command lines and their outputs.
struct Plan {
  std::vector<std::vector<std::string>> lines;  ///< each begins with the name of a command
  std::vector<std::string> outputs;             ///< files, relative to the folder of outputs
  std::vector<std::string> inputs;              ///< input files, whose content is hashed
};

/// The plan of a row whose outputs go to the folder `stage`.
///
/// `outputs` are extensions separated by blanks, preceded by a command if it is not the default
/// one: ".fba render:.video.mp4". speak makes .mp4 .mkv .ts .m3u8 .mpd .fba .fap .csv .json of
/// speech, "report:.report.json" is what its --json prints, align makes the timed phones (.TextGrid
/// .tsv .pho .vtt; together with a face speak does), render .png .jpg .webp .webm, export .glb
/// .gltf .vrm, view .html, plot .svg; encode and decode work on `input`. Commands that show a face
/// use the first face made by the row, or `input`; if there is none, a .mp4 is made for them.
/// Errors, invalid_argument (an unknown output, no source for it, an output named in the options).
Result<Plan> plan_row(const Row& row, const std::string& stage);

}  // namespace animeme::batch
