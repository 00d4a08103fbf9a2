// How a live face is coded: what LiveSpeaker and LiveVoice share.
#pragma once

#include <cstdint>

#include "codec/encode/live.h"
#include "dam/model/model.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/speech/talking/talking_face.h"

namespace animeme::speech {

/// For a face that has not spoken yet.
fba::LiveOptions coding_of_face(const dam::Model& model, const TalkingFace& face,
                                const fap::Rate& rate, int fap_quant, double intra_seconds);

/// Configuration and clock of a stream.
struct FaceShape {
  media::LiveInfo info;  // without sound
  std::int64_t frame_ticks = 1;
};

/// Of the stream whose first plane is the face's next frame.
Result<FaceShape> shape_of_face(const fba::LiveOptions& options, TalkingFace face);

}  // namespace animeme::speech
