/// @file
/// What a source gives out, as it can be shown and written into a file while it comes.
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
/// Planes and packets keep their bytes and their distances. After a loss the plane before it is
/// held (it lasts longer) until the next plane that can be decoded; missing sound is a gap in the
/// packets' times. Who joins in the middle begins with the first intra plane.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/live/recorded_times.h"
#include "tools/formats/media/rtp/recovery.h"

namespace animeme::media {

/// When a recording ends by itself.
struct RecorderOptions {
  /// Seconds of presentation after which it ends; 0: never.
  double duration = 0;
  /// False: take_units() has nothing, for who only wants to see them.
  bool keep = true;
};

/// Sorts out what a source gives out. Its memory does not grow with time, as long as what there is
/// is taken.
class Recorder {
 public:
  /// Options as they are, unchecked.
  explicit Recorder(const RecorderOptions& options = {}) : options_(options) {}

  /// Keeps what can be used of an event. Gives back the unit that was kept, for whoever shows it
  /// at once. Units whose times do not ascend are left out. Nothing is kept once it has ended.
  std::optional<LiveUnit> accept(LiveEvent event);

  /// The sender has ended, the recording is as long as it may be, or another presentation began.
  bool ended() const { return ended_; }
  /// Was a plane lost or left out between the last two planes that were kept?
  bool after_gap() const { return after_gap_; }
  /// Nothing: the source has not said yet.
  const std::optional<LiveInfo>& info() const { return info_; }
  const RecoveryStats& recovery() const { return recovery_.stats(); }  ///< totals
  /// Intra intervals that are complete; each is given once.
  std::vector<IntraInterval> take_intervals() { return recovery_.take_intervals(); }
  /// Seconds of face and of sound that were received.
  double face_seconds() const;
  double sound_seconds() const;  ///< likewise

  /// What a file gets next: units whose time and duration are certain by now, see RecordedTimes.
  /// Each is given once; the last ones come when it has ended.
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
