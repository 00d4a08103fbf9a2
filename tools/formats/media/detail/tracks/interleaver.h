// Tracks to a muxer, in the order of their times.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/unit_reader.h"
#include "tools/formats/media/detail/sound/sound_source.h"
#include "tools/formats/media/detail/tracks/muxer.h"

namespace animeme::media {

/// One track on its way to the muxer.
class TrackFeed {
 public:
  virtual ~TrackFeed() = default;
  /// Makes the first packet ready. Error: io.
  virtual Result<void> begin() = 0;
  /// Is there a packet?
  virtual bool ready() const = 0;
  /// Of the packet that is ready.
  virtual std::int64_t time() const = 0;
  virtual AVRational time_base() const = 0;
  /// Can a reader begin with it?
  virtual bool sync() const = 0;
  /// Writes it and makes the next one ready. Error: io.
  virtual Result<void> write() = 0;
  /// End of what was written, seconds.
  virtual double end() const = 0;
  /// 0..1.
  virtual double share() const = 0;
  /// Does it have nothing for as long as it likes? Nobody waits for it.
  virtual bool sparse() const { return false; }

  /// Called by interleave() in front of each packet, when it is due; empty: nothing to do. Error:
  /// io.
  std::function<Result<void>(const TrackFeed&)> before;
};

/// All of these outlive the feed. `seconds` of sound, for share(). `number` of the face or the
/// sound in the muxer.
std::unique_ptr<TrackFeed> face_feed(Muxer& muxer, const fba::AccessUnits& face, int number = 0);
std::unique_ptr<TrackFeed> face_feed(Muxer& muxer, fba::UnitReader& units, int number = 0);
std::unique_ptr<TrackFeed> video_feed(Muxer& muxer, const EncodedVideo& video);
std::unique_ptr<TrackFeed> sound_feed(Muxer& muxer, SoundSource& sound, double seconds,
                                      int number = 0);
/// `text` as from Muxer::add_text().
std::unique_ptr<TrackFeed> text_feed(Muxer& muxer, const TextSamples& samples, int text);

struct Interleaved {
  double seconds = 0;    ///< end of the longest track
  bool stopped = false;  ///< `stop` ended it
};

/// Writes all packets. `stop` is asked when every track has half a second in the file, or
/// all of its packets; `progress` gets 0..0.999. Either may be empty. Error: io.
Result<Interleaved> interleave(std::vector<std::unique_ptr<TrackFeed>>& feeds,
                               const std::function<bool()>& stop,
                               const std::function<void(double)>& progress);

}  // namespace animeme::media
