/// @file
/// External trackers: programs that track a face in a video and write a table.
///
///     auto tracker = Tracker::parse("node track.js {in} {out}");
///     auto table = tracker->run("clip.mp4");
///
/// tools/characters/trackers/README.md documents the required output.
#pragma once

#include <optional>
#include <string>

#include "fap/rate.h"
#include "fap/result.h"
#include "tools/formats/exchange/landmarks.h"
#include "tools/formats/files/log.h"
#include "tools/formats/programs/command_template.h"

namespace animeme::tools {

/// Properties of a video before tracking.
struct VideoFile {
  exchange::PictureSize shown;     ///< displayed size, in square pixels
  double pixel_aspect = 1;         ///< of the stored pixels
  std::optional<fap::Rate> rate;   ///< frames a second, if stated
  double seconds = 0;              ///< 0: not stated
  bool sound = false;              ///< has sound
  double picture_after_sound = 0;  ///< seconds from the first sample to the first frame

  /// "a video (mpeg1video, 360x288, 25 frames a second, 3 s)".
  std::string text;
};

/// Errors: not_found (no file, no picture track); those of media::probe().
Result<VideoFile> look_at_video(const std::string& path);

/// A command that is run for each video, without a shell.
class Tracker {
 public:
  /// `command`: see parse_command(); {in} and {out} are added at its end if neither is there.
  /// Errors: invalid_argument.
  static Result<Tracker> parse(const std::string& command);

  /// What it writes to {out} (a file whose name ends in .csv), or to standard output if the command
  /// has no {out}. `progress` receives the values of standard error lines that end in "N %", and
  /// may stop it. Errors, with the path of the video: not_found (the program failed, with its last
  /// output; it wrote nothing), out_of_range (longer than `seconds`), io (also: stopped).
  Result<std::string> run(const std::string& video, double seconds,
                          const Progress& progress = {}) const;

  const std::string& command() const { return line_; }  ///< as given

 private:
  std::string line_;
  CommandTemplate command_;
};

}  // namespace animeme::tools
