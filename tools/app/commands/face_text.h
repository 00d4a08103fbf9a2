/// @file
/// FAP text as the commands write it: so that players show what is meant.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

struct OptionTable;

/// Gets the coded frames of a face one by one, by ascending numbers, with what becomes of FAPs that
/// they do not carry (GroupRules{} where nobody says it).
using TakeFrame = std::function<Result<void>(const fap::Frame&, const fap::GroupRules&)>;

/// A face to be written. Nothing of it has to be in memory.
struct FaceText {
  /// Hands over all frames, each time it is called. Errors are passed on.
  std::function<Result<void>(const TakeFrame&)> frames;
  fap::Rate rate;       ///< of the frames
  std::string name;     ///< for the header
  bool coded = false;   ///< the frames as they are, nothing held or mirrored; implies `exact`
  bool fill = false;    ///< every low-level FAP, at rest if it is never coded
  bool expand = false;  ///< FAP 1 and 2 as low-level FAPs
  /// Not with `exact`: `expand` where FAP 1 or 2 stand beside low-level FAPs, of which players show
  /// one kind only.
  bool expand_mixed = false;
  bool exact = false;  ///< not for players: the exact rate, and skipped frames stay gaps
  std::optional<fap::Rate> resampled;  ///< the rate to write
};

/// A face that is there as a whole; `clip` is borrowed.
FaceText face_text(const fap::Sequence& clip);

/// What has to be known of a face before its first line can be written.
struct FaceExtent {
  std::int64_t frames = 0;  ///< as they come
  std::int64_t shown = 0;   ///< with those that are skipped
  fap::Mask mask;           ///< of what is shown
};

/// Goes through all frames; `text.rate` does not matter yet. Errors: those of `frames`;
/// out_of_range (more than a million skipped frames); invalid_argument (numbers that do not
/// ascend).
Result<FaceExtent> extent_of(const FaceText& text);

/// Writes it to `out` without publishing it, and warns (of `path`) of what players may stumble
/// over. The result is the number of frames written. Errors: those of `frames`; io.
Result<std::int64_t> write_face_text(OutputFile& out, const std::string& path, const FaceText& text,
                                     const FaceExtent& extent);
/// The same after extent_of(), with its errors.
Result<std::int64_t> write_face_text(OutputFile& out, const std::string& path,
                                     const FaceText& text);
/// --exact, the same in all commands that write FAP text.
void add_exact_option(OptionTable& cli, bool& exact);

/// Warns that `rate` cannot stand in the header of a text for players, if it cannot; `remedy` is
/// the rest of the sentence, "--rate 30 makes it so" by itself if empty.
void warn_of_rate(const std::string& path, fap::Rate rate, const std::string& remedy = {});

}  // namespace animeme::tools
