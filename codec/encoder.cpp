#include "codec/encoder.h"

#include <cstdlib>

#include "codec/bits.h"
#include "codec/header_writer_internal.h"
#include "codec/plane_reader_internal.h"
#include "codec/quantise_internal.h"
#include "codec/stream_trace_internal.h"

namespace animeme::fba {

using internal::HighLevelState;
using internal::SlotCoding;
using internal::SlotState;

namespace {

// Levels of one family's coded slots, and what they reconstruct to.
struct SlotLevels {
  std::vector<std::int32_t> level;
  std::vector<std::int32_t> rec;
};

// One family's part of a plane, worked out before anything is written.
struct PendingSlots {
  explicit PendingSlots(const internal::SlotTable& table) : coding(table) {}
  SlotCoding coding;  // intra planes only
  SlotLevels levels;
};

Error value_error(const char* what, int number, std::int64_t value, std::int64_t level,
                  std::int64_t low, std::int64_t high) {
  return make_error(Code::out_of_range, std::string(what) + " " + std::to_string(number) + " = " +
                                            std::to_string(value) + " needs level " +
                                            std::to_string(level) + ", outside the range " +
                                            std::to_string(low) + ".." + std::to_string(high) +
                                            " in force; widen the range or code an intra plane");
}

Error too_large_error(const char* what, int number, std::int64_t value) {
  return make_error(Code::out_of_range,
                    std::string(what) + " " + std::to_string(number) + " = " +
                        std::to_string(value) +
                        " would be rounded to a number of more than 32 bits; use a smaller value");
}

template <class Values>
Result<void> quantise_slots(const SlotState& state, const SlotCoding& coding, bool intra,
                            const Values& values, const char* what, SlotLevels& out) {
  out.level.resize(coding.coded.size());
  out.rec.resize(coding.coded.size());
  for (std::size_t i = 0; i < coding.coded.size(); ++i) {
    const std::uint16_t slot = coding.coded[i];
    const int number = coding.table->number[slot];
    const std::int64_t value = values[std::size_t(number)];
    const std::int64_t base = intra ? 0 : state.value[slot];
    const std::int32_t step = coding.step_of(slot);
    const std::int64_t level = internal::quantise(value - base, step);
    const std::int64_t low = coding.lowest_level(intra, slot);
    const std::int64_t high = coding.highest_level(intra, slot);
    if (level < low || level > high) return value_error(what, number, value, level, low, high);
    const std::int64_t rec = base + level * step;
    if (rec != std::int32_t(rec)) return too_large_error(what, number, value);
    out.level[i] = std::int32_t(level);
    out.rec[i] = std::int32_t(rec);
  }
  return {};
}

// What the settings of an intra plane make of the coding parameters.
template <class Settings>
void apply_settings(const SlotCoding& before, const Settings& settings, int quant, int scale,
                    SlotCoding& coding) {
  coding = before;
  coding.valid = true;
  coding.scale = scale;
  coding.quantised = quant != 0;
  coding.coded.clear();
  coding.set_default_ranges();
  for (std::size_t slot = 0; slot < coding.table->number.size(); ++slot) {
    const std::size_t number = coding.table->number[slot];
    if (!settings.mask[number]) continue;
    coding.coded.push_back(std::uint16_t(slot));
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (!settings.send_range[kind]) continue;
      coding.range[kind][slot] = internal::level_range(settings.range[kind][number], scale);
    }
  }
}

template <class Settings>
bool ranges_legal(const Settings& settings) {
  for (const auto& set : settings.range) {
    for (const std::uint8_t m : set) {
      if (m > 31) return false;
    }
  }
  return true;
}

}  // namespace

struct Encoder::Impl {
  StreamOptions options;
  BitWriter out;
  std::int64_t taken_bits = 0;
  internal::StreamState state;
  fap::Frame reconstruction;
  bool started = false;         // the object start code is written
  bool unit_ended = false;      // stuffing to the byte border is written
  internal::StreamTrace trace;  // of the bytes not taken yet

  // The plane that is being written; here so that nothing is allocated plane by plane.
  PendingSlots pending_face{internal::face_slots()};
  PendingSlots pending_body{internal::body_slots()};
  std::array<std::int32_t, internal::kHighLevelCount> high_levels{};

  Result<void> check(const PlaneInput& plane) const {
    const auto invalid = [](std::string message) {
      return make_error(Code::invalid_argument, std::move(message));
    };
    const bool face = has_face(plane.object_mask);
    const bool body = has_body(plane.object_mask);
    if ((face && plane.face == nullptr) || (body && plane.body == nullptr)) {
      return invalid("a plane needs the values of what its object mask names");
    }
    if (plane.temporal.skip.value_or(0) > internal::kMaxSkip) {
      return invalid("more than a million frames in a row cannot be skipped");
    }
    if (unit_ended && !has_start_code(plane)) {
      return invalid("behind end_unit() a plane needs a start code, see StreamOptions");
    }
    if (!plane.intra) {
      if (plane.temporal.rate || plane.temporal.time_code) {
        return invalid("frame rate and time code belong into intra planes");
      }
      if ((face && !state.face.coding.valid) || (body && !state.body.coding.valid)) {
        return invalid("a predictive plane needs an intra plane of its kind before it");
      }
      return {};
    }
    if (plane.temporal.rate && !plane.temporal.rate->rate().valid()) {
      return invalid("the frame rate is 0");
    }
    if (face) {
      const FaceSettings* settings = plane.face_settings;
      if (settings == nullptr) return invalid("an intra plane needs face settings");
      if (settings->fap_quant < 0 || settings->fap_quant > 31) {
        return invalid("fap_quant must be 0..31");
      }
      if (!internal::mask_agrees(*settings)) return invalid("FAP mask and mask types disagree");
      if (!ranges_legal(*settings)) return invalid("face ranges must be 0..31");
    }
    if (body) {
      const BodySettings* settings = plane.body_settings;
      if (settings == nullptr) return invalid("an intra plane needs body settings");
      if (settings->bap_quant < 0 || settings->bap_quant > 31) {
        return invalid("bap_quant must be 0..31");
      }
      if (!internal::mask_agrees(*settings)) return invalid("BAP mask and mask types disagree");
      if (!ranges_legal(*settings)) return invalid("body ranges must be 0..31");
    }
    return {};
  }

  // Levels of FAP 1 or 2; the state is not changed.
  Result<void> quantise_high(const HighLevelState& high, bool intra, int first, int last,
                             std::span<const std::int32_t> values) {
    for (int which = first; which <= last; ++which) {
      const std::size_t index = std::size_t(which);
      const std::int64_t base = intra ? 0 : state.high.value[index];
      const std::int64_t level =
          internal::quantise(std::int64_t(values[index]) - base, high.step_of(which));
      const std::int64_t max = high.max_level(which);
      if (level > max || level < (intra ? 0 : -max)) {
        return value_error("high-level FAP", which <= internal::kVisemeBlend ? 1 : 2, values[index],
                           level, intra ? 0 : -max, max);
      }
      high_levels[index] = std::int32_t(level);
    }
    return {};
  }

  void write_high(bool intra, int first, int last) {
    HighLevelState& high = state.high;
    const auto& levels = high_levels;
    const std::size_t begin = out.position();
    SegmentEncoder segment(out);
    for (int which = first; which <= last; ++which) {
      const std::size_t index = std::size_t(which);
      const std::int32_t max = high.max_level(which);
      const std::int32_t base = intra ? 0 : high.value[index];
      if (intra) {
        segment.encode(flat_interval(std::uint32_t(levels[index]), std::uint32_t(max + 1)));
      } else {
        const std::uint32_t symbol = std::uint32_t(levels[index] + max);
        segment.encode(high.model[index].interval(symbol));
        high.model[index].update(symbol);
      }
      high.value[index] = base + levels[index] * high.step_of(which);
    }
    segment.flush();
    trace.segments.push_back({begin, out.position()});
  }

  void write_slots(SlotState& slots, bool intra, const SlotLevels& levels) {
    const std::size_t begin = out.position();
    SegmentEncoder segment(out);
    const SlotCoding& coding = slots.coding;
    for (std::size_t i = 0; i < coding.coded.size(); ++i) {
      const std::size_t slot = coding.coded[i];
      const std::uint32_t symbol =
          std::uint32_t(levels.level[i] - coding.lowest_level(intra, slot));
      if (intra) {
        segment.encode(flat_interval(symbol, coding.alphabet(true, slot)));
      } else {
        segment.encode(slots.model[slot].interval(symbol));
        slots.model[slot].update(symbol);
      }
      slots.value[slot] = levels.rec[i];
    }
    segment.flush();
    trace.segments.push_back({begin, out.position()});
  }

  // First everything that can fail, then the bits.
  Result<void> write(const PlaneInput& plane) {
    if (auto ok = check(plane); !ok) return ok;
    if (has_face(plane.object_mask)) {
      if (auto ok = quantise_face(plane); !ok) return ok;
    }
    if (has_body(plane.object_mask)) {
      if (auto ok = quantise_body(plane); !ok) return ok;
    }
    begin_plane(plane);
    if (has_face(plane.object_mask)) write_face(plane);
    if (has_body(plane.object_mask)) write_body(plane);
    return {};
  }

  Result<void> quantise_face(const PlaneInput& plane) {
    const FaceSettings& settings = plane.intra ? *plane.face_settings : state.face_settings;
    if (plane.intra) {
      apply_settings(state.face.coding, settings, settings.fap_quant, fap_scale(settings.fap_quant),
                     pending_face.coding);
    }
    HighLevelState ranges;
    ranges.fap_quant = settings.fap_quant;
    const auto values = internal::high_level_values(*plane.face);
    if (settings.mask[1]) {
      auto ok = quantise_high(ranges, plane.intra, internal::kVisemeSelect1, internal::kVisemeBlend,
                              values);
      if (!ok) return ok;
    }
    if (settings.mask[2]) {
      auto ok = quantise_high(ranges, plane.intra, internal::kExpressionSelect1,
                              internal::kExpressionIntensity2, values);
      if (!ok) return ok;
    }
    return quantise_slots(state.face, plane.intra ? pending_face.coding : state.face.coding,
                          plane.intra, plane.face->value, "FAP", pending_face.levels);
  }

  Result<void> quantise_body(const PlaneInput& plane) {
    if (plane.intra) {
      const BodySettings& settings = *plane.body_settings;
      apply_settings(state.body.coding, settings, settings.bap_quant, bap_scale(settings.bap_quant),
                     pending_body.coding);
    }
    return quantise_slots(state.body, plane.intra ? pending_body.coding : state.body.coding,
                          plane.intra, plane.body->value, "BAP", pending_body.levels);
  }

  void start_code(std::uint32_t code) {
    trace.start_codes.push_back(out.position());
    out.start_code(code);
  }

  void stuff() {
    if (!unit_ended) out.stuff();
    unit_ended = false;
  }

  bool has_start_code(const PlaneInput& plane) const {
    const PlaneStartCodes where = options.plane_start_codes;
    return where == PlaneStartCodes::all || (where == PlaneStartCodes::intra && plane.intra);
  }

  void begin_plane(const PlaneInput& plane) {
    if (!started) start_code(kObjectStart);
    started = true;
    if (has_start_code(plane)) {
      stuff();
      start_code(options.old_codes ? kOldPlaneStart : kPlaneStart);
    }
    out.bit(plane.intra);
    out.bits(std::uint32_t(plane.object_mask), 2);
    if (plane.object_mask != ObjectMask::nothing)
      internal::write_temporal(out, plane.intra, plane.temporal);
  }

  void write_face(const PlaneInput& plane) {
    if (plane.intra) {
      state.face_settings = *plane.face_settings;
      std::swap(state.face.coding, pending_face.coding);
      state.face.reset_models();
      state.high.fap_quant = state.face_settings.fap_quant;
      state.high.reset_models();
      internal::write_face_settings(out, state.face_settings);
    }
    const fap::Mask& mask = state.face_settings.mask;
    reconstruction = {};
    reconstruction.number = plane.face->number;
    reconstruction.mask = mask;
    if (mask[1]) {
      write_high(plane.intra, internal::kVisemeSelect1, internal::kVisemeBlend);
      out.bit(plane.face->viseme.def);
      reconstruction.viseme.def = plane.face->viseme.def;
    }
    if (mask[2]) {
      write_high(plane.intra, internal::kExpressionSelect1, internal::kExpressionIntensity2);
      out.bit(plane.face->expression.init_face);
      out.bit(plane.face->expression.def);
      reconstruction.expression.init_face = plane.face->expression.init_face;
      reconstruction.expression.def = plane.face->expression.def;
    }
    internal::set_high_level_values(state.high.value, reconstruction);
    write_slots(state.face, plane.intra, pending_face.levels);
    for (const std::uint16_t slot : state.face.coding.coded) {
      reconstruction.value[state.face.coding.table->number[slot]] = state.face.value[slot];
    }
  }

  void write_body(const PlaneInput& plane) {
    if (plane.intra) {
      state.body_settings = *plane.body_settings;
      std::swap(state.body.coding, pending_body.coding);
      state.body.reset_models();
      internal::write_body_settings(out, state.body_settings);
    }
    write_slots(state.body, plane.intra, pending_body.levels);
  }
};

Encoder::Encoder(const StreamOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
}
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;
Encoder::~Encoder() = default;

Result<void> Encoder::write(const PlaneInput& plane) { return impl_->write(plane); }
const fap::Frame& Encoder::reconstruction() const { return impl_->reconstruction; }
BodyFrame Encoder::body_reconstruction() const {
  BodyFrame frame;
  const SlotState& body = impl_->state.body;
  for (const std::uint16_t slot : body.coding.coded) {
    frame.mask.set(kBapOrder[slot]);
    frame.value[kBapOrder[slot]] = body.value[slot];
  }
  return frame;
}
std::int64_t Encoder::bits() const {
  return impl_->taken_bits + std::int64_t(impl_->out.position());
}

void Encoder::end_unit() {
  impl_->stuff();
  impl_->unit_ended = true;
}

std::optional<std::string> Encoder::trap() const {
  const auto traps = internal::find_traps(impl_->out.bytes(), impl_->trace);
  if (traps.empty()) return std::nullopt;
  return (traps.front().kind == internal::Trap::Kind::start_code
              ? "the bits of a plane look like a start code at bit "
              : "22 zeros reach past a segment at bit ") +
         std::to_string(impl_->taken_bits + std::int64_t(traps.front().bit));
}

std::vector<std::int64_t> Encoder::trap_bits() const {
  std::vector<std::int64_t> bits;
  for (const internal::Trap& trap : internal::find_traps(impl_->out.bytes(), impl_->trace)) {
    bits.push_back(impl_->taken_bits + std::int64_t(trap.bit));
  }
  return bits;
}

void Encoder::drop() {
  impl_->out = {};
  impl_->trace.clear();
  impl_->started = impl_->taken_bits != 0;
  impl_->unit_ended = impl_->started;
  impl_->state.face.coding.valid = false;
  impl_->state.body.coding.valid = false;
}

std::vector<std::uint8_t> Encoder::take() {
  std::vector<std::uint8_t> bytes = impl_->out.take();
  impl_->taken_bits += std::int64_t(bytes.size()) * 8;
  impl_->trace.clear();
  return bytes;
}

void Encoder::end() {
  if (!impl_->started) impl_->start_code(kObjectStart);
  impl_->started = true;
  impl_->stuff();
  impl_->start_code(kSequenceEnd);
}

std::vector<std::uint8_t> Encoder::finish() {
  end();
  return take();
}

}  // namespace animeme::fba
