// Sound that is sent again with the packets after it, RFC 2198 ("RED"): a packet that is lost is
// found in the next ones.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace animeme::webrtc {

/// RTP payload types that a session description has for sound.
struct SoundTypes {
  int opus = -1;       ///< -1: there is no Opus
  int redundant = -1;  ///< of RFC 2198 with this Opus in it; -1: the other end does not know it
  bool fec = false;    ///< the other end decodes in-band FEC of this Opus (RFC 7587, section 6.1)
};

/// Those of the first sound. Any text is accepted.
SoundTypes sound_types(const std::string& sdp);
/// The description with RFC 2198 as second choice behind the Opus of the first sound; unchanged
/// where `types` has none or the description has no such Opus.
std::string with_redundant(const std::string& sdp, const SoundTypes& types);
/// The description without that payload type: GStreamer does not know it.
std::string without_redundant(const std::string& sdp, const SoundTypes& types);

/// Packets that repeat those before them. Not thread safe.
class RedundantSound {
 public:
  static constexpr int kMostRepeats = 3;  ///< packets that go again with one

  /// The newest packet; `time`: of RTP, 48000 a second.
  void push(std::span<const std::uint8_t> packet, std::uint32_t time);
  /// A payload of RFC 2198: the newest packet behind up to `repeats` before it, as far as they fit
  /// into 1,100 bytes, and are no more than 0.3 s old. `type`: of the Opus in it.
  std::vector<std::uint8_t> payload(int repeats, int type) const;

 private:
  struct Packet {
    std::vector<std::uint8_t> bytes;
    std::uint32_t time = 0;
  };
  std::deque<Packet> packets_;  // the newest is the last
};

/// How many packets go again, by what a receiver says that it lost.
class LossGauge {
 public:
  /// Called for each packet. `loss`: share of the packets that the newest report says were lost.
  int repeats(double loss);

 private:
  int repeats_ = 0;
  int since_ = 0;  // packets since a report asked for as many
};

}  // namespace animeme::webrtc
