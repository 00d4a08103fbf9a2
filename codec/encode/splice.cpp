#include "codec/encode/splice.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <functional>
#include <optional>
#include <utility>

#include "codec/decode/decoder_internal.h"
#include "codec/encode/plane_levels_internal.h"
#include "codec/syntax/quantise_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba {
namespace {

constexpr int kMostDetours = 40;  // around hazards, by other ranges

int quant_of(const FaceSettings& settings) { return settings.fap_quant; }
int quant_of(const BodySettings& settings) { return settings.bap_quant; }

// The FAP that receivers derive another one from, if it is not coded: mask type 2. 0: they hold it.
int derived_from(const FaceSettings& settings, const fap::Mask& coded, int fap) {
  const fap::FapInfo& info = fap::info(fap);
  if (settings.mask_type[std::size_t(info.group) - 1] != MaskType::interpolate) return 0;
  const int other_side = info.partner != 0 ? fap::info(info.partner).mirror : 0;
  for (const int from : {info.mirror, info.partner, other_side}) {
    if (coded[std::size_t(from)]) return from;
  }
  return 0;
}

// Groups of which nothing was coded.
void complete_types(FaceSettings& settings) {
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    const fap::GroupInfo& info = fap::kGroups[group];
    for (int i = 0; i < info.size; ++i) {
      const bool coded = settings.mask[std::size_t(info.first + i)];
      MaskType& type = settings.mask_type[group];
      if (coded && type == MaskType::none) type = MaskType::hold;
    }
  }
}
void complete_types(BodySettings& settings) {
  internal::guard_last_group(settings.mask);
  internal::set_mask_types(settings);
}

template <class Settings>
bool sends_all_ranges(const Settings& settings) {
  return std::all_of(settings.send_range.begin(), settings.send_range.end(), std::identity());
}

// What the planes of a source so far have left behind in one family, face or body.
template <class Settings>
struct Coded {
  explicit Coded(const internal::SlotTable& table) : coding(table) {}

  std::optional<Settings> settings;  // of the last intra plane
  internal::SlotCoding coding;       // with the ranges in force, sent or not

  void begin(const Settings& next) {
    const internal::SlotCoding before = coding;
    internal::apply_settings(before, next, coding);
    settings = next;
  }
};

// What receivers show: the values that were coded last, and those that they derive.
struct Shown {
  fap::Frame face;
  BodyFrame body;

  void take_in(const fap::Frame& frame, const FaceSettings& settings) {
    face.mask |= frame.mask;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[fap]) face.value[fap] = frame.value[fap];
    }
    if (frame.mask[1]) face.viseme = frame.viseme;
    if (frame.mask[2]) face.expression = frame.expression;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[std::size_t(fap)]) continue;
      const int from = derived_from(settings, frame.mask, fap);
      if (from != 0) face.value[std::size_t(fap)] = frame.value[std::size_t(from)];
    }
  }
  void take_in(const BodyFrame& frame) {
    body.mask |= frame.mask;
    for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
      if (frame.mask[bap]) body.value[bap] = frame.value[bap];
    }
  }
};

// What an intra plane cannot code becomes the nearest that it can: levels of another quantiser, and
// what predictive planes of a damaged stream have reached.
void hold_levels(fap::Frame& face, int fap_quant) {
  const std::int32_t step = fap_scale(fap_quant);
  for (std::int32_t* value :
       {&face.viseme.blend, &face.expression.intensity1, &face.expression.intensity2}) {
    const std::int64_t level = internal::quantise(*value, step);
    *value = step * std::int32_t(std::clamp<std::int64_t>(level, 0, blend_range(fap_quant)));
  }
  for (std::int32_t* select : {&face.viseme.select1, &face.viseme.select2}) {
    *select = std::clamp(*select, 0, internal::high_level_max(internal::kVisemeSelect1, fap_quant));
  }
  for (std::int32_t* select : {&face.expression.select1, &face.expression.select2}) {
    *select =
        std::clamp(*select, 0, internal::high_level_max(internal::kExpressionSelect1, fap_quant));
  }
}

bool same_look(const fap::Viseme& a, const fap::Viseme& b) {
  return a.select1 == b.select1 && a.select2 == b.select2 && a.blend == b.blend;
}
bool same_look(const fap::Expression& a, const fap::Expression& b) {
  return a.select1 == b.select1 && a.select2 == b.select2 && a.intensity1 == b.intensity1 &&
         a.intensity2 == b.intensity2;
}

}  // namespace

struct Splicer::Impl {
  // The decoder of a source.
  struct Source {
    Coded<FaceSettings> face{internal::face_slots()};
    Coded<BodySettings> body{internal::body_slots()};
    Shown shown;
    Plane last;
  };

  // What the encoder has in common with the encoder of the source.
  enum class State : std::uint8_t {
    nothing,  // behind a cut: its next plane has to be an intra plane
    values,   // but not the models
    all,
  };

  StreamOptions options;
  Encoder encoder;
  Source source;
  State state = State::all;
  bool cut = false;       // the time codes of the sources are wrong
  bool avoid = false;     // intra planes that are not needed
  Shown out;              // what receivers have
  fap::Rate rate{30, 1};  // likewise
  FaceSettings face;      // of the intra plane in force
  BodySettings body;
  SpliceReport report;
  std::vector<std::uint8_t> bytes, taken;

  explicit Impl(const StreamOptions& given) : options(given), encoder(given) {}

  // A cut: what is written next does not follow what was written.
  void part() {
    state = State::nothing;
    cut = true;
  }

  void see(const Plane& plane) {
    source.last = plane;
    if (has_face(plane.object_mask)) {
      if (plane.intra) source.face.begin(*plane.face_settings);
      fap::Frame& shown = source.shown.face;  // flags are events, they are not held
      shown.viseme.def = shown.expression.def = shown.expression.init_face = false;
      source.shown.take_in(plane.face, *source.face.settings);
    }
    if (plane.body) {
      if (plane.intra) source.body.begin(*plane.body_settings);
      source.shown.take_in(*plane.body);
    }
  }

  // The parameters that these settings do not code and that receivers would show otherwise than the
  // source does: those that the source holds itself, those of a source before it, which rest here,
  // and those that would be derived from them.
  fap::Mask stale(const FaceSettings& settings) const {
    fap::Mask coded = settings.mask;
    coded[1] = coded[1] || !same_look(source.shown.face.viseme, out.face.viseme);
    coded[2] = coded[2] || !same_look(source.shown.face.expression, out.face.expression);
    fap::Mask before;
    do {
      before = coded;
      for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        const int from = derived_from(settings, coded, fap);
        const std::int32_t value = from != 0 ? source.shown.face.value[std::size_t(from)]
                                             : out.face.value[std::size_t(fap)];
        if (value != source.shown.face.value[std::size_t(fap)]) coded.set(std::size_t(fap));
      }
    } while (before != coded);
    return coded & ~settings.mask;
  }
  std::bitset<kBapCount + 1> stale(const BodySettings& settings) const {
    std::bitset<kBapCount + 1> baps;
    for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
      baps[bap] = !settings.mask[bap] && source.shown.body.value[bap] != out.body.value[bap];
    }
    return baps;
  }

  // Whether an intra plane, as it is, makes everything as in the source.
  bool is_complete(const Plane& plane) const {
    return is_complete(source.face.settings, has_face(plane.object_mask)) &&
           is_complete(source.body.settings, has_body(plane.object_mask));
  }
  template <class Settings>
  bool is_complete(const std::optional<Settings>& settings, bool in_plane) const {
    if (!settings) return true;
    const bool known = in_plane ? sends_all_ranges(*settings) : state == State::values;
    return known && stale(*settings).none();
  }

  // Whether a predictive plane does what this intra plane of the source does, if its ranges hold.
  bool continues(const Plane& plane) const {
    return avoid && state != State::nothing && plane.rate == rate && !plane.temporal.time_code &&
           continues(plane.face_settings, source.face.settings, face) &&
           continues(plane.body_settings, source.body.settings, body);
  }
  template <class Settings>
  bool continues(const std::shared_ptr<const Settings>& next,
                 const std::optional<Settings>& in_source, const Settings& in_force) const {
    if (!in_source || !next) return !in_source;
    return quant_of(*next) == quant_of(in_force) && next->mask == in_force.mask &&
           next->mask_type == in_force.mask_type && next->male == in_force.male &&
           stale(*next).none();
  }

  Result<void> copy(const Plane& plane, std::optional<std::uint32_t> skip) {
    if (!plane.intra && ((has_face(plane.object_mask) && !source.face.settings) ||
                         (has_body(plane.object_mask) && !source.body.settings))) {
      return internal::invalid("a predictive plane needs an intra plane of its kind before it");
    }
    see(plane);
    return write(skip);
  }

  // The last plane of the source.
  Result<void> write(std::optional<std::uint32_t> skip) {
    const Plane& plane = source.last;
    // Without a face, or a body, the source shows none that moves.
    if (!source.face.settings && out.face.mask.any()) source.face.begin(FaceSettings());
    if (!source.body.settings && out.body.mask.any()) source.body.begin(BodySettings());
    // Nothing has been coded yet: a face at rest is long enough not to get lost.
    if (may_get_lost(plane) && families() == ObjectMask::nothing) {
      source.face.begin(FaceSettings());
      state = State::nothing;
    }
    const bool avoided = plane.intra && continues(plane);
    const bool as_it_is = !avoided && !may_get_lost(plane) &&
                          (state == State::all || (plane.intra && is_complete(plane)));
    if (as_it_is) {
      if (auto ok = put(verbatim(plane, skip)); !ok) return ok;
      state = State::all;
    } else {
      const bool follows = state != State::nothing && (!plane.intra || avoided);
      if (!follows || !write_predictive(plane, skip)) {
        if (auto ok = write_intra(plane, skip); !ok) return ok;
      }
      state = State::values;
    }
    rate = plane.rate;  // an intra plane has sent it
    if (!as_it_is) ++report.recoded;
    ++report.planes;
    keep(plane);
    return {};
  }

  PlaneInput input(ObjectMask mask, std::optional<std::uint32_t> skip) const {
    PlaneInput input;
    input.object_mask = mask;
    input.temporal.skip = skip;
    input.face = &source.shown.face;
    input.body = &source.shown.body;
    input.face_settings = &face;
    input.body_settings = &body;
    return input;
  }

  PlaneInput verbatim(const Plane& plane, std::optional<std::uint32_t> skip) {
    if (plane.intra && plane.face_settings) face = *plane.face_settings;
    if (plane.intra && plane.body_settings) body = *plane.body_settings;
    PlaneInput plain = input(plane.object_mask, skip);
    plain.intra = plane.intra;
    plain.temporal.rate = plane.temporal.rate;
    if (plane.intra && !plane.temporal.rate && plane.rate != rate) {
      plain.temporal.rate = code_rate(plane.rate);
    }
    if (!cut) plain.temporal.time_code = plane.temporal.time_code;
    return plain;
  }

  Result<void> put(const PlaneInput& plane) {
    auto ok = encoder.write(plane);
    if (ok && options.plane_start_codes == PlaneStartCodes::all) encoder.end_unit();
    return ok;
  }

  // A plane without face and body is so short that decoders take it for stuffing, where it ends a
  // byte before a start code: that of the next plane, or the end code.
  bool may_get_lost(const Plane& plane) const {
    return plane.object_mask == ObjectMask::nothing &&
           options.plane_start_codes != PlaneStartCodes::all;
  }

  // What the source has coded so far.
  ObjectMask families() const {
    return ObjectMask((source.face.settings ? 1 : 0) | (source.body.settings ? 2 : 0));
  }

  bool write_predictive(const Plane& plane, std::optional<std::uint32_t> skip) {
    const ObjectMask mask = may_get_lost(plane) ? families() : plane.object_mask;
    if (!put(input(mask, skip))) return false;
    if (!encoder.hazard()) return true;
    encoder.drop();
    return false;
  }

  // Everything of the source, with the ranges in force.
  Result<void> write_intra(const Plane& plane, std::optional<std::uint32_t> skip) {
    const ObjectMask mask = families();
    Shown shown = source.shown;
    for (int detour = 0;; ++detour) {
      PlaneInput intra = input(mask, skip);
      intra.intra = true;
      intra.temporal.rate = code_rate(plane.rate);
      intra.face = &shown.face;
      intra.body = &shown.body;
      if (source.face.settings) {
        hold_levels(shown.face, quant_of(*source.face.settings));
        face = settle(source.face, shown.face.value, false, detour);
        internal::guard_fap4(face);
      }
      if (source.body.settings) body = settle(source.body, shown.body.value, true, detour);
      if (auto ok = put(intra); !ok) return ok;
      if (!encoder.hazard() || detour == kMostDetours) return {};
      encoder.drop();
    }
  }

  // Settings with which the planes up to the next intra plane can be coded. `value`, by number,
  // becomes what the ranges hold. A detour widens the intra ranges of that many parameters.
  template <class Settings, class Values>
  Settings settle(const Coded<Settings>& coded, Values& value, bool is_body, int detour) const {
    Settings settings = *coded.settings;
    const auto held = stale(settings);
    settings.mask |= held;
    complete_types(settings);
    settings.send_range = {true, true, true, true};
    const internal::SlotTable& table = *coded.coding.table;
    const int scale = internal::scale_at(is_body, quant_of(settings));
    int rest = detour;
    for (std::size_t i = table.number.size(); i-- > 0;) {
      const std::size_t number = table.number[i];
      if (!settings.mask[number]) continue;
      const std::int64_t step = internal::step_at(is_body, table.step[i], quant_of(settings));
      const std::int64_t most = internal::level_range(internal::kMaxRange, scale);
      const std::int64_t level = std::clamp(internal::quantise(value[number], step), -most, most);
      value[number] = std::int32_t(level * step);
      const auto range = [&](std::int64_t reach, int more) {
        const int least = internal::range_number(std::max<std::int64_t>(reach, 0), scale);
        return std::uint8_t(std::min(least + more, internal::kMaxRange));
      };
      settings.range[kIntraMax][number] = range(level, rest > 0 ? 1 + detour / 8 : 0);
      settings.range[kIntraMin][number] = range(-level, 0);
      const int still = detour > 0 && rest == detour ? 1 : 0;  // see settle_face()
      --rest;
      for (const RangeKind kind : {kPredictiveMax, kPredictiveMin}) {
        settings.range[kind][number] =
            held[number] ? std::uint8_t(still) : range(coded.coding.range[kind][i], 0);
      }
    }
    return settings;
  }

  // What receivers have now, and the bytes.
  void keep(const Plane& plane) {
    out.take_in(encoder.reconstruction(), face);
    if (source.body.settings) out.take_in(encoder.body_reconstruction());
    bool differs = false;
    if (has_face(plane.object_mask) || state == State::values) {
      const fap::Frame& want = source.shown.face;
      differs = (want.mask[1] && !same_look(want.viseme, out.face.viseme)) ||
                (want.mask[2] && !same_look(want.expression, out.face.expression));
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        differs |= want.mask[fap] && out.face.mask[fap] && out.face.value[fap] != want.value[fap];
      }
    }
    if (plane.body) {
      const BodyFrame& want = source.shown.body;
      for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
        differs |= want.mask[bap] && out.body.value[bap] != want.value[bap];
      }
    }
    report.changed += differs ? 1 : 0;
    encoder.take(taken);
    bytes.insert(bytes.end(), taken.begin(), taken.end());
  }
};

Splicer::Splicer(const StreamOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Splicer::Splicer(Splicer&&) noexcept = default;
Splicer& Splicer::operator=(Splicer&&) noexcept = default;
Splicer::~Splicer() = default;

void Splicer::begin_source() {
  impl_->source = {};
  if (impl_->report.planes > 0) impl_->part();
}

void Splicer::pass(const Plane& plane) {
  impl_->see(plane);
  impl_->part();
}

void Splicer::refresh() {
  impl_->state = Impl::State::nothing;
  impl_->out = {};
}

void Splicer::avoid_intra() { impl_->avoid = true; }

Splicer Splicer::fork() const {
  Splicer fork(impl_->options);
  fork.impl_->source = impl_->source;
  fork.impl_->avoid = impl_->avoid;
  fork.impl_->part();
  return fork;
}

Result<void> Splicer::copy(const Plane& plane) { return impl_->copy(plane, plane.temporal.skip); }
Result<void> Splicer::copy(const Plane& plane, std::uint32_t skip) {
  if (skip == 0 && plane.temporal.skip != 0U) return impl_->copy(plane, std::nullopt);
  return impl_->copy(plane, skip);
}
Result<void> Splicer::copy_last(std::uint32_t skip) {
  impl_->part();
  return impl_->write(skip > 0 ? std::optional(skip) : std::nullopt);
}

Result<bool> Splicer::copy_frames(const Plane& plane, std::int64_t first, std::int64_t end,
                                  std::int64_t hold) {
  if (plane.number >= end) return false;
  const std::int64_t next = plane.number + 1 + std::int64_t(plane.temporal.skip.value_or(0));
  if (next <= first) {
    pass(plane);
    return true;
  }
  const std::int64_t begin = std::max(plane.number, first);
  const std::int64_t more = plane.number <= first ? hold : 0;
  const auto skip = std::uint32_t(std::min(next, end) - begin - 1 + more);
  if (begin > plane.number) pass(plane);
  auto ok = begin > plane.number ? copy_last(skip) : copy(plane, skip);
  if (!ok) return ok.error();
  return next < end;
}

std::vector<std::uint8_t> Splicer::take() { return std::exchange(impl_->bytes, {}); }
std::vector<std::uint8_t> Splicer::finish() {
  std::vector<std::uint8_t> all = take();
  const std::vector<std::uint8_t> rest = impl_->encoder.finish();
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

namespace {

// Takes all planes of the first stream. The bytes behind its end code; nullopt: it is damaged.
template <class Take>
std::optional<std::span<const std::uint8_t>> read_stream(std::span<const std::uint8_t> bytes,
                                                         const Take& take) {
  Decoder decoder;
  decoder.push(bytes);
  decoder.finish();
  Result<Event> event = decoder.next();
  for (; event; event = decoder.next()) {
    if (event->kind == Event::Kind::plane && !take(event->plane)) return std::nullopt;
  }
  if (event.error().code != Code::end_of_stream) return std::nullopt;
  return bytes.subspan(std::size_t(event.error().where.bit / 8));
}

}  // namespace

std::optional<JoinedStreams> join_streams(std::span<const std::uint8_t> bytes) {
  const auto behind = read_stream(bytes, [](const Plane&) { return true; });
  if (!behind || !internal::begins_stream(*behind)) return std::nullopt;
  Splicer splicer;
  JoinedStreams joined;
  while (joined.count == 0 || internal::begins_stream(bytes)) {
    splicer.begin_source();
    ++joined.count;
    const auto rest =
        read_stream(bytes, [&](const Plane& plane) { return splicer.copy(plane).has_value(); });
    if (!rest) return std::nullopt;
    bytes = *rest;
  }
  joined.stream = splicer.finish();
  return joined;
}

const SpliceReport& Splicer::report() const { return impl_->report; }

}  // namespace animeme::fba
