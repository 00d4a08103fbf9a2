// What goes to every connection, in the forms it goes in: RTP times and messages of the channels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/encode/fan_out.h"
#include "tools/formats/media/live/live.h"
#include "tools/live/webrtc/detail/bundle.h"
#include "tools/live/webrtc/detail/peer.h"
#include "tools/live/webrtc/detail/redundant_sound.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {

/// Labels of the data channels.
inline constexpr const char* kFace = "animeme.face";
inline constexpr const char* kValues = "animeme.faps";

/// One connection and what it has been given.
struct Receiver {
  std::unique_ptr<Peer> peer;
  bool face = false, values = false;  ///< that channel is open and was begun with
  /// Of a face whose channel loses nothing: its number in Feed's encoders; 0: it may lose messages.
  std::uint64_t reliable = 0;
  SoundTypes types;  ///< of its sound
  LossGauge gauge;   ///< of its sound
  double loss = 0;   ///< share of its packets of sound, by its newest report
};

/// Not thread safe.
class Feed {
 public:
  /// Of `options` what is said of repetitions. Errors: unsupported (the sound is not Opus).
  static Result<Feed> make(const media::LiveInfo& info, const WebRtcOptions& options);

  /// Takes a unit and says what it is, for those who come later, too.
  void push(const media::LiveUnit& unit, std::string_view values);
  /// Gives what was pushed last to a receiver that is connected; one whose channels have opened
  /// since gets what it needs to begin.
  void give(Receiver& receiver);
  /// It is no receiver any more.
  void forget(const Receiver& receiver);
  /// JSON between the values, to who has these.
  void tell(Receiver& receiver, std::string_view json);
  /// It is over.
  void end(Receiver& receiver);
  /// Its loss, where in-band FEC of Opus helps: it decodes that, and no packets go again.
  double needs_fec(const Receiver& receiver) const;
  /// What was handed to connections so far, without `receivers` and losses.
  const media::SendStats& stats() const { return stats_; }

 private:
  Feed(const media::LiveInfo& info, std::vector<std::uint8_t> hello, const WebRtcOptions& options);
  void send(Receiver& receiver, const char* label, std::span<const std::uint8_t> message,
            bool text);
  bool begins(Receiver& receiver, const char* label, bool& known);
  void begin_reliable(Receiver& receiver);
  void give_reliable(Receiver& receiver);
  void give_sound(Receiver& receiver);

  std::uint32_t timescale_;
  int sample_rate_ = 0;
  BundleWriter bundles_;
  int audio_repeat_;
  RedundantSound redundant_;
  media::SendStats stats_;
  // Of the newest unit.
  bool is_sound_ = false;
  std::vector<std::uint8_t> message_;  // or the packet of sound
  std::uint32_t rtp_time_ = 0;
  std::string values_, newest_values_;
  // For receivers to whom nothing is lost: an encoder each, without intra planes from time to time.
  std::optional<fba::FanOut> fan_out_;
  std::uint64_t last_reliable_ = 0;
  std::uint64_t time_ = 0;  // of the newest unit of the face
  std::uint32_t duration_ = 0;
};

}  // namespace animeme::webrtc
