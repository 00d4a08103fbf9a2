#include "codec/decode/fill.h"

#include <vector>

namespace animeme::fba {

fap::GroupRules group_rules(const FaceSettings& settings) {
  fap::GroupRules rules;
  for (std::size_t group = 0; group < rules.size(); ++group) {
    rules[group] = settings.mask_type[group] == MaskType::interpolate ? fap::GroupRule::interpolate
                                                                      : fap::GroupRule::hold;
  }
  return rules;
}

Result<fap::Sequence> fill(const DecodedStream& stream, const fap::FillOptions& options) {
  // The planes that face_sequence() takes, in its order.
  std::vector<fap::GroupRules> rules;
  for (const Plane& plane : stream.planes) {
    if (!has_face(plane.object_mask)) continue;
    rules.push_back(group_rules(plane.face_settings ? *plane.face_settings : FaceSettings{}));
  }
  return fap::fill(face_sequence(stream), rules, options);
}

}  // namespace animeme::fba
