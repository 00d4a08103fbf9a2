/// @file
/// Films of a face: what any player shows.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/mux.h"
#include "tools/view/studio/head_view.h"

namespace animeme::studio {

/// How a film looks and sounds.
struct FilmOptions {
  HeadLook look;                        ///< head and camera
  std::optional<fap::Rate> rate;        ///< pictures a second; nothing: one a frame of the clip
  int quality = 20;                     ///< as VideoSettings::quality
  const dam::Script* script = nullptr;  ///< phones to show below; nullptr: none
  std::vector<int> faps;                ///< curves to show below, three at most
  int audio_bit_rate = 0;               ///< bits a second; 0: usual
};

/// A film that was written.
struct Film {
  std::size_t pictures = 0;  ///< that were drawn
  int width = 0;             ///< pixels
  int height = 0;            ///< pixels
  fap::Rate rate;            ///< pictures a second
  std::string codec;         ///< name of the codec
  double seconds = 0;        ///< of the film
  bool stopped = false;      ///< before the end
};

/// The extension of an animation, which has no sound: .webp; in lower case.
bool is_animation(const std::string& extension);

/// The quality of JPEG and WebP, 1..100, for one of FilmOptions.
int picture_quality(int quality);

/// The extensions that write_film() takes: .mp4, .webm, .mkv, and .webp; in lower case.
bool is_film(const std::string& extension);

/// Renders `clip` (filled) and writes it with the sound that `sound` names (audio or encoded; its
/// face goes along as a track of its own; an animation has the pictures alone). The film lasts as
/// long as the clip or the sound, whatever is longer. What the head notes is said. Errors:
/// not_found (no frames), unsupported (extension, no encoder), those of load_head(), VideoEncoder
/// and write_container(), with the path.
Result<Film> write_film(const std::string& path, const fap::Sequence& clip,
                        const media::MuxInput& sound, const FilmOptions& options,
                        const tools::Log& log = {}, const tools::Progress& progress = {});

}  // namespace animeme::studio
