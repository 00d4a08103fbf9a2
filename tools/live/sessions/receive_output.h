/// @file
/// Writes a reception as text. Containers and streams: tools/formats/media/live/recording_file.h.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/media/live/live_frames.h"

namespace animeme::live {

/// Whether the extension is .mp4, .mkv or .ts.
bool is_container_output(const std::string& output);
/// Whether the extension is .fap, or "-" for text on standard output.
bool is_fap_output(const std::string& output);

/// Checks before reception that a file of this name can be created. Errors: io.
Result<void> check_place(const std::string& output);

/// Options for text output.
struct FapOutputOptions {
  /// Frames while planes are missing. With `skip` the others are numbered without gaps, as players
  /// need them; with `exact` they keep their numbers.
  media::GapRule gap = media::GapRule::hold;
  bool coded = false;   ///< frames as coded; implies `exact`
  bool fill = false;    ///< every FAP, at rest if it was never sent
  bool expand = false;  ///< FAP 1 and 2 as low-level FAPs
  bool exact = false;   ///< write the exact rate in the header, although players need an integer
};

/// Writes frames as text as they arrive, to standard output or to a file, flushed after each frame.
/// Text being written has no frame count and a growing mask; files get both at the end. Uses
/// constant memory.
class FapOutput {
 public:
  /// `output`: path, or "-". Nothing is opened yet.
  FapOutput(const std::string& output, const FapOutputOptions& options);

  /// False: `output` is not text; units are ignored.
  bool wanted() const { return is_fap_output(output_); }
  /// Returns the text of a unit's frames for standard output; empty if a file is written. The file
  /// appears with the first frame and replaces an existing one. Errors: io.
  Result<std::string> push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap);
  /// Frames a second, so far.
  fap::Rate rate() const { return frames_.rate(); }
  /// Completes the file, if it is one and there were frames. Errors: io; those of fap::read_text(),
  /// if another program changed it.
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
