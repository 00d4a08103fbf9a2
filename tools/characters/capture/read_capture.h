/// @file
/// Reads captures of a face: tables and JSON of trackers, and videos through a tracker.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/signal/signal.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/characters/capture/tracker.h"
#include "tools/formats/exchange/capture_table.h"
#include "tools/formats/exchange/imported.h"
#include "tools/formats/files/log.h"

namespace animeme::tools {

/// Options for reading captures.
struct CaptureSettings {
  std::optional<Tracker> tracker;  ///< for videos; nullopt: videos are rejected
  /// Time limit for one video; nullopt: an hour, or thirty times its length if that is more.
  std::optional<double> tracker_seconds;
  Progress tracking;                          ///< of the tracker, for each video
  exchange::CaptureTableOptions table;        ///< custom column names
  exchange::LandmarkImportOptions landmarks;  ///< of points
  std::optional<fap::Rate> rate;              ///< --rate
  bool degrees = false;                       ///< angles of shapes
};

/// A capture: points, which are converted to FAPs with a neutral face, or FAPs.
struct Capture {
  std::string path;                               ///< for messages
  std::optional<exchange::LandmarkTable> points;  ///< of trackers
  std::optional<exchange::Imported> motion;       ///< of shapes or FAPs
  std::vector<std::int64_t> made;     ///< frames of FAPs that a table says were not measured
  std::vector<std::string> warnings;  ///< except those of `points` and `motion`
};

/// A tracker's table, with its video if known.
struct TrackedTable {
  std::string text;                ///< the table or JSON
  std::optional<VideoFile> video;  ///< nullopt: unknown
};

/// The table of a capture: that of a file, of standard input ("-"), or of a tracker. Errors: those
/// of read_file(), look_at_video() and Tracker::run(); unsupported (a video, and no tracker).
Result<TrackedTable> read_capture_table(const std::string& path, const CaptureSettings& settings,
                                        const Log& log);

/// A table as a capture; `path` is for messages. Errors, with the path: those of
/// exchange::capture_table() and of the reader for its kind.
Result<Capture> parse_capture(const TrackedTable& table, const std::string& path,
                              const CaptureSettings& settings);

/// Reads and parses a capture.
Result<Capture> read_capture(const std::string& path, const CaptureSettings& settings,
                             const Log& log);

/// FAPs of a capture with their properties.
struct CapturedFace {
  fap::Sequence clip;                              ///< without a name
  std::vector<std::int64_t> made;                  ///< numbers of the frames that were filled in
  std::optional<double> start;                     ///< seconds of number 0 in the capture
  std::optional<exchange::LandmarkImport> points;  ///< of points: the whole import, clip moved out
  std::vector<std::string> warnings;               ///< all of them
};

/// Converts a capture to FAPs; `rest`, if given, is the neutral face for points. Gaps of shapes of
/// at most 0.2 s are also filled, unless settings.landmarks.repair is off. Errors, with the path:
/// those of exchange::import_landmarks().
Result<CapturedFace> face_of_capture(Capture capture, const CaptureSettings& settings,
                                     const std::optional<fap::RestingFace>& rest);

/// Marks frames of a signal (numbered from its first row) as filled in.
void mark_made(dam::Signal& signal, const std::vector<std::int64_t>& made);

/// Source of the neutral face: `--neutral-from` or `--face-file`, or by default all `captures` with
/// points together; a single capture has its own.
struct NeutralSource {
  std::string from;       ///< --neutral-from
  std::string face_file;  ///< --face-file
};
/// Errors: those of read_capture(), exchange::common_face() and exchange::read_face_file();
/// invalid_argument (both sources; a part of a clip for several).
Result<std::optional<fap::RestingFace>> neutral_face(const NeutralSource& source,
                                                     const std::vector<Capture>& captures,
                                                     const CaptureSettings& settings,
                                                     const Log& log);

}  // namespace animeme::tools
