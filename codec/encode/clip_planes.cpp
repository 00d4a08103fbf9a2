#include "codec/encode/clip_planes_internal.h"

namespace animeme::fba::internal {

ClipPlanes::ClipPlanes(const ClipData& clip, const Decision& decision)
    : clip_(clip), decision_(decision) {}

void ClipPlanes::load(std::size_t plane) {
  for (std::size_t i = 0; i < clip_.channels.size(); ++i) {
    const std::size_t number = std::size_t(clip_.channels[i].number);
    const std::int32_t value = std::int32_t(decision_.value(clip_.channels[i], i, plane));
    (clip_.channels[i].body ? body_.value[number] : face_.value[number]) = value;
  }
  if (!clip_.viseme.empty()) {
    face_.viseme = clip_.viseme[plane];
    face_.expression = clip_.expression[plane];
    keep_legal(face_.viseme, face_.expression, fap_quant(plane));
  }
}

PlaneInput ClipPlanes::input(const Run& run, std::size_t plane) {
  load(plane);
  PlaneInput input;
  input.intra = plane == run.first;
  input.object_mask = ObjectMask((clip_.has_face ? 1 : 0) | (clip_.has_body ? 2 : 0));
  if (input.intra) input.temporal.rate = clip_.rate;
  if (plane + 1 < clip_.planes() && clip_.number[plane + 1] != clip_.number[plane] + 1) {
    input.temporal.skip = std::uint32_t(clip_.number[plane + 1] - clip_.number[plane] - 1);
  }
  input.face_settings = &run.face;
  input.body_settings = &run.body;
  face_.number = clip_.number[plane];
  input.face = &face_;
  input.body = &body_;
  return input;
}

}  // namespace animeme::fba::internal
