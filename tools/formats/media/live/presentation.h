/// @file
/// A face and its sound on one clock, in the order in which they are to be sent.
///
///     ClipInput input(info, units, sound, {.loop = true});
///     while (auto due = input.next_due()) {
///       auto units = input.take(*due);             // sound a little ahead of the face
///       ...
///     }
///
/// Presentation time 0 is time 0 of face and sound. A unit is due when its time comes, sound
/// `audio_ahead` seconds before, so that it is there when the face is. The first packets of a
/// sound are due before 0 (priming).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "codec/decode/access_unit.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Seconds of a unit's time, or of any other number of its ticks or samples.
double seconds_of(const LiveInfo& info, LiveTrack track, std::int64_t time);

/// What a sender sends: a clip, or a talking head that is still being made. Not thread safe.
class LiveInput {
 public:
  virtual ~LiveInput() = default;
  /// The same from the first call to the last.
  virtual const LiveInfo& info() const = 0;
  /// Presentation time at which the next unit is due; ascends. Nothing: the presentation is over.
  virtual std::optional<double> next_due() = 0;
  /// The units that are due up to and at `now`, in the order of their instants; sound before the
  /// face where both are due. Errors: those of what makes them; the presentation is then over.
  virtual Result<std::vector<LiveUnit>> take(double now) = 0;
  /// Seconds that sound is due before its time.
  virtual double audio_ahead() const = 0;
  /// Told by the sender when a unit has gone out, at `instant` of its clock.
  virtual void sent(const LiveUnit& unit, double instant) {
    (void)unit;
    (void)instant;
  }
};

/// Presentation time at which a unit of `input` is due.
double due_of(const LiveInput& input, const LiveUnit& unit);

/// How a clip is presented.
struct ClipOptions {
  double audio_ahead = 0.05;  ///< seconds, 0..1
  bool loop = false;          ///< begin again at the end; times go on
  /// Seconds from time 0 on after which nothing is due any more.
  double duration = std::numeric_limits<double>::infinity();
};

/// A presentation that is there as a whole. A repeat begins when face and sound are over, late
/// enough that the priming packets of the sound do not meet those of its end, and a whole number
/// of planes after the start (the planes' distance is the duration of the last one); the sound is
/// moved by the nearest sample. The first plane of a repeat loses its object start code, so that
/// receivers see one stream.
class ClipInput : public LiveInput {
 public:
  /// `face` without units or `audio` without packets: there is none of it.
  ClipInput(fba::AccessUnits face, EncodedAudio audio, const ClipOptions& options = {});
  const LiveInfo& info() const override { return info_; }
  std::optional<double> next_due() override;
  Result<std::vector<LiveUnit>> take(double now) override;
  double audio_ahead() const override { return options_.audio_ahead; }

 private:
  struct Cursor {
    std::size_t unit = 0;
    std::int64_t round = 0;
  };
  std::int64_t shift(LiveTrack track, std::int64_t round) const;
  std::optional<double> due(LiveTrack track) const;
  LiveUnit current(LiveTrack track) const;
  void advance(LiveTrack track);

  LiveInfo info_;
  ClipOptions options_;
  std::vector<LiveUnit> units_[2];  // by LiveTrack
  std::int64_t round_ = 0;  // length of a round in ticks of the face, without one in samples
  Cursor at_[2];            // by LiveTrack
};

}  // namespace animeme::media
