/// @file
/// A neutral face as a file, used as the reference for all recordings of a person.
///
///     write_file("me.face", animeme::exchange::write_face_file(take->face.rest));
///     options.face.rest = *animeme::exchange::read_face_file(text);
///
/// JSON: {"format": "animeme-face", "version": 1, "depth": true, "fapu": {"IRISD": 1.1, "ES": 6.2,
/// "ENS": 4.7, "MNS": 2.1, "MW": 5}, "points": {"2.1": [0, -7.6, 10.2], ...}, "turn": [pitch, yaw,
/// roll], "gaze": [[yaw, pitch], null]}. Points are feature points by their id, axes are those of
/// fap::Point, angles rad; `turn` and `gaze` are optional.
#pragma once

#include <string>
#include <string_view>

#include "fap/landmarks.h"
#include "fap/result.h"

namespace animeme::exchange {

/// Whether a text looks like such a file, Animeme's or that of a corpus (below).
bool is_face_file(std::string_view text);

/// Reads a face file, or the neutral.json of a corpus of MediaPipe points: "fapu_px" with the five
/// units and "neutral_px" with points by their number, x to the right, y down.
///
/// Errors: syntax (not JSON; fields of a wrong type), not_found (a unit or the points are missing),
/// invalid_argument (a unit that is not positive, points that are unknown or not finite),
/// unsupported (another format or version).
Result<fap::RestingFace> read_face_file(std::string_view text);

/// Writes numbers with nine digits; the same face gives the same text.
std::string write_face_file(const fap::RestingFace& face);

}  // namespace animeme::exchange
