#include "codec/encode/encoder.h"

#include "codec/decode/plane_reader_internal.h"
#include "codec/encode/header_writer_internal.h"
#include "codec/encode/plane_levels_internal.h"
#include "codec/encode/stream_trace_internal.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/settings_internal.h"

namespace animeme::fba {

using internal::HighLevelState;
using internal::SlotCoding;
using internal::SlotState;

namespace {

// Of a predictive plane: is_intra, fba_object_mask, skip_frames.
constexpr int kPlainHeaderBits = 4;
// skip_frames set, and number_of_frames_to_skip.
constexpr std::uint32_t kSkipNoFrames = 0b1'0000;
constexpr int kSkipNoFramesBits = 5;

}  // namespace

// Where the writing stands between planes.
struct Encoder::Place {
  BitWriter out;
  bool started = false;         // the object start code is written
  bool unit_ended = false;      // stuffing to the byte border is written
  std::size_t plane_begin = 0;  // of the last plane
  bool follows = false;         // it has no start code of its own
  bool can_grow = false;        // nor does it skip frames, which it could
};

struct Encoder::Impl : Encoder::Place {
  // One family's part of a plane, worked out before anything is written.
  struct PendingSlots {
    explicit PendingSlots(const internal::SlotTable& table) : coding(table) {}
    SlotCoding coding;  // intra planes only
    internal::SlotLevels levels;
  };

  StreamOptions options;
  std::int64_t taken_bits = 0;
  internal::StreamState state;
  fap::Frame reconstruction;
  Place taken;                  // behind the last take()
  internal::StreamTrace trace;  // of the bytes not taken yet

  // The plane that is being written; here so that nothing is allocated plane by plane.
  PendingSlots pending_face{internal::face_slots()};
  PendingSlots pending_body{internal::body_slots()};
  internal::HighLevels high_levels{};

  // The reason why a plane cannot be written, as far as that is known before it is quantised.
  std::optional<Error> objection(const PlaneInput& plane) const {
    if (unit_ended && !has_start_code(plane)) {
      return internal::invalid("after end_unit() a plane needs a start code; see StreamOptions");
    }
    if (!plane.intra && ((has_face(plane.object_mask) && !state.face.coding.valid) ||
                         (has_body(plane.object_mask) && !state.body.coding.valid))) {
      return internal::invalid("a predictive plane needs an intra plane of its kind before it");
    }
    const TemporalHeader& temporal = plane.temporal;
    const bool usual = !plane.intra && plane.face != nullptr && plane.body == nullptr &&
                       plane.object_mask == ObjectMask::face && !temporal.skip && !temporal.rate &&
                       !temporal.time_code;
    return usual ? std::nullopt : internal::objection(plane);
  }

  void write_high(bool intra, int first, int last) {
    const std::size_t begin = out.position();
    const std::size_t count = std::size_t(last - first) + 1;
    const std::int32_t* levels = &high_levels[std::size_t(first)];
    const std::int32_t* max = &state.high.max[std::size_t(first)];
    std::int32_t* value = &state.high.value[std::size_t(first)];
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t change = levels[i] * state.high.step_of(first + int(i));
      value[i] = intra ? change : value[i] + change;
    }
    SegmentEncoder segment(out);
    if (intra) {
      segment.encode(count, [=](std::size_t i) {
        return flat_interval(std::uint32_t(levels[i]), std::uint32_t(max[i] + 1));
      });
    } else {
      AdaptiveModel* models = &state.high.model[std::size_t(first)];
      segment.encode(count, [=](std::size_t i) {
        const std::uint32_t symbol = std::uint32_t(levels[i] + max[i]);
        const SymbolInterval interval = models[i].interval(symbol);
        models[i].update(symbol);
        return interval;
      });
    }
    if (segment.flush() >= internal::kManyZeros) trace.segments.push_back({begin, out.position()});
  }

  void write_slots(SlotState& slots, bool intra, const internal::SlotLevels& levels) {
    if (slots.coding.coded.empty()) {
      out.bits(1, 2);  // as flush() ends an empty segment
      return;
    }
    const std::size_t begin = out.position();
    SegmentEncoder segment(out);
    const SlotCoding& coding = slots.coding;
    const std::uint16_t* coded = coding.coded.data();
    const std::size_t count = coding.coded.size();
    const std::uint16_t* symbols = levels.symbol.data();
    if (intra) {
      segment.encode(count, [&](std::size_t i) {
        return flat_interval(symbols[i], coding.alphabet(true, coded[i]));
      });
    } else {
      AdaptiveModel* models = slots.model.data();
      segment.encode(count, [=](std::size_t i) {
        AdaptiveModel& model = models[coded[i]];
        const SymbolInterval interval = model.interval(symbols[i]);
        model.update(symbols[i]);
        return interval;
      });
    }
    for (std::size_t i = 0; i < count; ++i) slots.value[coded[i]] = levels.rec[i];
    if (segment.flush() >= internal::kManyZeros) trace.segments.push_back({begin, out.position()});
  }

  std::vector<std::uint8_t> bytes_and_rest();
  std::vector<internal::Hazard> hazards();
  void account(std::size_t bytes);  // they have been taken

  // First everything that can fail, then the bits.
  Result<void> write(const PlaneInput& plane) {
    std::optional<Error> error = objection(plane);
    if (error) return *std::move(error);
    if (has_face(plane.object_mask) && !quantise_face(plane, error)) return *std::move(error);
    if (has_body(plane.object_mask) && !quantise_body(plane, error)) return *std::move(error);
    begin_plane(plane);
    if (has_face(plane.object_mask)) write_face(plane);
    if (has_body(plane.object_mask)) write_body(plane);
    return {};
  }

  bool quantise_face(const PlaneInput& plane, std::optional<Error>& error) {
    const FaceSettings& settings = plane.intra ? *plane.face_settings : state.face_settings;
    if (plane.intra) internal::apply_settings(state.face.coding, settings, pending_face.coding);
    if (settings.mask[1] || settings.mask[2]) {
      const auto values = internal::high_level_values(*plane.face);
      const auto quantise = [&](int first, int last) {
        return internal::quantise_high(state.high, settings.fap_quant, plane.intra, first, last,
                                       values, high_levels, error);
      };
      if (settings.mask[1] && !quantise(internal::kVisemeSelect1, internal::kVisemeBlend)) {
        return false;
      }
      if (settings.mask[2] &&
          !quantise(internal::kExpressionSelect1, internal::kExpressionIntensity2)) {
        return false;
      }
    }
    const SlotCoding& coding = plane.intra ? pending_face.coding : state.face.coding;
    return coding.coded.empty() ||
           internal::quantise_slots(state.face, coding, plane.intra, plane.face->value, "FAP",
                                    pending_face.levels, error);
  }

  bool quantise_body(const PlaneInput& plane, std::optional<Error>& error) {
    if (plane.intra) {
      internal::apply_settings(state.body.coding, *plane.body_settings, pending_body.coding);
    }
    return internal::quantise_slots(
        state.body, plane.intra ? pending_body.coding : state.body.coding, plane.intra,
        plane.body->value, "BAP", pending_body.levels, error);
  }

  void start_code(std::uint32_t code) {
    trace.start_codes.push_back(out.position());
    out.start_code(code);
  }

  void stuff() {
    if (!unit_ended) {
      // Before a plane, a decoder looks past the bits up to the byte boundary; if a start code
      // follows it takes them for stuffing, whatever they are. codec/bitstream.md,
      // section 1.
      if (follows && plane_begin / 8 == out.position() / 8) lengthen_last_plane();
      out.stuff();
    }
    follows = unit_ended = false;
  }

  // Tells it to skip 0 frames, which takes it across the byte border.
  void lengthen_last_plane() {
    if (!can_grow) {
      trace.lost.push_back(plane_begin);
      return;
    }
    const int rest = int(out.position() - plane_begin) - kPlainHeaderBits;
    const std::uint32_t payload = out.take_back(rest);
    out.take_back(1);
    out.bits(kSkipNoFrames, kSkipNoFramesBits);
    out.bits(payload, rest);
    for (auto segment = trace.segments.rbegin(); segment != trace.segments.rend(); ++segment) {
      if (segment->begin < plane_begin) break;
      segment->begin += kSkipNoFramesBits - 1;
      segment->end += kSkipNoFramesBits - 1;
    }
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
    plane_begin = out.position();
    follows = !has_start_code(plane);
    can_grow = !plane.intra && !plane.temporal.skip && plane.object_mask != ObjectMask::nothing;
    if (can_grow) {  // the usual one, which skips no frames
      out.bits(std::uint32_t(plane.object_mask) << 1, kPlainHeaderBits);
      return;
    }
    out.bit(plane.intra);
    out.bits(std::uint32_t(plane.object_mask), 2);
    if (plane.object_mask != ObjectMask::nothing)
      internal::write_temporal(out, plane.intra, plane.temporal);
  }

  void write_face(const PlaneInput& plane) {
    if (plane.intra) {
      state.face_settings = *plane.face_settings;
      state.face.coding = pending_face.coding;
      state.face.reset_models();
      state.high.fap_quant = state.face_settings.fap_quant;
      state.high.reset_models();
      internal::write_face_settings(out, state.face_settings);
    }
    const fap::Mask& mask = state.face_settings.mask;
    if (plane.intra) reconstruction = {};
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
      state.body.coding = pending_body.coding;
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

// The bits of an unfinished byte with those behind them that zeros could go on in. A plane begins
// 001 at worst, and stuffing with a 0; if that is one bit alone, the zeros of a start code follow.
std::vector<std::uint8_t> Encoder::Impl::bytes_and_rest() {
  constexpr std::uint32_t kNextPlane = 0x3FFF;
  BitWriter whole = out;
  const bool may_be_stuffed = whole.position() % 8 == 7;
  whole.bits(may_be_stuffed ? 0 : kNextPlane, 16);
  return whole.bytes();
}

std::vector<internal::Hazard> Encoder::Impl::hazards() {
  return out.aligned() ? internal::find_hazards(out.bytes(), trace)
                       : internal::find_hazards(bytes_and_rest(), trace);
}

std::optional<std::string> Encoder::hazard() const {
  const auto hazards = impl_->hazards();
  if (hazards.empty()) return std::nullopt;
  constexpr const char* kSentences[] = {"the bits of a plane look like a start code at bit ",
                                        "22 zeros extend past a segment at bit ",
                                        "a start code turns a plane into stuffing at bit "};
  return kSentences[std::size_t(hazards.front().kind)] +
         std::to_string(impl_->taken_bits + std::int64_t(hazards.front().bit));
}

std::vector<std::int64_t> Encoder::hazard_bits() const {
  std::vector<std::int64_t> bits;
  for (const internal::Hazard& hazard : impl_->hazards()) {
    bits.push_back(impl_->taken_bits + std::int64_t(hazard.bit));
  }
  return bits;
}

void Encoder::drop() {
  static_cast<Place&>(*impl_) = impl_->taken;
  impl_->trace.clear();
  impl_->state.face.coding.valid = false;
  impl_->state.body.coding.valid = false;
}

std::vector<std::uint8_t> Encoder::take() {
  std::vector<std::uint8_t> bytes = impl_->out.take();
  impl_->account(bytes.size());
  return bytes;
}

void Encoder::take(std::vector<std::uint8_t>& bytes) {
  impl_->out.take(bytes);
  impl_->account(bytes.size());
}

void Encoder::Impl::account(std::size_t bytes) {
  taken_bits += std::int64_t(bytes) * 8;
  follows &= plane_begin >= bytes * 8;  // else it is long enough
  plane_begin -= bytes * 8;
  trace.clear();
  taken = *this;
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
