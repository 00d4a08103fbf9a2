/// @file
/// Prepares received events for display and for writing to a file as they arrive.
///
///     Recorder recorder;
///     RecordingFile file("talk.mp4");
///     while (!recorder.ended()) {
///       auto event = source->next(0.1);
///       if (!event) break;
///       if (auto unit = recorder.accept(std::move(*event))) show(*unit);
///       file.write(recorder);
///     }
///     file.finish();
///
/// Planes and packets keep their bytes and relative times. After a loss the previous plane lasts
/// until the next plane that can be decoded; missing sound is a gap in the packets' times. Joining
/// in the middle begins with the first intra plane.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/live/recorded_times.h"
#include "tools/formats/media/live/recovery.h"

namespace animeme::media {

/// Options for recording.
struct RecorderOptions {
  /// Seconds of presentation after which it ends; 0: never.
  double duration = 0;
  /// False: take_units() returns nothing, for display without a file.
  bool keep = true;
};

/// Filters the events of a source. Uses bounded memory if the results are taken regularly.
class Recorder {
 public:
  /// Options are not checked.
  explicit Recorder(const RecorderOptions& options = {}) : options_(options) {}

  /// Keeps what can be used of an event and returns the kept unit for immediate display. Units
  /// whose times do not ascend are dropped. Nothing is kept after the end.
  std::optional<LiveUnit> accept(LiveEvent event);

  /// The sender has ended, the recording is as long as it may be, or another presentation began.
  bool ended() const { return ended_; }
  /// Was a plane lost or dropped between the last two planes that were kept?
  bool after_gap() const { return after_gap_; }
  /// nullopt: not yet received.
  const std::optional<LiveInfo>& info() const { return info_; }
  const RecoveryStats& recovery() const { return recovery_.stats(); }  ///< totals
  /// Complete intra intervals; each is returned once.
  std::vector<IntraInterval> take_intervals() { return recovery_.take_intervals(); }
  /// Seconds of face that were received.
  double face_seconds() const;
  double sound_seconds() const;  ///< the same for sound

  /// The next units for a file, with known time and duration (see RecordedTimes). Each is returned
  /// once, the last ones after the end.
  std::vector<LiveUnit> take_units() { return times_.take(); }

 private:
  bool take_info(const LiveInfo& info);
  bool keep(const LiveUnit& unit);
  bool beyond(const LiveUnit& unit);
  void end();

  RecorderOptions options_;
  FaceRecovery recovery_;
  std::optional<LiveInfo> info_;
  RecordedTimes times_;
  std::optional<double> first_;                 // seconds of the first unit kept
  std::optional<std::int64_t> last_[2];         // times of the last units, by LiveTrack
  std::int64_t face_begin_ = 0, face_end_ = 0;  // ticks
  std::int64_t sound_samples_ = 0;
  std::int64_t left_out_ = 0;  // planes and losses known when the last plane was kept
  bool after_gap_ = false;
  bool ended_ = false;
};

}  // namespace animeme::media
