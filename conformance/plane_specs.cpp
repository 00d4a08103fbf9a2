// From values back to levels.
#include "conformance/analyse.h"
#include "fap/tables.h"

namespace animeme::conformance {
namespace {

class Leveller {
 public:
  PlaneSpec plane(std::span<const std::uint8_t> bytes, const fba::Plane& plane) {
    PlaneSpec spec;
    spec.intra = plane.intra;
    spec.object_mask = plane.object_mask;
    spec.temporal = plane.temporal;
    if (plane.start_code) {
      const std::uint8_t last = bytes[std::size_t(plane.bit_begin / 8) - 1];
      spec.start_code = last == (fba::kPlaneStart & 0xFF) ? StartCode::plane : StartCode::old_plane;
    }
    object_start(bytes, plane, spec);
    if (fba::has_face(plane.object_mask)) face(plane, spec);
    if (fba::has_body(plane.object_mask)) body(plane, spec);
    return spec;
  }

 private:
  // What lies behind the stuffing of the plane before, where that is no start code of a plane.
  void object_start(std::span<const std::uint8_t> bytes, const fba::Plane& plane, PlaneSpec& spec) {
    const std::size_t begin = std::size_t(last_end_ / 8 + 1),
                      end = std::size_t(plane.bit_begin / 8);
    if (last_end_ > 0 && !plane.start_code && begin + 4 <= end) {
      spec.object_start.assign(bytes.begin() + std::ptrdiff_t(begin),
                               bytes.begin() + std::ptrdiff_t(end));
    }
    last_end_ = plane.bit_end;
  }

  void face(const fba::Plane& plane, PlaneSpec& spec) {
    const fba::FaceSettings& settings = *plane.face_settings;
    if (plane.intra) spec.face = settings;
    const fap::Frame& now = plane.face;
    const fap::Viseme& v = now.viseme;
    const fap::Expression& e = now.expression;
    const std::array<std::int32_t, kHighCount> high = {
        v.select1, v.select2, v.blend, e.select1, e.intensity1, e.select2, e.intensity2};
    for (std::size_t which = 0; which < kHighCount; ++which) {
      if (!now.mask[which <= kBlend ? 1 : 2]) continue;
      const bool scaled = !is_selection(int(which)) && settings.fap_quant != 0;
      const std::int32_t step = scaled ? settings.fap_quant : 1;
      spec.high[which] = (high[which] - (plane.intra ? 0 : high_[which])) / step;
      high_[which] = high[which];
    }
    spec.viseme_def = v.def;
    spec.init_face = e.init_face;
    spec.expression_def = e.def;
    for (int n = fap::kFirstLowLevel; n <= fap::kFapCount; ++n) {
      const std::size_t fap = std::size_t(n);
      if (!now.mask[fap]) continue;
      const int step = settings.fap_quant == 0 ? 1 : settings.fap_quant * fap::info(n).quant_step;
      spec.fap[fap] = (now.value[fap] - (plane.intra ? 0 : fap_[fap])) / step;
      fap_[fap] = now.value[fap];
    }
  }

  void body(const fba::Plane& plane, PlaneSpec& spec) {
    const fba::BodySettings& settings = *plane.body_settings;
    if (plane.intra) spec.body = settings;
    const int scale = fba::kBapScale[std::size_t(settings.bap_quant)];
    for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
      const std::size_t bap = fba::kBapOrder[slot];
      if (!plane.body->mask[bap]) continue;
      const int step = scale == 0 ? 1 : fba::kBapSteps[slot] * scale;
      spec.bap[bap] = (plane.body->value[bap] - (plane.intra ? 0 : bap_[bap])) / step;
      bap_[bap] = plane.body->value[bap];
    }
  }

  std::int64_t last_end_ = 0;  // of the plane before
  std::array<std::int32_t, kHighCount> high_{};
  std::array<std::int32_t, fap::kFapCount + 1> fap_{};
  std::array<std::int32_t, fba::kBapCount + 1> bap_{};
};

}  // namespace

std::vector<PlaneSpec> plane_specs(std::span<const std::uint8_t> bytes,
                                   const fba::DecodedStream& decoded) {
  std::vector<PlaneSpec> out;
  Leveller leveller;
  out.reserve(decoded.planes.size());
  for (const fba::Plane& plane : decoded.planes) out.push_back(leveller.plane(bytes, plane));
  return out;
}

}  // namespace animeme::conformance
