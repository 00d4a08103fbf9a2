/// @file
/// What a source gives out, kept: a face and its sound as they can be written into a file.
///
///     Recorder recorder;
///     while (!recorder.ended()) {
///       auto event = source->next(0.1);
///       if (!event) break;
///       if (auto unit = recorder.accept(std::move(*event))) show(*unit);
///     }
///     Recording talk = recorder.recording();
///
/// Planes and packets keep their bytes and their distances. After a loss the plane before it is
/// held (it lasts longer) until the next plane that can be decoded; missing sound is a gap in the
/// packets' times. Who joins in the middle begins with the first intra plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "tools/media/encoded_audio.h"
#include "tools/media/live/live.h"
#include "tools/media/live/recovery.h"

namespace animeme::media {

/// When a recording ends by itself.
struct RecorderOptions {
  /// Seconds of presentation after which it ends; 0: never.
  double duration = 0;
  /// More than this ends it, too (some 30 hours of face and sound).
  std::size_t max_bytes = std::size_t(1) << 30;
  /// False: units are given back but not kept, for who only wants to see them, however long.
  bool keep = true;
};

/// Time 0 is where the first of both begins: the first plane, or the first sample that can be
/// heard (behind the priming of the first packet). A presentation that was received from its begin
/// on has the times of its sender. Where time 0 lies between two ticks of the other track, that is
/// rounded to the nearest one, all of it alike.
struct Recording {
  fba::AccessUnits face;  ///< the first unit begins with the object start code
  EncodedAudio sound;     ///< no packets: silent. `length`: to the end of the last packet
};

/// Collects what a source gives out, for a file.
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

  /// All that was kept so far. Both tracks may be empty.
  Recording recording() const;

 private:
  bool take_info(const LiveInfo& info);
  bool keep(const LiveUnit& unit);
  bool beyond(const LiveUnit& unit);

  RecorderOptions options_;
  FaceRecovery recovery_;
  std::optional<LiveInfo> info_;
  fba::AccessUnits face_;
  EncodedAudio sound_;
  std::optional<double> first_;                 // seconds of the first unit kept
  std::optional<std::int64_t> last_[2];         // times of the last units, by LiveTrack
  std::int64_t face_begin_ = 0, face_end_ = 0;  // ticks
  std::int64_t sound_samples_ = 0;
  std::int64_t left_out_ = 0;  // planes and losses known when the last plane was kept
  std::size_t bytes_ = 0;
  bool after_gap_ = false;
  bool ended_ = false;
};

}  // namespace animeme::media
