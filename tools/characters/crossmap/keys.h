/// @file
/// The key shapes of a project: found, chosen by time, or from a folder that an artist works in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/crossmap/blend.h"
#include "fap/result.h"
#include "tools/characters/crossmap/capture.h"
#include "tools/characters/crossmap/project.h"

namespace animeme::crossmap {

/// Where a key shape is from.
struct KeySource {
  std::string input;   ///< name of the recording
  double seconds = 0;  ///< in it
  double share = 0;    ///< of the frames that look most like it, 0..1; 0: not known
};

/// Key shapes with what is known of them.
struct Keys {
  dam::KeyShapes shapes;           ///< displacements of the points of the capture
  std::vector<KeySource> sources;  ///< one a shape
  std::size_t compared = 0;        ///< frames that were compared; 0: they were not looked for
};

/// Key shapes as the project says: those of its folder, those named, else found. A shape that was
/// found and hardly differs from the neutral one (less than a twentieth of the largest, root mean
/// square) is left out: no coefficient makes it already. Errors: those of find_key_frames() and of
/// the file, with its name; not_found (a recording or a time that is not there; a point of the
/// recordings that the file lacks).
Result<Keys> load_keys(const Project& project, const Capture& capture, const tools::Log& log);

/// keys.csv of a folder: a row a shape; key, input, at_s, share and the displacement of each point.
std::string write_keys(const Keys& keys, const Capture& capture);

}  // namespace animeme::crossmap
