#include "conformance/epf_writer.h"

#include "fap/tables.h"

namespace animeme::conformance {
namespace {

void tag(std::string& out, const char* name, std::initializer_list<std::int64_t> numbers) {
  out += name;
  for (const std::int64_t n : numbers) out += " " + std::to_string(n);
  out += "\n";
}

template <class Settings>
void ranges(std::string& out, char family, const Settings& settings, int first, int last) {
  constexpr const char* kNames[4] = {"IX", "IN", "PX", "PN"};
  for (std::size_t kind = 0; kind < 4; ++kind) {
    if (!settings.send_range[kind]) continue;
    out += family;
    out += kNames[kind];
    for (int n = first; n <= last; ++n) {
      const int limit = settings.range[kind][std::size_t(n)] * 60;
      out += " " + std::to_string(kind % 2 == 0 ? limit : -limit);
    }
    out += "\n";
  }
}

void face(std::string& out, const fba::FaceSettings& settings) {
  out += "FMT";
  for (std::size_t g = 0; g < fap::kGroupCount; ++g) {
    const int type = int(settings.mask_type[g]);
    out += " " + std::to_string(type);
    for (int i = 0; i < fap::kGroups[g].size && (type == 1 || type == 2); ++i) {
      out += settings.mask[std::size_t(fap::kGroups[g].first + i)] ? " 1" : " 0";
    }
  }
  out += "\n";
  tag(out, "FQU", {settings.fap_quant});
  ranges(out, 'F', settings, fap::kFirstLowLevel, fap::kFapCount);
}

void body(std::string& out, const fba::BodySettings& settings) {
  out += "BMT";
  std::size_t slot = 0;
  for (std::size_t g = 0; g < fba::kBodyGroupCount; ++g) {
    const int type = int(settings.mask_type[g]);
    out += " " + std::to_string(type);
    for (int i = 0; i < fba::kBodyGroupSizes[g]; ++i, ++slot) {
      if (type == 1) out += settings.mask[fba::kBapOrder[slot]] ? " 1" : " 0";
    }
  }
  out += "\n";
  tag(out, "BQU", {settings.bap_quant});
  ranges(out, 'B', settings, 1, fba::kBapCount);
}

bool expressible(const PlaneSpec& plane) {
  if (plane.object_mask == fba::ObjectMask::nothing || plane.damage != Damage::none) return false;
  if (!plane.intra || !fba::has_face(plane.object_mask)) return true;
  const fba::FaceSettings& face = plane.face;
  const bool both = face.send_range[fba::kPredictiveMax] && face.send_range[fba::kPredictiveMin];
  return !both || face.range[fba::kPredictiveMax][4] != 0 ||
         face.range[fba::kPredictiveMin][4] != 0;
}

}  // namespace

std::string write_epf(const std::vector<PlaneSpec>& planes) {
  std::string out;
  int faces = 0, bodies = 0;
  for (const PlaneSpec& plane : planes) {
    if (!expressible(plane)) return {};
    const bool has_face = fba::has_face(plane.object_mask);
    const bool has_body = fba::has_body(plane.object_mask);
    tag(out, "FBM", {int(plane.object_mask)});
    if (has_face) tag(out, "FFR", {faces++});
    if (has_body) tag(out, "BFR", {bodies++});
    tag(out, "ISI", {plane.intra});
    const fba::TemporalHeader& temporal = plane.temporal;
    if (temporal.rate) {
      tag(out, "FRR",
          {temporal.rate->frame_rate, temporal.rate->sixteenths, temporal.rate->frequency_offset});
    }
    if (temporal.time_code) {
      tag(out, "TC",
          {temporal.time_code->hours, temporal.time_code->minutes, 1, temporal.time_code->seconds});
    }
    if (temporal.skip) tag(out, "SKN", {*temporal.skip});
    if (!plane.intra) continue;
    if (has_face) face(out, plane.face);
    if (has_body) body(out, plane.body);
    tag(out, "GDR", {has_face ? plane.face.male : plane.body.male});
  }
  return out;
}

}  // namespace animeme::conformance
