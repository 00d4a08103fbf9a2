/// @file
/// Converts ordered packets to units of face and sound, with RTP times.
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

/// Units made from packets.
struct RtpUnits {
  std::vector<LiveUnit> units;  ///< times in ticks of the RTP clock, durations as in LiveUnit
  bool damaged = false;         ///< something was dropped before the first unit
};

/// Reassembles planes and strips the configuration before them.
class FaceAssembler {
 public:
  /// `timescale` of durations. If `config` is empty, planes are dropped until one arrives.
  FaceAssembler(std::vector<std::uint8_t> config, std::uint32_t timescale)
      : config_(std::move(config)), timescale_(timescale) {}

  RtpUnits add(const RtpPacket& packet,
               std::int64_t time);  ///< returns units that are now complete
  void gap() { joiner_.gap(); }     ///< packets are missing; drops an incomplete unit
  /// A new sender: drops an incomplete unit.
  void restart() { joiner_ = {}; }

  /// Decoder configuration, from the description or in band.
  const std::vector<std::uint8_t>& config() const { return config_; }
  /// Of the last intra plane; nullopt: there was none, or it has no rate.
  std::optional<fap::Rate> rate() const { return rate_; }

 private:
  bool add_plane(RtpUnit plane, RtpUnits& out);

  std::vector<std::uint8_t> config_;
  std::uint32_t timescale_;
  std::optional<fap::Rate> rate_;
  PlaneJoiner joiner_;
};

/// Reassembles audio packets.
class AudioAssembler {
 public:
  explicit AudioAssembler(const RtpAudioTrack& track);  ///< `track` as described

  RtpUnits add(const RtpPacket& packet,
               std::int64_t time);  ///< returns units that are now complete
  void gap() { joiner_.gap(); }     ///< packets are missing; drops an incomplete unit

 private:
  AudioFormat format_;
  AacJoiner joiner_;
};

/// Converts ticks of 1/90000 s to the nearest ticks of `timescale`. Above 90000, where this is
/// ambiguous, a time within a tick of a whole number of planes is rounded to that.
std::int64_t to_timescale(std::int64_t ticks, std::uint32_t timescale,
                          std::optional<fap::Rate> rate);
/// The inverse.
std::int64_t from_timescale(std::int64_t time, std::uint32_t timescale);

}  // namespace animeme::media
