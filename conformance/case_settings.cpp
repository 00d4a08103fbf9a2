// Settings of intra planes for generated cases.
#include "conformance/case_builder.h"
#include "fap/tables.h"

namespace animeme::conformance {
namespace {

template <class Settings>
void send_all(Settings& settings, int m) {
  settings.send_range.fill(true);
  for (auto& set : settings.range) set.fill(std::uint8_t(m));
}

// First slot of each body group in coding order.
std::size_t first_slot(int group) {
  std::size_t slot = 0;
  for (int g = 1; g < group; ++g) slot += fba::kBodyGroupSizes[std::size_t(g - 1)];
  return slot;
}

}  // namespace

fba::FaceSettings all_faps(int fap_quant, int m) {
  fba::FaceSettings face;
  face.fap_quant = fap_quant;
  face.mask_type.fill(fba::MaskType::all);
  face.mask.set();
  face.mask.reset(0);
  send_all(face, m);
  return face;
}

fba::FaceSettings some_faps(std::initializer_list<int> faps, int fap_quant, int m) {
  fba::FaceSettings face;
  face.fap_quant = fap_quant;
  for (const int fap : faps) {
    face.mask.set(std::size_t(fap));
    face.mask_type[std::size_t(fap::info(fap).group - 1)] = fba::MaskType::hold;
  }
  send_all(face, m);
  return face;
}

fba::BodySettings some_body_groups(std::initializer_list<int> groups, int bap_quant, int m) {
  fba::BodySettings body;
  body.bap_quant = bap_quant;
  for (const int group : groups) {
    body.mask_type[std::size_t(group - 1)] = fba::MaskType::all;
    const std::size_t first = first_slot(group);
    for (std::size_t i = 0; i < fba::kBodyGroupSizes[std::size_t(group - 1)]; ++i) {
      body.mask.set(fba::kBapOrder[first + i]);
    }
  }
  send_all(body, m);
  return body;
}

void set_type(fba::FaceSettings& face, int group, int type, Random& random) {
  const fap::GroupInfo& info = fap::kGroups[std::size_t(group - 1)];
  face.mask_type[std::size_t(group - 1)] = fba::MaskType(type);
  const int out = random.range(0, info.size - 1);  // one at least is left out by types 1 and 2
  for (int i = 0; i < info.size; ++i) {
    const bool coded = type == 3 || ((type == 1 || type == 2) && i != out && random.chance(70));
    face.mask[std::size_t(info.first + i)] = coded;
  }
}

void set_type(fba::BodySettings& body, int group, int type, Random& random) {
  body.mask_type[std::size_t(group - 1)] = fba::MaskType(type);
  const std::size_t first = first_slot(group);
  const int size = fba::kBodyGroupSizes[std::size_t(group - 1)];
  const int out = random.range(0, size - 1);
  for (int i = 0; i < size; ++i) {
    const bool coded = type == 3 || (type == 1 && i != out && random.chance(70));
    body.mask[fba::kBapOrder[first + std::size_t(i)]] = coded;
  }
}

PlaneSpec intra_face(const fba::FaceSettings& face) {
  PlaneSpec plane;
  plane.intra = true;
  plane.face = face;
  plane.temporal.rate = fba::CodedRate{25, 0, false};
  return plane;
}

PlaneSpec intra_body(const fba::BodySettings& body) {
  PlaneSpec plane = intra_face({});
  plane.object_mask = fba::ObjectMask::body;
  plane.body = body;
  return plane;
}

PlaneSpec intra_both(const fba::FaceSettings& face, const fba::BodySettings& body) {
  PlaneSpec plane = intra_face(face);
  plane.object_mask = fba::ObjectMask::face_and_body;
  plane.body = body;
  return plane;
}

PlaneSpec predictive(fba::ObjectMask object) {
  PlaneSpec plane;
  plane.object_mask = object;
  return plane;
}

}  // namespace animeme::conformance
