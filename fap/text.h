/// @file
/// FAP text: the ASCII .fap file that MPEG-4 face players exchange. Grammar and the quirks of
/// real programs: fap/text_format.md, sections 1 to 3.
///
///     # a comment
///     2.1 my_clip 25 2                         version, name, frames per second, frame count
///     0 0 1 0 0 ...                            68 mask values: which of FAP 1..68 follow
///     0 341                                    frame number, one value per FAP of the mask
///     0 0 1 0 0 ...
///     1 356
///
/// FAP 1 (viseme) has 4 values and FAP 2 (expression) 6, see Viseme and Expression in frame.h.
/// Values are plain FAP values, whatever the version says: files of version 2.0 are not scaled
/// either.
///
///     std::vector<std::string> warnings;
///     auto clip = animeme::fap::read_text(text, {}, &warnings);
///     if (!clip) return clip.error();
///     std::string again = animeme::fap::write_text(*clip);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::fap {

/// Options of read_text().
struct ReadTextOptions {
  /// The text has no header line, as on a message bus: it starts with a mask, or with one line that
  /// holds a start time. Without this flag such a text is still accepted if it is unambiguous (a
  /// first line of 68 or more flags, or one integer above such a line).
  bool headerless = false;
  /// Frame rate of a text without one (no header, or rate 0).
  Rate default_rate = {25, 1};
  /// Keep the number of the first frame. False: numbers are shifted so that it is 0.
  bool keep_numbers = false;
};

/// Reads a FAP text of any origin. Safe for untrusted input: time and memory are linear in the
/// text (below ten times its size), whatever numbers it contains.
///
/// Accepted silently: comments (from '#' at the start of a token to the end of the line), blank
/// lines, tabs, CR LF, a missing newline at the end, versions 2.0 to 2.2, a path as name, rates
/// like 12.5 and 29.97 (see rate_text.h), an exact rate after the name as write_text() writes it
/// ("talk@29.97fps" with the rate 30), gaps in the frame numbers (skipped frames: they stay gaps,
/// fill() closes them).
///
/// Accepted with a warning:
/// - a UTF-8 byte order mark; no header; a version other than 2.0 to 2.2; spaces in the name
///   (everything between the version and the last two numbers is the name); no name; rate 0; a
///   missing or wrong frame count (all frames are read);
/// - 69 mask values (the last is ignored); mask and values on one line; a mask or a value list that
///   continues on the next line, as long as each ends at the end of a line;
/// - fractional numbers (rounded, halves away from zero);
/// - FAP 1 or 2 with a single value as written by Greta: it is the selection, at full strength;
/// - viseme and expression values outside the ranges of frame.h (kept; flags: not 0 is 1);
/// - frame numbers that do not start at 0 (shifted, unless keep_numbers); a repeated number (merged
///   into the previous frame, the later values win); a number that goes back (the numbering
///   continues after the previous frame); the same number everywhere (frames are numbered in
///   order).
///
/// `warnings` (may be null) gets one line per kind of deviation, in the order of first appearance:
/// "line 2: a mask has 69 values, the last is ignored (and in 170 more places)".
///
/// Errors, with line and column:
/// - Code::truncated: empty text, or it ends inside a frame;
/// - Code::syntax: no valid header, a mask value other than 0 and 1, a word in place of a number, a
///   mask that is too short, a value line that is too short or too long for its mask;
/// - Code::out_of_range: a FAP value beyond 32 bits, a frame number beyond +-10^15, a rate
///   beyond parse_rate();
/// - Code::unsupported: this is not FAP text but a binary FBA stream, body animation text (BAP),
///   an encoder parameter file (EPF), XML or UTF-16.
/// - Code::invalid_argument: default_rate is not valid.
Result<Sequence> read_text(std::string_view text, const ReadTextOptions& options = {},
                           std::vector<std::string>* warnings = nullptr);

/// Options of write_text().
struct WriteTextOptions {
  bool renumber = false;  ///< number the frames 0, 1, 2 ...; false: their own numbers, with gaps
  /// Write the nearest whole rate (at least 1) into the header, as players require. A fractional
  /// rate follows the name, "talk@29.97fps", where read_text() finds it: not all players skip a
  /// comment, wherever it is (fap/text_format.md, section 3), but all take any word as a name.
  bool whole_rate = false;
};

/// Writes the form that every known player reads: version 2.1, no comments, a one-word name, the
/// exact frame count, 68 mask values, mask and values on separate lines, LF, a newline at the end.
/// Old players also need frames 0, 1, 2 ... without gaps, one mask for all frames, no FAP 1 and 2
/// combined with others, and a whole rate: see fill() and the options. fap/players.h checks a text
/// for all of this.
///
/// read_text() gives the same sequence back if the name is one word of at most 200 bytes, the frame
/// numbers ascend from 0 and values of absent FAPs are 0. Spaces and control characters of the name
/// become '_', and so do a leading '#' and an '@' that would be read as an exact rate; longer names
/// are cut (a player has room for 254 bytes); an empty one becomes "clip". An invalid rate is
/// written as 0.
std::string write_text(const Sequence& sequence, const WriteTextOptions& options = {});

/// @{
/// The same in pieces, for clips that do not fit into memory: the header line, and the two lines of
/// a frame under its own number, appended to `text`.
std::string text_header(Rate rate, const std::string& name, std::int64_t frames,
                        const WriteTextOptions& options = {});
void append_text(std::string& text, const Frame& frame);
/// @}

/// The whole rate nearest to `rate`, at least 1; an invalid rate is returned unchanged.
Rate whole_rate(Rate rate);

}  // namespace animeme::fap
