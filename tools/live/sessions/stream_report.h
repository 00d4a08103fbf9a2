/// @file
/// Progress and summary of a stream.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "tools/formats/media/live/pacer.h"
#include "tools/live/sessions/sinks.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::live {

/// Counts what was sent, for progress lines and a summary.
class StreamReport {
 public:
  explicit StreamReport(const media::LiveInfo& info) : info_(info) {}  ///< `info` is kept

  void add(const media::LiveUnit& unit);  ///< counts a sent unit
  /// "12.0 s: face 25 planes 6.2 kbit/s, ..." of the time since the last call. `now`: seconds
  /// since the begin.
  std::string line(double now, const Sinks& sinks, const media::Pacer& pacer);

  /// The summary, one sentence per line. `traces` may be empty.
  std::string summary(double seconds, const Sinks& sinks, const media::Pacer& pacer,
                      const std::deque<speech::LineTrace>& traces) const;
  /// The same as JSON text.
  std::string json(double seconds, const Sinks& sinks, const media::Pacer& pacer,
                   const std::deque<speech::LineTrace>& traces) const;

 private:
  struct Track {
    std::int64_t units = 0, intra = 0, bytes = 0;
    double seconds = 0;  // of media
  };
  double kbps(const Track& track) const;

  media::LiveInfo info_;
  Track face_, sound_;
  Track last_face_, last_sound_;
  std::int64_t last_packets_ = 0;
  double last_ = 0;
};

/// Breakdown of the latency from a line of text to a sent packet.
struct Latency {
  std::size_t lines = 0;  ///< number of lines
  double voice = 0,       ///< voice synthesis
      synthesis = 0,      ///< motion synthesis
      coding = 0,         ///< planes and packets
      sending = 0,        ///< until they were due
      waiting = 0;        ///< everything else
  double mean = 0,        ///< from the line's arrival to its first packet
      worst = 0;          ///< likewise
};
/// End point of the latency: the first moving plane, or the first packet with sound.
enum class Sign : std::uint8_t { face, sound };
/// Lines that could start at once, or that waited for another line.
enum class Turn : std::uint8_t { at_once, waited };
/// Zeros if no such line was spoken. Lines that were cancelled earlier do not count.
Latency latency_of(const std::deque<speech::LineTrace>& traces, Sign sign,
                   Turn turn = Turn::at_once);

}  // namespace animeme::live
