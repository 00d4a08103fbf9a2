/// @file
/// Which tracks of a file with several languages or people are read: option of commands that read
/// faces.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --track.
void add_track_option(OptionTable& cli, std::string& track);

/// What --track asks for, as media::TrackScope takes it: with the three-letter code of the
/// language. Empty text: nothing. Errors: those of media::parse_track_labels().
Result<media::TrackLabels> read_track_labels(const std::string& text);

/// The same of an option that was checked.
media::TrackLabels wanted_track_of(const std::string& text);

}  // namespace animeme::tools
