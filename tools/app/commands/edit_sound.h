/// @file
/// Sound and words of what edit cuts and joins.
#pragma once

#include <optional>
#include <vector>

#include "fap/result.h"
#include "tools/app/commands/edit_source.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/text_track.h"

namespace animeme::tools {

/// The sound of all cuts, one behind the other, each as long as its frames to the sample; silence
/// where a source has none. In two channels if a source has two. nullopt: no source has sound. The
/// packets of a source that is wanted as a whole are copied if `copies`, which says afterwards
/// whether they were. `speed`: how much faster it becomes, at the same pitch. Errors: those of
/// media::AudioReader and media::AudioEncoder.
Result<std::optional<media::EncodedAudio>> cut_sound(const std::vector<EditCut>& cuts,
                                                     const media::AudioSettings& settings,
                                                     double speed, bool& copies);

/// The text tracks of all cuts, merged by name and language. Words that a cut divides are
/// shortened. `speed`: how much faster everything becomes.
std::vector<media::TextTrack> cut_texts(const std::vector<EditCut>& cuts, double speed);

}  // namespace animeme::tools
