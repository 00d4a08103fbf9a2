#include "codec/live.h"

#include <algorithm>
#include <deque>
#include <string>

#include "codec/clip_internal.h"
#include "codec/decoder.h"
#include "codec/encoder.h"

namespace animeme::fba {

namespace {

using internal::kMaxRange;
using internal::range_number;

constexpr int kMaxDetours = 40;
constexpr int kWarmUp = 40;  // planes

// Largest changes from plane to plane, in levels, over this period and the one before.
template <std::size_t kSize>
class Activity {
 public:
  void see(std::size_t number, std::int64_t change) {
    std::int64_t& largest = now_[number];
    largest = std::max(largest, change < 0 ? -change : change);
  }
  void next_period() {
    before_ = now_;
    now_.fill(0);
  }
  // With half as much again to spare.
  std::uint8_t range(std::size_t number, int scale) const {
    const std::int64_t largest = std::max(before_[number], now_[number]);
    return std::uint8_t(std::clamp(range_number(largest + largest / 2, scale), 1, kMaxRange));
  }

 private:
  std::array<std::int64_t, kSize> now_{};
  std::array<std::int64_t, kSize> before_{};
};

// The tightest range, and `wider` more on its upper side, or its lower one where that is full.
template <class Settings>
void set_intra_range(Settings& settings, std::size_t number, std::int64_t level, int scale,
                     int wider) {
  const auto reach = [&](std::int64_t most) {
    return std::min(range_number(std::max<std::int64_t>(most, 0), scale), kMaxRange);
  };
  const int up = reach(level);
  const int down = reach(-level);
  const int more = std::min(wider, kMaxRange - up);
  settings.range[kIntraMax][number] = std::uint8_t(up + more);
  settings.range[kIntraMin][number] = std::uint8_t(std::min(down + wider - more, kMaxRange));
}

template <class Mask>
MaskType mask_type(const Mask& mask, std::span<const std::uint16_t> group) {
  std::size_t coded = 0;
  for (const std::uint16_t number : group) coded += mask[number] ? 1 : 0;
  return coded == 0 ? MaskType::none : coded == group.size() ? MaskType::all : MaskType::hold;
}

// What a frame changes, and what is put back if it cannot be coded.
struct Memory {
  fap::Frame held;  // what was given, held where frames leave FAPs out
  BodyFrame held_body;
  bool has_body = false;
  Activity<fap::kFapCount + 1> face_activity;
  Activity<kBapCount + 1> body_activity;
  bool last_intra = false;
};

// One plane as receivers have it.
struct Shown {
  fap::Frame face;
  BodyFrame body;
};

}  // namespace

struct LiveEncoder::Impl : Memory {
  LiveOptions options;
  std::optional<CodedRate> rate;
  Encoder encoder;
  Decoder decoder;
  std::deque<Shown> expected;  // written, not yet seen from the decoder
  Shown last;

  FaceSettings face;  // of the intra plane in force
  BodySettings body;
  std::int64_t since_intra = -1;  // planes; -1: no intra plane yet
  std::int64_t planes = 0;

  explicit Impl(const LiveOptions& given)
      : options(given), encoder(StreamOptions{PlaneStartCodes::all, given.old_codes}) {
    rate = code_rate(options.rate);
  }

  Result<void> check() const {
    const auto invalid = [](const char* message) {
      return make_error(Code::invalid_argument, message);
    };
    if (!rate) return invalid("the stream cannot express this frame rate, see code_rate()");
    if (options.fap_quant < 0 || options.fap_quant > 31) return invalid("fap_quant must be 0..31");
    if (options.bap_quant < 0 || options.bap_quant > 31) return invalid("bap_quant must be 0..31");
    if (options.intra_period < 0) return invalid("the intra period must not be negative");
    if (options.ranges && *std::max_element(options.ranges->begin(), options.ranges->end()) > 31) {
      return invalid("ranges must be 0..31");
    }
    return {};
  }

  // What the frame adds to what is held.
  void take_in(const fap::Frame& frame, const BodyFrame* given_body) {
    fap::Mask mask = frame.mask;
    if (options.faps) mask &= *options.faps;
    held.mask |= mask;
    if (options.faps) held.mask = *options.faps;
    held.mask.reset(0);  // no FAP
    if (mask[1]) held.viseme = frame.viseme;
    if (mask[2]) held.expression = frame.expression;
    internal::keep_legal(held.viseme, held.expression, options.fap_quant);
    if (!mask[1]) held.viseme.def = false;
    if (!mask[2]) held.expression.def = held.expression.init_face = false;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (mask[fap]) held.value[fap] = frame.value[fap];
    }
    if (given_body == nullptr) return;
    has_body = true;
    held_body.mask |= given_body->mask;
    held_body.mask.reset(0);
    internal::guard_last_group(held_body.mask);
    for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
      if (given_body->mask[bap]) held_body.value[bap] = given_body->value[bap];
    }
  }

  std::int64_t face_step(std::size_t fap) const {
    return options.fap_quant == 0
               ? 1
               : std::int64_t(fap::info(int(fap)).quant_step) * fap_scale(options.fap_quant);
  }
  std::int64_t body_step(std::size_t slot) const {
    return options.bap_quant == 0 ? 1
                                  : std::int64_t(kBapSteps[slot]) * bap_scale(options.bap_quant);
  }

  // Changes of the held values since the last plane; before it is written.
  void observe() {
    const fap::Frame& before = last.face;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!before.mask[fap]) continue;
      face_activity.see(fap, internal::quantise(std::int64_t(held.value[fap]) - before.value[fap],
                                                face_step(fap)));
    }
    for (std::size_t slot = 0; has_body && slot < kBapOrder.size(); ++slot) {
      const std::size_t bap = kBapOrder[slot];
      if (!body.mask[bap]) continue;
      body_activity.see(
          bap, internal::quantise(std::int64_t(held_body.value[bap]) - last.body.value[bap],
                                  body_step(slot)));
    }
  }

  // What was seen says enough only after a second or two; until then the standard's range counts.
  std::uint8_t face_range(std::size_t fap) const {
    if (options.ranges) return (*options.ranges)[fap];
    const std::uint8_t seen = face_activity.range(fap, fap_scale(options.fap_quant));
    if (planes >= kWarmUp) return seen;
    const int levels = fap::info(int(fap)).default_p_range;
    return std::max(seen, std::uint8_t(std::clamp((levels + 59) / 60, 1, kMaxRange)));
  }

  std::size_t low_level_count() const { return (held.mask >> fap::kFirstLowLevel).count(); }

  // Detours widen intra ranges, of one parameter after the other: that gives other bits. `turn`
  // counts from the last coded FAP backwards, then on over the BAPs.
  int wider(std::size_t turn, int detour) const {
    const std::size_t coded = low_level_count() + (has_body ? held_body.mask.count() : 0);
    return int((std::size_t(detour) + coded - 1 - turn) / coded);
  }

  void settle_face(int detour) {
    face = {};
    std::size_t turn = low_level_count();
    face.fap_quant = options.fap_quant;
    face.send_range = {true, true, true, true};
    face.mask = held.mask;
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      std::vector<std::uint16_t> numbers;
      for (int i = 0; i < fap::kGroups[group].size; ++i) {
        numbers.push_back(std::uint16_t(fap::kGroups[group].first + i));
      }
      face.mask_type[group] = mask_type(face.mask, numbers);
    }
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!face.mask[fap]) continue;
      --turn;
      set_intra_range(face, fap, internal::quantise(held.value[fap], face_step(fap)),
                      fap_scale(options.fap_quant), wider(turn, detour));
      const std::uint8_t range = face_range(fap);
      face.range[kPredictiveMax][fap] = face.range[kPredictiveMin][fap] = range;
      // Zeros of the very last range may reach into the values behind it.
      if (turn == 0 && detour > 0 && range == 0) {
        face.range[kPredictiveMax][fap] = face.range[kPredictiveMin][fap] = 1;
      }
    }
    internal::guard_fap4(face);
  }

  void settle_body(int detour) {
    body = {};
    std::size_t turn = low_level_count();
    body.bap_quant = options.bap_quant;
    body.send_range = {true, true, true, true};
    body.mask = held_body.mask;
    std::size_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      const std::size_t size = kBodyGroupSizes[group];
      body.mask_type[group] = mask_type(body.mask, std::span(kBapOrder).subspan(slot, size));
      slot += size;
    }
    for (slot = 0; slot < kBapOrder.size(); ++slot) {
      const std::size_t bap = kBapOrder[slot];
      if (!body.mask[bap]) continue;
      const int scale = bap_scale(options.bap_quant);
      set_intra_range(body, bap, internal::quantise(held_body.value[bap], body_step(slot)), scale,
                      wider(turn++, detour));
      const std::uint8_t range =
          planes >= kWarmUp ? body_activity.range(bap, scale) : std::uint8_t(kMaxRange);
      body.range[kPredictiveMax][bap] = body.range[kPredictiveMin][bap] = range;
    }
  }

  Result<void> write_plane(bool intra, std::uint32_t skip) {
    PlaneInput plane;
    plane.intra = intra;
    plane.object_mask = has_body ? ObjectMask::face_and_body : ObjectMask::face;
    if (intra) plane.temporal.rate = rate;
    if (skip > 0) plane.temporal.skip = skip;
    plane.face = &held;
    plane.body = &held_body;
    plane.face_settings = &face;
    plane.body_settings = &body;
    auto ok = encoder.write(plane);
    if (ok) encoder.end_unit();
    return ok;
  }

  // Predictive if it can be; intra planes in other ranges until their bits hold no trap.
  Result<void> write_best(std::uint32_t skip) {
    const bool due = since_intra < 0 || held.mask != face.mask ||
                     (has_body && held_body.mask != body.mask) ||
                     (options.intra_period > 0 && since_intra >= options.intra_period);
    if (!due) {
      if (write_plane(false, skip)) {
        last_intra = false;
        if (!encoder.trap()) return {};
        encoder.drop();
      }
    }
    last_intra = true;
    for (int detour = 0;; ++detour) {
      settle_face(detour);
      if (has_body) settle_body(detour);
      if (auto ok = write_plane(true, skip); !ok) return ok;
      if (!encoder.trap() || detour == kMaxDetours) break;
      encoder.drop();
    }
    face_activity.next_period();
    body_activity.next_period();
    return {};
  }

  Result<std::vector<std::uint8_t>> write(const fap::Frame& frame, std::uint32_t skip,
                                          const BodyFrame* given_body) {
    if (auto ok = check(); !ok) return ok.error();
    const Memory before = *this;
    take_in(frame, given_body);
    if (since_intra >= 0) observe();
    if (auto ok = write_best(skip); !ok) {
      static_cast<Memory&>(*this) = before;
      since_intra = -1;  // the plane to come has to be complete in itself
      return ok.error();
    }
    since_intra = last_intra ? 1 : since_intra + 1;
    ++planes;
    last = {encoder.reconstruction(), encoder.body_reconstruction()};
    std::vector<std::uint8_t> unit = encoder.take();
    if (options.verify) {
      if (auto ok = verify(unit); !ok) return ok.error();
    }
    return unit;
  }

  bool agrees(const Plane& plane) const {
    Shown want = expected.front();
    want.face.number = plane.face.number;
    if (plane.face != want.face) return false;
    if (!plane.body) return want.body.mask.none();
    want.body.number = plane.body->number;
    return *plane.body == want.body;
  }

  // The decoder may want to look past a unit before it gives the plane away.
  Result<void> verify(const std::vector<std::uint8_t>& unit) {
    expected.push_back(last);
    decoder.push(unit);
    for (;;) {
      Result<Event> event = decoder.next();
      if (!event && event.error().code == Code::need_data) return {};
      if (event && event->kind == Event::Kind::info) continue;
      if (!event || event->kind != Event::Kind::plane || !agrees(event->plane)) {
        return make_error(Code::internal, "a unit does not decode to what was coded");
      }
      expected.pop_front();
    }
  }
};

LiveEncoder::LiveEncoder(const LiveOptions& options) : impl_(std::make_unique<Impl>(options)) {}
LiveEncoder::LiveEncoder(LiveEncoder&&) noexcept = default;
LiveEncoder& LiveEncoder::operator=(LiveEncoder&&) noexcept = default;
LiveEncoder::~LiveEncoder() = default;

Result<std::vector<std::uint8_t>> LiveEncoder::write(const fap::Frame& frame, std::uint32_t skip,
                                                     const BodyFrame* body) {
  return impl_->write(frame, skip, body);
}

std::vector<std::uint8_t> LiveEncoder::finish() { return impl_->encoder.finish(); }
const fap::Frame& LiveEncoder::reconstruction() const { return impl_->last.face; }
bool LiveEncoder::intra() const { return impl_->last_intra; }

}  // namespace animeme::fba
