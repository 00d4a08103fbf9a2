#include <map>
#include <string>

#include "codec/epf.h"

namespace animeme::fba {

Result<std::vector<std::uint8_t>> encode_epf(const fap::Sequence& clip,
                                             const std::vector<BodyFrame>& bodies,
                                             const std::vector<EpfPlane>& planes,
                                             const StreamOptions& options) {
  std::map<std::int64_t, const fap::Frame*> face_by_number;
  for (const fap::Frame& frame : clip.frames) face_by_number[frame.number] = &frame;

  Encoder encoder(options);
  fap::Frame face;
  for (const EpfPlane& plane : planes) {
    PlaneInput input;
    input.intra = plane.intra;
    input.object_mask = plane.object_mask;
    input.temporal = plane.temporal;
    input.face_settings = &plane.face;
    input.body_settings = &plane.body;
    if (has_face(plane.object_mask)) {
      const auto found = face_by_number.find(plane.face_frame);
      if (found == face_by_number.end()) {
        return make_error(Code::not_found, "the EPF asks for face frame " +
                                               std::to_string(plane.face_frame) +
                                               ", which the FAP file does not have");
      }
      const fap::Frame& given = *found->second;
      face.number = given.number;
      if (given.mask[1]) face.viseme = given.viseme;
      if (given.mask[2]) face.expression = given.expression;
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (given.mask[fap]) face.value[fap] = given.value[fap];
      }
      input.face = &face;
    }
    if (has_body(plane.object_mask)) {
      if (plane.body_frame < 0 || std::size_t(plane.body_frame) >= bodies.size()) {
        return make_error(Code::not_found, "the EPF asks for body frame " +
                                               std::to_string(plane.body_frame) +
                                               ", which the BAP file does not have");
      }
      input.body = &bodies[std::size_t(plane.body_frame)];
    }
    if (auto ok = encoder.write(input); !ok) {
      Error error = ok.error();
      error.message = "frame " + std::to_string(plane.face_frame) + ": " + error.message;
      return error;
    }
  }
  return encoder.finish();
}

}  // namespace animeme::fba
