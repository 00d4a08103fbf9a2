/// @file
/// Viseme tracks as other programs read them.
#pragma once

#include <string>
#include <string_view>

#include "tools/commands/viseme_track.h"

namespace animeme::tools {

/// {"format": "animeme-visemes", "version": 1, "fps": 25, "rate": [25, 1], "audio": null,
///  "names": ["viseme_sil", ... 15], "events": [{"time": 0.21, "duration": 0.04, "phone": "B",
///  "viseme": "viseme_PP"}, ...], "frames": [[15 numbers], ...]}. Without "phone" where it is not
/// known. The names are those of morph targets of Ready Player Me and Oculus avatars.
std::string visemes_json(const VisemeTrack& track, std::string_view audio);

/// time_s and one column a viseme, a row a frame.
std::string visemes_csv(const VisemeTrack& track);

/// Mouth shapes of Rhubarb Lip Sync: A to H and X. By viseme: X sil, A PP, B TH DD kk CH SS nn ih,
/// C E, D aa, E oh RR, F ou, G FF; H for the sound L, if sounds are known.
char rhubarb_shape(const VisemeEvent& event);

/// {"metadata": {"soundFile": "", "duration": 2.5}, "mouthCues": [{"start": 0.00, "end": 0.05,
/// "value": "X"}, ...]}, as Rhubarb writes it. Equal neighbours are one cue.
std::string rhubarb_json(const VisemeTrack& track, std::string_view audio);

/// Start and shape, tab between; the end is a last X.
std::string rhubarb_tsv(const VisemeTrack& track);

}  // namespace animeme::tools
