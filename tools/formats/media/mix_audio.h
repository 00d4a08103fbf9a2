/// @file
/// The sound of several people as one.
#pragma once

#include <span>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {

/// A sound that is a part of a mix.
struct MixPart {
  std::string path;         ///< any file that AudioReader opens
  TrackLabels labels = {};  ///< the track in it; empty: its default
};

/// Writes the sum of sounds that begin together to a WAV file of one channel; it lasts as long as
/// the longest, at the highest rate of them (at most 48 kHz). Where the sum exceeds full scale it
/// is limited smoothly. Memory does not grow with its length. Errors: those of AudioReader, with
/// the path, and WavWriter; invalid_argument (no sounds).
Result<void> mix_audio(const std::string& path, std::span<const MixPart> parts);

}  // namespace animeme::media
