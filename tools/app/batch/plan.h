/// @file
/// What a row of a manifest wants done: command lines of the program.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/app/batch/manifest.h"

namespace animeme::batch {

/// Command lines, and what they make.
struct Plan {
  std::vector<std::vector<std::string>> lines;  ///< each begins with the name of a command
  std::vector<std::string> outputs;             ///< files, relative to the folder of outputs
  std::vector<std::string> inputs;              ///< files that are read, for their content
};

/// The plan of a row whose outputs go to the folder `stage`.
///
/// `outputs` are endings with blanks between, behind the command that makes them where it is not
/// the usual one: ".fba render:.video.mp4". speak makes .mp4 .mkv .ts .m3u8 .mpd .fba .fap .csv
/// .json of speech, align the timed phones (.TextGrid .tsv .pho .vtt; beside a face speak does),
/// render .png .jpg .webp .webm, export .glb .gltf .vrm, view .html, plot .svg; encode and decode
/// work on `input`. Those that show a face take the first face that the row has made or `input`;
/// where there is none, a .mp4 is made for them.
/// Errors, invalid_argument: an output that nobody makes, nothing to make it of, an output named in
/// the options.
Result<Plan> plan_row(const Row& row, const std::string& stage);

}  // namespace animeme::batch
