// Coded sound out of a file as it is, for what carries it on without coding it again.
//
//     Result<EncodedAudio> sound = read_encoded_audio("talk.mp4");
//     if (!sound && sound.error().code == Code::unsupported) ...  // decode it and code it anew
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fap/result.h"
#include "tools/media/encoded_audio.h"

namespace animeme::media {

/// The packets of the best audio track. Time 0 is sample 0 of read_audio() on the same file, so
/// the times agree with those of read_container(); packets before it are priming. Times that a
/// container rounds (mkv, ts) are set right where packet follows packet; gaps stay. `length` is
/// what an mp4 states, else 0; the last packet ends there.
///
/// Errors: unsupported (neither AAC nor Opus; AAC in ADTS form, as in .aac and .ts, whose packets
/// have headers of their own), those of read_audio(). Safe for untrusted input.
Result<EncodedAudio> read_encoded_audio(const std::string& path);

}  // namespace animeme::media
