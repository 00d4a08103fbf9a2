/// @file
/// From packets in order to units of the face and the sound; times stay those of RTP.
/// Source: tools/formats/media/containers.md, sections 1.3 and 4.1.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "fap/rate.h"
#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/rtp_payload.h"
#include "tools/formats/media/rtp/sdp.h"

namespace animeme::media {

/// What packets became.
struct RtpUnits {
  std::vector<LiveUnit> units;  ///< times in ticks of the RTP clock, durations as in LiveUnit
  bool damaged = false;         ///< something was dropped in front of the first unit
};

/// Planes. The configuration in front of them is taken off.
class FaceAssembler {
 public:
  /// `timescale` of durations. `config` may be empty; planes are dropped until one comes then.
  FaceAssembler(std::vector<std::uint8_t> config, std::uint32_t timescale)
      : config_(std::move(config)), timescale_(timescale) {}

  RtpUnits add(const RtpPacket& packet, std::int64_t time);  ///< units that are complete now
  void gap() { joiner_.gap(); }  ///< packets are missing; a piece that waits is dropped
  /// A new sender: the same, but what was in work is dropped.
  void restart() { joiner_ = {}; }

  /// Decoder configuration, from the description or in band.
  const std::vector<std::uint8_t>& config() const { return config_; }
  /// Of the last intra plane; nothing: there was none, or it did not say.
  std::optional<fap::Rate> rate() const { return rate_; }

 private:
  bool add_plane(RtpUnit plane, RtpUnits& out);

  std::vector<std::uint8_t> config_;
  std::uint32_t timescale_;
  std::optional<fap::Rate> rate_;
  PlaneJoiner joiner_;
};

/// Packets of sound.
class AudioAssembler {
 public:
  explicit AudioAssembler(const RtpAudioTrack& track);  ///< `track` as described

  RtpUnits add(const RtpPacket& packet, std::int64_t time);  ///< units that are complete now
  void gap() { joiner_.gap(); }  ///< packets are missing; a piece that waits is dropped

 private:
  AudioFormat format_;
  AacJoiner joiner_;
};

/// Ticks of 1/90000 s to ticks of `timescale`, to the nearest. Above 90000 the times of planes are
/// told apart no more; then a time that lies within a tick of a whole number of planes is that.
std::int64_t to_timescale(std::int64_t ticks, std::uint32_t timescale,
                          std::optional<fap::Rate> rate);
/// And back.
std::int64_t from_timescale(std::int64_t time, std::uint32_t timescale);

}  // namespace animeme::media
