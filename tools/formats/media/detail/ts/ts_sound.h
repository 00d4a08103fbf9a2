// Packets of sound out of the PES packets of a transport stream: ADTS frames and Opus units.
// Source: ISO/IEC 14496-3 (adts_frame), the ETSI registration of Opus in MPEG-TS
// (tools/formats/media/containers.md, section 3.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Cuts one sound track into packets.
class TsSound {
 public:
  TsSound() = default;
  /// `channels`: of Opus, else ignored.
  TsSound(TsCodec codec, int channels);

  /// Packets in the content of a PES packet, with their durations; times begin at 0 with the first
  /// one that begins in it. Frames may lie across PES packets. What is no frame is skipped and
  /// counted in damaged().
  std::vector<AudioPacket> push(std::span<const std::uint8_t> pes);
  /// Packets were lost: forgets a frame that has begun.
  void reset() { rest_.clear(); }
  /// Known after the first packet: config, rate, channels, frame_samples. priming is 0.
  const AudioFormat& format() const { return format_; }
  bool known() const { return known_; }
  std::int64_t damaged() const { return damaged_; }

 private:
  void push_adts(std::vector<AudioPacket>& out);
  void push_opus(std::vector<AudioPacket>& out);

  TsCodec codec_ = TsCodec::none;
  AudioFormat format_;
  bool known_ = false;
  std::vector<std::uint8_t> rest_;
  std::int64_t damaged_ = 0;
};

}  // namespace animeme::media
