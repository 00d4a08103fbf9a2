// What a stream tells while it runs and when it is over.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "tools/live/sinks.h"
#include "tools/media/live/pacer.h"
#include "tools/speech/live_speaker.h"

namespace animeme::live {

class StreamReport {
 public:
  explicit StreamReport(const media::LiveInfo& info) : info_(info) {}

  void add(const media::LiveUnit& unit);
  /// "12.0 s: face 25 planes 6.2 kbit/s, ..." of the time since the last call. `now`: seconds
  /// since the begin.
  std::string line(double now, const Sinks& sinks, const media::Pacer& pacer);

  /// Sentences at the end, one a line. `traces` may be empty.
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

/// Where the milliseconds from a line of text to a sent packet went.
struct Latency {
  std::size_t lines = 0;  ///< that were not kept waiting by another line
  double voice = 0, synthesis = 0, coding = 0, sending = 0, waiting = 0;  ///< means, ms
  double mean = 0, worst = 0;                                             ///< of the whole, ms
};
enum class Sign : std::uint8_t { face, sound };
Latency latency_of(const std::deque<speech::LineTrace>& traces, Sign sign);

}  // namespace animeme::live
