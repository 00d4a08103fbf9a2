// How a live face is coded: what LiveSpeaker and LiveVoice share.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "codec/encode/live.h"
#include "dam/model/model.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/speech/talking/talking_face.h"

namespace animeme::speech {

/// For a face that has not spoken yet. `delay`: LiveOptions::delay_seconds.
fba::LiveOptions coding_of_face(const dam::Model& model, const TalkingFace& face,
                                const fap::Rate& rate, int fap_quant, double intra_seconds,
                                double delay);

/// Sound that waits for a face which is coded with a delay, so that both are sent together.
class WaitingSound {
 public:
  /// A packet that is sent at `due`, in seconds.
  void add(media::LiveUnit packet, double due) { packets_.push_back({std::move(packet), due}); }
  /// When the first of them is due; infinity: there is none.
  double next_due() const {
    return packets_.empty() ? std::numeric_limits<double>::infinity() : packets_.front().due;
  }
  /// Moves those that are due behind `units`.
  void release(double now, std::vector<media::LiveUnit>& units) {
    for (; !packets_.empty() && packets_.front().due <= now; packets_.pop_front()) {
      units.push_back(std::move(packets_.front().packet));
    }
  }

 private:
  struct Waiting {
    media::LiveUnit packet;
    double due = 0;
  };
  std::deque<Waiting> packets_;
};

/// Configuration and clock of a stream.
struct FaceShape {
  media::LiveInfo info;  // without sound
  std::int64_t frame_ticks = 1;
};

/// Of the stream whose first plane is the face's next frame.
Result<FaceShape> shape_of_face(const fba::LiveOptions& options, TalkingFace face);

}  // namespace animeme::speech
