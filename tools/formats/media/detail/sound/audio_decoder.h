// One audio stream of an open Input, decoded.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "tools/formats/media/detail/ffmpeg/input.h"

namespace animeme::media {

/// Opens a decoder; `flags2` as in AVCodecContext. Errors: unsupported, syntax.
Result<av::Codec> open_audio_decoder(const AVCodecParameters& parameters, AVRational time_base,
                                     int flags2 = 0);

/// Feeds one packet (nullptr: flush) and hands every decoded frame to `take`, which may stop
/// everything with an error. Returns false if the packet was damaged.
Result<bool> decode_packet(AVCodecContext& codec, const AVPacket* packet, AVFrame& frame,
                           const std::function<Result<void>(AVFrame&)>& take);

/// The time stamp from which a stream is played, in its time base: an edit list hides what lies
/// before time 0 in mp4 and its relatives.
std::int64_t first_played(const Input& input, std::int64_t first_decoded);

/// The time stamp at which a stream ends, in its time base, where the file tells it to the sample
/// (mp4 and its relatives); nullopt: elsewhere.
std::optional<std::int64_t> end_of_sound(const Input& input, const AVStream& stream);

/// Encoder padding is at most a frame or two, so an end that would cut more than this part of a
/// second is wrong.
inline constexpr int kPaddingPerSecond = 4;

/// Number of the best audio stream, nullopt: there is none.
std::optional<int> find_audio(const Input& input);

/// That stream, once all headers are read; the others are left out of what is read from then on.
/// Errors: syntax (damaged), not_found (there is none).
Result<AVStream*> choose_audio(Input& input);

/// Reads to the end and hands each packet of a stream to `take`, which may stop everything with an
/// error. Returns FFmpeg's reason why nothing more comes.
Result<int> read_packets(Input& input, int stream,
                         const std::function<Result<void>(AVPacket&)>& take);

}  // namespace animeme::media
