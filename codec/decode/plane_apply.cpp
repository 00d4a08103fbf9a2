// Applying a parsed plane: settings, models, reconstruction.
#include <limits>

#include "codec/decode/plane_reader_internal.h"

namespace animeme::fba::internal {

namespace {

// value + change, or an error: hostile streams can walk out of 32 bits.
bool add(std::int32_t& value, std::int64_t change) {
  const std::int64_t sum = value + change;
  if (sum < std::numeric_limits<std::int32_t>::min() ||
      sum > std::numeric_limits<std::int32_t>::max()) {
    return false;
  }
  value = std::int32_t(sum);
  return true;
}

bool apply_slots(const ParsedSlots& parsed, bool intra, SlotState& state) {
  if (intra) {
    state.coding = parsed.coding;
    state.reset_models();
  }
  const SlotCoding& coding = state.coding;
  bool in_bounds = true;
  for (std::size_t i = 0; i < coding.coded.size(); ++i) {
    const std::size_t slot = coding.coded[i];
    const std::int64_t level = std::int64_t(parsed.symbols[i]) + coding.lowest_level(intra, slot);
    if (intra) state.value[slot] = 0;
    in_bounds &= add(state.value[slot], level * coding.step_of(slot));
  }
  return in_bounds;
}

bool apply_high(const ParsedPlane& plane, int first, int last, HighLevelState& high) {
  bool in_bounds = true;
  for (int which = first; which <= last; ++which) {
    const std::size_t index = std::size_t(which);
    std::int64_t level = plane.high_symbols[index];
    if (plane.intra) {
      high.value[index] = 0;
    } else {
      level -= high.max_level(which);
      high.model[index].update(plane.high_symbols[index]);
      high.model[index].expect(plane.high_symbols[index]);
    }
    in_bounds &= add(high.value[index], level * high.step_of(which));
  }
  return in_bounds;
}

bool apply_face(const ParsedPlane& plane, StreamState& state, fap::Frame& face) {
  if (plane.intra) {
    state.face_settings = plane.face_settings;
    state.high.fap_quant = plane.face_settings.fap_quant;
    state.high.reset_models();
  }
  const fap::Mask& mask = state.face_settings.mask;
  face.mask = mask;
  bool in_bounds = true;
  if (mask[1]) {
    in_bounds &= apply_high(plane, kVisemeSelect1, kVisemeBlend, state.high);
    face.viseme.def = plane.viseme_def;
  }
  if (mask[2]) {
    in_bounds &= apply_high(plane, kExpressionSelect1, kExpressionIntensity2, state.high);
    face.expression.init_face = plane.init_face;
    face.expression.def = plane.expression_def;
  }
  set_high_level_values(state.high.value, face);
  in_bounds &= apply_slots(plane.face, plane.intra, state.face);
  for (const std::uint16_t slot : state.face.coding.coded) {
    face.value[state.face.coding.table->number[slot]] = state.face.value[slot];
  }
  return in_bounds;
}

bool apply_body(const ParsedPlane& plane, StreamState& state, BodyFrame& body) {
  if (plane.intra) state.body_settings = plane.body_settings;
  body.mask = state.body_settings.mask;
  const bool in_bounds = apply_slots(plane.body, plane.intra, state.body);
  for (const std::uint16_t slot : state.body.coding.coded) {
    body.value[kBapOrder[slot]] = state.body.value[slot];
  }
  return in_bounds;
}

}  // namespace

Result<void> apply_plane(const ParsedPlane& plane, StreamState& state, fap::Frame& face,
                         BodyFrame* body) {
  bool in_bounds = true;
  if (has_face(plane.object_mask)) in_bounds &= apply_face(plane, state, face);
  if (has_body(plane.object_mask)) in_bounds &= apply_body(plane, state, *body);
  if (!in_bounds) return make_error(Code::out_of_range, "a decoded value exceeds 32 bits");
  return {};
}

}  // namespace animeme::fba::internal
