/// @file
/// Captures of a face from files: tables and JSON of trackers, and videos by way of a tracker.
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

/// How captures are read.
struct CaptureSettings {
  std::optional<Tracker> tracker;  ///< for videos; nothing: videos are refused
  /// For one video; nothing: an hour, or thirty times its length if that is more.
  std::optional<double> tracker_seconds;
  Progress tracking;                          ///< of the tracker, for each video anew
  exchange::CaptureTableOptions table;        ///< columns of other names
  exchange::LandmarkImportOptions landmarks;  ///< of points
  std::optional<fap::Rate> rate;              ///< --rate
  bool degrees = false;                       ///< angles of shapes
};

/// A capture that was read: points, of which a neutral face makes FAPs, or FAPs.
struct Capture {
  std::string path;                               ///< for messages
  std::optional<exchange::LandmarkTable> points;  ///< of trackers
  std::optional<exchange::Imported> motion;       ///< of shapes or FAPs
  std::vector<std::int64_t> made;     ///< frames of FAPs that a table says were not measured
  std::vector<std::string> warnings;  ///< but those of `points` and `motion`
};

/// What a tracker's table is of: the video, if it was tracked from one.
struct TrackedTable {
  std::string text;                ///< the table or JSON
  std::optional<VideoFile> video;  ///< nothing: nobody knows one
};

/// The table of a capture: that of a file, of standard input ("-"), or of a tracker. Errors: those
/// of read_file(), look_at_video() and Tracker::run(); unsupported (a video, and no tracker).
Result<TrackedTable> read_capture_table(const std::string& path, const CaptureSettings& settings,
                                        const Log& log);

/// A table as a capture; `path` is for messages. Errors, with the path: those of
/// exchange::capture_table() and of the reader for its kind.
Result<Capture> parse_capture(const TrackedTable& table, const std::string& path,
                              const CaptureSettings& settings);

/// Both.
Result<Capture> read_capture(const std::string& path, const CaptureSettings& settings,
                             const Log& log);

/// A face of its own: FAPs of a clip and what is to be said of them.
struct CapturedFace {
  fap::Sequence clip;                              ///< without a name
  std::vector<std::int64_t> made;                  ///< numbers of the frames that were filled in
  std::optional<double> start;                     ///< seconds of number 0, as the capture tells
  std::optional<exchange::LandmarkImport> points;  ///< of points: the whole import, clip moved out
  std::vector<std::string> warnings;               ///< all of them
};

/// FAPs of a capture; `rest`, if any, is the neutral face of points. Gaps of shapes of at most 0.2
/// s are filled, too, unless settings.landmarks.repair is off. Errors, with the path: those of
/// exchange::import_landmarks().
Result<CapturedFace> face_of_capture(Capture capture, const CaptureSettings& settings,
                                     const std::optional<fap::RestingFace>& rest);

/// Says in a signal which frames (numbers from its first row on) were filled in.
void mark_made(dam::Signal& signal, const std::vector<std::int64_t>& made);

/// Where `--neutral-from` and `--face-file` say that the neutral face is, or in all of `captures`
/// together if there are several with points; nothing: each has its own.
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
