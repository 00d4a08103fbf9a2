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

/// Frames as text: for standard output as they come, else kept for the file.
class FapOutput {
 public:
  /// `output`: path, or "-"; `fill`: give out complete frames.
  FapOutput(const std::string& output, media::GapRule gap, bool fill)
      : output_(output), frames_(gap, fill) {}

  /// False: `output` is no text, nothing is done with units.
  bool wanted() const { return is_fap_output(output_); }
  /// Text of the frames of a unit for standard output; empty where a file is written. Errors:
  /// those of LiveFrames.
  Result<std::string> push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap);
  /// Writes the file, if it is one. Error: io.
  Result<void> finish();

 private:
  std::string output_;
  media::LiveFrames frames_;
  fap::Sequence clip_;
  bool begun_ = false;
};

/// A raw stream or a container. Sound that a container does not take is coded again, which is
/// said. Errors: those of media::write_container(), io.
Result<void> write_recording(const std::string& output, const media::Recording& recording,
                             const tools::Talk& talk = {});

}  // namespace animeme::live
