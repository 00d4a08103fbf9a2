/// @file
/// Sound as segments of a fragmented mp4 that browsers can play as they arrive: one initialisation
/// segment, then media segments (moof and mdat) of a few packets each.
///
///     auto begin = write_audio_init(format);                 // once
///     auto piece = write_audio_segment(1, packets);          // again and again
///
/// The clock of the track has `sample_rate` ticks a second; tfdt is the time of the first packet.
/// There is no edit list: a packet with time t begins at t, priming included, so times must be
/// shifted so that none is negative. Opus: the pre-skip in dOps is 0 for the same reason, and
/// browsers then play every sample at its time.
/// Source: tools/formats/media/containers.md, section 4.4; the boxes are those of ISO/IEC 14496-12,
/// 14496-14 and of the Opus encapsulation.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Media type for MediaSource, e.g. `audio/mp4; codecs="mp4a.40.2"`.
std::string audio_mime(const AudioFormat& format);

/// ftyp and moov. Errors: invalid_argument (no configuration, no rate, no channels).
Result<std::vector<std::uint8_t>> write_audio_init(const AudioFormat& format);

/// moof and mdat; `packets` follow each other without a gap. Errors: invalid_argument (none, a
/// negative time, an empty packet).
Result<std::vector<std::uint8_t>> write_audio_segment(std::uint32_t sequence,
                                                      std::span<const AudioPacket> packets);

/// Changes the time (tfdt) of the first packet of a segment; anything but a segment written here is
/// left unchanged.
void set_segment_time(std::span<std::uint8_t> segment, std::int64_t time);

/// Reads back what write_audio_init() writes; priming is 0 and frame_samples the default of the
/// segments. Errors: syntax.
Result<AudioFormat> read_audio_init(std::span<const std::uint8_t> segment);

/// Reads segments with the box layout of write_audio_segment(), at most 4096 packets. Errors:
/// syntax.
Result<std::vector<AudioPacket>> read_audio_segment(std::span<const std::uint8_t> segment);

/// Sets `priming`, and the pre-skip in the OpusHead of Opus.
void set_priming(AudioFormat& format, int priming);

}  // namespace animeme::media
