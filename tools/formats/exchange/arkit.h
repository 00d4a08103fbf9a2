/// @file
/// Curves of ARKit's blend shapes: those of Live Link Face, which Unreal, Blender and Maya read and
/// write, and those of web avatars.
///
///     auto take = animeme::exchange::read_arkit_table(text);
///     if (take) use(take->clip, take->warnings);
///
///     const auto curves = animeme::exchange::fit_arkit(*animeme::fap::fill(clip, filling));
///     save("talk.csv", animeme::exchange::write_live_link(curves));
///
/// fap/arkit.h has the mapping from shapes to FAPs and the inverse fit.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/signal/signal.h"
#include "fap/arkit.h"
#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/formats/exchange/imported.h"

namespace animeme::exchange {

/// Options for reading a table.
struct ArkitOptions {
  std::optional<fap::Rate> rate;  ///< valid; nullopt: from the times
  bool degrees = false;           ///< the angles of head and eyes are degrees, not radians
};

/// Whether the first line of a text names at least two ARKit shapes, so that read_arkit_table()
/// applies.
bool is_arkit_table(std::string_view text);

/// Reads a table with a header line, fields between commas, semicolons or tabs:
///
///     Timecode,BlendShapeCount,EyeBlinkLeft,...          Live Link Face
///     time_s,browDownLeft,browDownRight,...              corpus curves
///
/// Times are the column timecode, time_s, time, timestamp or the like, in seconds ("1.0333") or as
/// hh:mm:ss:ff.fff. What the last field means is told by which reading makes the steps even: frames
/// and a fraction of a frame, a frame and milliseconds of the second, or milliseconds alone
/// (hh:mm:ss:mmm); with a semicolon (hh:mm:ss;ff) it is drop-frame, of 29.97 or 59.94 frames a
/// second. A date may stand before a time. Without times options.rate is required, and rows are
/// numbered by the column frame, or one after the other. Timecode frames a second are the smallest
/// of 24, 25, 30, 48, 50, 60, 100, 120 that no frame number reaches, or fewer if rows
/// count up by one and never get that far; in a take within one second, what fits options.rate,
/// else 60 with a warning. The rest are channels (fap/arkit.h, any case); missing ones are 0, and
/// an angle that is 0 throughout counts as missing. Other columns are ignored and named in the
/// warnings.
///
/// Weights from 0 to 100 are taken as percent and angles beyond half a turn as degrees, with a
/// warning. A shape of one side alone says that the other side rests. Fields without a number
/// (empty, NaN, NA, null, "-") lie on the line between those of the rows around, with a warning;
/// rows without any are skipped, columns without any ignored.
///
/// The rate is that of the median step, snapped to a rate in common use (10 to 120, NTSC ones
/// included) within 1 %, else to one that FBA can code (k/16). Timecodes count whole frames, so
/// 29.97 is 30 there unless options.rate, fractions of frames or drop-frame say otherwise. Each row
/// becomes the frame nearest to its time; small deviations do not matter, larger steps skip frame
/// numbers (skipped frames). Rows in even steps are never dropped: the rate is one that stays
/// within 40 ms of them to their end, or the next higher one, and then a frame is added where they
/// fall behind, with a warning. If several rows of others fall on the same frame, the last one is
/// used. Rows of Live Link Face without a face (BlendShapeCount 0) are skipped, and a last row that
/// is cut off.
///
/// Errors, with line and column: truncated (no rows), not_found (no time, no channel), syntax (a
/// field that is not a number, missing fields, a duplicate column), out_of_range (times that go
/// back or span more than 10 million frames), invalid_argument (a rate that is not valid; a single
/// row and no rate; steps that do not give a rate from 1/16 to 255).
Result<Imported> read_arkit_table(std::string_view text, const ArkitOptions& options = {});

/// Consecutive frames, from time 0.
struct ArkitCurves {
  fap::Rate rate;                       ///< frames a second
  std::vector<fap::ArkitFrame> frames;  ///< consecutive
};

/// The channels of such a table, unconverted, as consecutive frames: frame n corresponds to frame n
/// of read_arkit_table(), and missing rows repeat the previous row.
/// Errors: those of read_arkit_table().
Result<ArkitCurves> read_arkit_weights(std::string_view text, const ArkitOptions& options = {});

/// Fits curves to a clip with fap::ArkitFitter; frames should be complete and consecutive
/// (fap::fill()). `progress`, if given, receives 0..1 after each frame. About 0.1 ms a frame.
ArkitCurves fit_arkit(const fap::Sequence& clip, const std::function<void(double)>& progress = {});

/// The curves of a signal: its own channels if they have ARKit names (missing ones are 0), else
/// fit_arkit() of its FAPs, completed by fap::fill(). Errors: those of dam::to_sequence().
Result<ArkitCurves> arkit_of_signal(const dam::Signal& signal,
                                    const std::function<void(double)>& progress = {});

/// The table that Live Link Face writes: Timecode (hh:mm:ss:ff.fff, frames of the next whole
/// rate), BlendShapeCount 61, then the channels of fap::kArkitNames with a capital first letter,
/// six decimals. read_arkit_table() reads it back.
std::string write_live_link(const ArkitCurves& curves);

/// {"format": "animeme-arkit", "version": 1, "fps": 25.0, "rate": [25, 1], "audio": null,
///  "names": [61 names], "frames": [[61 numbers], ...]}, angles in radians, one line per frame.
///  `audio` is the name of the sound file; empty: null. Invalid UTF-8 in it becomes U+FFFD.
std::string write_arkit_json(const ArkitCurves& curves, std::string_view audio = {});

}  // namespace animeme::exchange
