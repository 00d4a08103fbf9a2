#include <map>
#include <string>
#include <type_traits>

#include "codec/text/epf.h"

namespace animeme::fba {

namespace {

// The frames of a file by number, and what a receiver holds after those taken so far.
template <class Frame>
class HeldFrames {
 public:
  explicit HeldFrames(const std::vector<Frame>& frames) {
    for (const Frame& frame : frames) by_number_[frame.number] = &frame;
  }

  // Frame `number` with the last values of what it leaves out; null if there is none.
  const Frame* take(std::int64_t number) {
    const auto found = by_number_.find(number);
    if (found == by_number_.end()) return nullptr;
    const Frame& given = *found->second;
    held_.number = number;
    take_high_level(given);
    for (std::size_t i = 0; i < given.value.size(); ++i) {
      if (given.mask[i]) held_.value[i] = given.value[i];
    }
    return &held_;
  }

 private:
  void take_high_level(const Frame& given) {
    if constexpr (std::is_same_v<Frame, fap::Frame>) {
      if (given.mask[1]) held_.viseme = given.viseme;
      if (given.mask[2]) held_.expression = given.expression;
    }
  }

  std::map<std::int64_t, const Frame*> by_number_;
  Frame held_;
};

Error no_such_frame(const char* kind, std::int64_t number, const char* file, bool empty) {
  const std::string remedy = empty ? std::string(", but there is no ") + file + " file"
                                   : std::string(", which the ") + file + " file does not have";
  return make_error(Code::not_found, std::string("the EPF asks for ") + kind + " frame " +
                                         std::to_string(number) + remedy);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_epf(const fap::Sequence& clip,
                                             const std::vector<BodyFrame>& bodies,
                                             const std::vector<EpfPlane>& planes,
                                             const StreamOptions& options) {
  HeldFrames<fap::Frame> faces(clip.frames);
  HeldFrames<BodyFrame> body_frames(bodies);
  Encoder encoder(options);
  for (const EpfPlane& plane : planes) {
    PlaneInput input;
    input.intra = plane.intra;
    input.object_mask = plane.object_mask;
    input.temporal = plane.temporal;
    input.face_settings = &plane.face;
    input.body_settings = &plane.body;
    if (has_face(plane.object_mask)) {
      input.face = faces.take(plane.face_frame);
      if (input.face == nullptr) {
        return no_such_frame("face", plane.face_frame, "FAP", clip.frames.empty());
      }
    }
    if (has_body(plane.object_mask)) {
      input.body = body_frames.take(plane.body_frame);
      if (input.body == nullptr) {
        return no_such_frame("body", plane.body_frame, "BAP", bodies.empty());
      }
    }
    if (auto ok = encoder.write(input); !ok) {
      const std::int64_t frame = has_face(plane.object_mask) ? plane.face_frame : plane.body_frame;
      Error error = ok.error();
      error.message = "frame " + std::to_string(frame) + ": " + error.message;
      return error;
    }
  }
  return encoder.finish();
}

}  // namespace animeme::fba
