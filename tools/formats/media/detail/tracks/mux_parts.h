// What files and segments share in being written.
#pragma once

#include <optional>
#include <string>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/sound/sound_source.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {

/// What must hold before anything is written. Errors: those of write_container() for its input and
/// options.
Result<void> check_input(const MuxInput& input, const MuxOptions& options);

/// Profile and level of the face, 0xFF (none required) without one.
int visual_profile(const MuxInput& input);

/// What the contents of an mp4 say.
struct Mp4Contents {
  const fba::AccessUnits* face = nullptr;
  int visual_profile = 0xFF;
  const AudioFormat* sound = nullptr;
  const EncodedVideo* video = nullptr;
};

/// Options of libavformat's mp4 muxer: brand, initial object descriptor, movie time scale.
void set_mp4_options(const Mp4Contents& contents, av::Options& header);

/// An mp4 in one piece: a second of each track at a time.
void set_chunk_options(av::Options& header);

/// The same for a file of fragments; `cut` is libavformat's word for where they begin besides:
/// "frag_keyframe" or "frag_custom". `seconds` 0: no longest fragment.
void set_fragment_options(const char* cut, double seconds, av::Options& header);

/// A transport stream; `shared_seconds` as in MuxOptions.
void set_ts_options(double shared_seconds, av::Options& header);

/// Adds empty packets to a transport stream at `path` that is very short: libavformat takes nothing
/// for one that has less than eleven. Error: io.
Result<void> fill_up_ts(const std::string& path);

/// The sound of `input`, coded as `options` say; nothing: there is none. Errors: those of
/// AudioEncoder::open() and AudioReader::open().
Result<std::optional<SoundSource>> open_sound(const MuxInput& input, const MuxOptions& options);

}  // namespace animeme::media
