/// @file
/// The key shapes of a project: found automatically, chosen by time, or from an artist's folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/crossmap/blend.h"
#include "fap/result.h"
#include "tools/characters/crossmap/capture.h"
#include "tools/characters/crossmap/project.h"

namespace animeme::crossmap {

/// Origin of a key shape.
struct KeySource {
  std::string input;   ///< name of the recording
  double seconds = 0;  ///< time in the recording
  double share = 0;    ///< of the frames nearest to it, 0..1; 0: unknown
};

/// Key shapes with their origins.
struct Keys {
  dam::KeyShapes shapes;           ///< displacements of the points of the capture
  std::vector<KeySource> sources;  ///< one per shape
  std::size_t compared = 0;        ///< frames that were compared; 0: no search
};

/// Key shapes of a project: those of its folder, those named, or found automatically. A found shape
/// that hardly differs from the neutral one (RMS less than a twentieth of the largest) is dropped,
/// since zero coefficients represent it. Errors: those of find_key_frames() and of the file, with
/// its name; not_found (a missing recording or time; a point of the recordings that the file
/// lacks).
Result<Keys> load_keys(const Project& project, const Capture& capture, const tools::Log& log);

/// keys.csv of a folder: one row per shape; key, input, at_s, share and the displacement of each
/// point.
std::string write_keys(const Keys& keys, const Capture& capture);

}  // namespace animeme::crossmap
