/// @file
/// Videos of a face, for any player.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/mux.h"
#include "tools/view/studio/head_view.h"
#include "tools/view/studio/stage.h"

namespace animeme::studio {

/// Options for a video.
struct FilmOptions {
  HeadLook look;  ///< head and camera
  /// Those who are shown, from left to right; the clip is that of one of them. Empty: one, with the
  /// head of `look`.
  std::vector<StagePerson> people = {};
  std::optional<fap::Rate> rate;        ///< frames a second; nullopt: rate of the clip
  int quality = 20;                     ///< as VideoSettings::quality
  const dam::Script* script = nullptr;  ///< phones to show below; nullptr: none
  std::vector<int> faps;                ///< curves to show below, three at most
  int audio_bit_rate = 0;               ///< bits a second; 0: default
  /// What is said, by frame of the clip: see head::PoseOptions::visemes. Empty: unknown.
  std::vector<fap::VisemeWeights> visemes = {};
  /// What is said, as captions in the picture (captions.h); nullptr: none.
  const dam::Script* captions = nullptr;
};

/// A video that was written.
struct Film {
  std::size_t pictures = 0;  ///< number of frames
  int width = 0;             ///< pixels
  int height = 0;            ///< pixels
  fap::Rate rate;            ///< pictures a second
  std::string codec;         ///< name of the codec
  double seconds = 0;        ///< duration
  bool stopped = false;      ///< cancelled before the end
};

/// Whether the extension (in lower case) is that of an animation without sound: .webp, .gif.
bool is_animation(const std::string& extension);

/// Whether the path names a picture for each frame: ".png" with one %d or %04d in its name.
bool is_picture_sequence(const std::string& path);

/// Whether a file with this extension (in lower case) keeps transparency: .webm, .mov, .webp,
/// .png.
bool keeps_alpha(const std::string& extension);

/// The quality of JPEG and WebP, 1..100, for one of FilmOptions.
int picture_quality(int quality);

/// Whether write_film() supports the extension (in lower case): .mp4, .webm, .mkv, .mov, .webp,
/// .gif.
bool is_film(const std::string& extension);

/// Renders `clip` (filled) and writes it with `sound` (audio or encoded; its face becomes a
/// separate track; an animation has pictures only). The video lasts as long as the longer of clip
/// and sound. A path of is_picture_sequence() gets one file a picture, numbered from 1, without
/// sound. Notes of the head go to log.info. Errors: not_found (no frames), unsupported (extension,
/// no encoder, no background where keeps_alpha() is false), those of HeadView::make(),
/// CaptionPainter, VideoEncoder and write_container(), with the path.
Result<Film> write_film(const std::string& path, const fap::Sequence& clip,
                        const media::MuxInput& sound, const FilmOptions& options,
                        const tools::Log& log = {}, const tools::Progress& progress = {});

}  // namespace animeme::studio
