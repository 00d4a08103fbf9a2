/// @file
/// A face and its sound on one clock, in sending order.
///
///     ClipInput input(info, units, sound, {.loop = true});
///     while (auto due = input.next_due()) {
///       auto units = input.take(*due);             // sound a little ahead of the face
///       ...
///     }
///
/// Presentation time 0 is time 0 of face and sound. A unit is due at its time, sound `audio_ahead`
/// seconds earlier, so that it arrives with the face. The first packets of a sound are due before 0
/// (priming).
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

/// Converts ticks (face) or samples (sound) to seconds.
double seconds_of(const LiveInfo& info, LiveTrack track, std::int64_t time);

/// What a sender sends: a clip or a live talking head. Not thread safe.
class LiveInput {
 public:
  virtual ~LiveInput() = default;
  /// Constant.
  virtual const LiveInfo& info() const = 0;
  /// Presentation time at which the next unit is due; ascends. nullopt: the presentation is over.
  virtual std::optional<double> next_due() = 0;
  /// The units that are due up to and at `now`, in the order of their instants; sound first if both
  /// are due. Errors: those of the producer; the presentation is then over.
  virtual Result<std::vector<LiveUnit>> take(double now) = 0;
  /// Seconds that sound is due before its time.
  virtual double audio_ahead() const = 0;
  /// Seconds that everything is due after its time; until then take() may return nothing.
  virtual double delay() const { return 0; }
  /// The sender calls this when a unit has been sent, at `instant` of its clock.
  virtual void sent(const LiveUnit& unit, double instant) {
    (void)unit;
    (void)instant;
  }
  /// Receivers lose so many percent of the packets of sound, 0..50, and nothing else makes up for
  /// it: what is coded from now on may be coded for that.
  virtual void expect_loss(int percent) { (void)percent; }
};

/// Presentation time at which a unit of `input` is due.
double due_of(const LiveInput& input, const LiveUnit& unit);

/// How a clip is presented.
struct ClipOptions {
  double audio_ahead = 0.05;  ///< seconds, 0..1
  bool loop = false;          ///< restart at the end; times continue
  /// Seconds from time 0 after which nothing is due.
  double duration = std::numeric_limits<double>::infinity();
};

/// A complete clip. A repeat begins when face and sound are over, late enough that the priming
/// packets of the sound do not overlap its end, and a whole number of planes after the start (a
/// plane lasts as long as the last one); the sound is shifted to the nearest sample. The first
/// plane of a repeat loses its object start code, so that receivers see one stream.
class ClipInput : public LiveInput {
 public:
  /// `face` may have no units, or `audio` no packets.
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
