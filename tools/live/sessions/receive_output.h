/// @file
/// What is kept of a reception as text. Containers and streams:
/// tools/formats/media/live/recording_file.h.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/media/live/live_frames.h"

namespace animeme::live {

/// ".mp4", ".mkv", ".ts".
bool is_container_output(const std::string& output);
/// ".fap", or "-": text on standard output.
bool is_fap_output(const std::string& output);

/// Can a file of this name be made? A sentence before anything is received. Error: io.
Result<void> check_place(const std::string& output);

/// What is in the text of a reception.
struct FapOutputOptions {
  media::GapRule gap = media::GapRule::hold;  ///< what is shown while planes are missing
  bool coded = false;                         ///< frames as they are coded; implies `exact`
  bool fill = false;                          ///< every FAP, at rest if it was never sent
  bool expand = false;                        ///< FAP 1 and 2 as low-level FAPs
  bool exact = false;  ///< the exact rate in the header, where players want a whole one
};

/// Frames as text as they come: for standard output, or at the end of a file, where each is on the
/// disk at once. A text that is still coming has no frame count and a mask that grows; players show
/// files, which get both at their end. Memory does not grow with the text.
class FapOutput {
 public:
  /// `output`: path, or "-". Nothing is opened yet.
  FapOutput(const std::string& output, const FapOutputOptions& options);

  /// False: `output` is no text, nothing is done with units.
  bool wanted() const { return is_fap_output(output_); }
  /// Text of the frames of a unit for standard output; empty where a file is written. With the
  /// first frame the file takes its name, and one of that name is replaced. Error: io.
  Result<std::string> push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap);
  /// Frames a second, of those so far.
  fap::Rate rate() const { return frames_.rate(); }
  /// Completes the file, if it is one and there were frames. Errors: io; those of fap::read_text(),
  /// if somebody else has changed it.
  Result<void> finish();

 private:
  Result<void> append(const std::string& text);
  Result<void> complete();
  std::string header(std::int64_t frames) const;

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string output_;
  FapOutputOptions options_;
  media::LiveFrames frames_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::int64_t count_ = 0;
  fap::Mask mask_;  // of the newest frame: masks grow
};

}  // namespace animeme::live
