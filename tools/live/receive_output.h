/// @file
/// What is kept of a reception: text while it comes, files at the end.
#pragma once

#include <string>

#include "fap/frame.h"
#include "tools/files/talk.h"
#include "tools/media/live/live_frames.h"
#include "tools/media/live/recorder.h"

namespace animeme::live {

/// ".mp4", ".mkv", ".ts".
bool is_container_output(const std::string& output);
/// ".fap", or "-": text on standard output.
bool is_fap_output(const std::string& output);

/// A sentence before anything is received: not after an hour of recording. Error: io.
Result<void> check_folder(const std::string& output);

/// What is in the text of a reception.
struct FapOutputOptions {
  media::GapRule gap = media::GapRule::hold;  ///< what is shown while planes are missing
  bool coded = false;                         ///< frames as they are coded; implies `exact`
  bool fill = false;                          ///< every FAP, at rest if it was never sent
  bool expand = false;                        ///< FAP 1 and 2 as low-level FAPs
  bool exact = false;  ///< the exact rate in the header, where players want a whole one
};

/// Frames as text: for standard output as they come, else kept for the file. Players show files; a
/// text that is still coming has no frame count and a mask that grows.
class FapOutput {
 public:
  /// `output`: path, or "-".
  FapOutput(const std::string& output, const FapOutputOptions& options);

  /// False: `output` is no text, nothing is done with units.
  bool wanted() const { return is_fap_output(output_); }
  /// Text of the frames of a unit for standard output; empty where a file is written.
  std::string push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap);
  /// Frames a second, of those so far.
  fap::Rate rate() const { return clip_.rate; }
  /// Writes the file, if it is one. Error: io.
  Result<void> finish();

 private:
  std::string output_;
  FapOutputOptions options_;
  media::LiveFrames frames_;
  fap::Sequence clip_;
  bool begun_ = false;
};

/// A raw stream or a container. Sound that a container does not take is coded again, which is
/// said. Errors: those of media::write_container(), io.
Result<void> write_recording(const std::string& output, const media::Recording& recording,
                             const tools::Talk& talk = {});

}  // namespace animeme::live
