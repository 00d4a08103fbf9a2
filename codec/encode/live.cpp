#include "codec/encode/live.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "codec/decode/decoder.h"
#include "codec/encode/clip_internal.h"
#include "codec/encode/live_settings_internal.h"
#include "codec/syntax/settings_internal.h"

namespace animeme::fba {

namespace {

constexpr double kMostDelay = 60;  // seconds
constexpr int kMaxDetours = 40;
constexpr int kWarmUp = 40;  // planes: what was seen says enough only after a second or two

}  // namespace

namespace internal {
// What a frame changes, and what is put back if it cannot be coded.
struct LiveMemory {
  HeldFrame held;
  Motion motion;
  bool last_intra = false;
};
}  // namespace internal

struct LiveEncoder::Impl : internal::LiveMemory {
  LiveOptions options;
  std::optional<CodedRate> rate;
  Encoder encoder;
  Decoder decoder;
  std::vector<internal::Shown> expected;  // written, not yet seen from the decoder
  internal::Shown last;

  FaceSettings face;  // of the intra plane in force
  BodySettings body;
  std::int64_t since_intra = -1;  // frames; -1: no intra plane yet
  std::int64_t period = 0;        // likewise
  std::int64_t planes = 0;

  std::int64_t delay = 0;                      // frames
  std::deque<internal::WaitingFrame> waiting;  // for their units
  bool ended = false;                          // no more of them will come

  explicit Impl(const LiveOptions& given)
      : options(given), encoder(StreamOptions{given.plane_start_codes, given.old_codes}) {
    rate = code_rate(options.rate);
    if (rate) period = internal::period_frames(options.intra_seconds, options.rate);
    if (options.ranges) motion.ranges = *options.ranges;
    if (rate) delay = delay_frames();
  }

  std::int64_t delay_frames() const {
    const double frames = options.delay_seconds * options.rate.frames_per_second();
    return frames > 0 && frames < 1e9 ? std::llround(frames) : 0;
  }

  Result<void> check() const {
    if (!(options.delay_seconds >= 0 && options.delay_seconds <= kMostDelay)) {
      return internal::invalid("a delay must be 0 to 60 seconds");
    }
    if (!rate)
      return internal::invalid("the format cannot express this frame rate; see code_rate()");
    const auto ok =
        internal::check_numbers(options.fap_quant, options.bap_quant, options.intra_seconds);
    if (!ok) return ok;
    if (options.ranges && *std::max_element(options.ranges->begin(), options.ranges->end()) > 31) {
      return internal::invalid("ranges must be 0..31");
    }
    return {};
  }

  // Bounds of FAP 1 and 2, where they are coded.
  Result<void> check(const fap::Frame& frame) const {
    if (!options.faps) return internal::check_high_level(frame);
    fap::Frame coded = frame;
    coded.mask &= *options.faps;
    return internal::check_high_level(coded);
  }

  Result<void> write_plane(const internal::HeldFrame& shown, bool intra, std::uint32_t skip) {
    PlaneInput plane;
    plane.intra = intra;
    plane.object_mask = held.has_body ? ObjectMask::face_and_body : ObjectMask::face;
    if (intra) plane.temporal.rate = rate;
    if (skip > 0) plane.temporal.skip = skip;
    plane.face = &shown.face;
    plane.body = &shown.body;
    plane.face_settings = &face;
    plane.body_settings = &body;
    auto ok = encoder.write(plane);
    if (ok && options.plane_start_codes == PlaneStartCodes::all) encoder.end_unit();
    return ok;
  }

  // Predictive if it can be; intra planes in other ranges until their bits hold no hazard.
  Result<void> write_best(std::uint32_t skip) {
    const bool due = since_intra < 0 || held.face.mask != face.mask ||
                     (held.has_body && held.body.mask != body.mask) ||
                     (period > 0 && since_intra >= period);
    if (!due) {
      if (write_plane(held, false, skip)) {
        last_intra = false;
        if (!encoder.hazard()) return {};
        encoder.drop();
      }
    }
    last_intra = true;
    internal::HeldFrame near = held;
    internal::limit(near, options);
    const internal::Outlook outlook =
        delay > 0 ? internal::look_ahead(near, skip, waiting, period, ended, options)
                  : internal::Outlook();
    for (int detour = 0;; ++detour) {
      const bool young = planes < kWarmUp;
      face = internal::settle_face(near, motion, options, outlook, young, detour);
      if (held.has_body)
        body = internal::settle_body(near, motion, options, outlook, young, detour);
      if (auto ok = write_plane(near, true, skip); !ok) return ok;
      if (!encoder.hazard() || detour == kMaxDetours) break;
      encoder.drop();
    }
    motion.next_period();
    return {};
  }

  // Takes a frame, and writes the one whose time has come.
  Result<void> take(const fap::Frame& frame, std::vector<std::uint8_t>& unit, std::uint32_t skip,
                    const BodyFrame* given_body) {
    if (auto ok = check(); !ok) return ok;
    if (auto ok = check(frame); !ok) return ok;
    if (delay == 0) return write(frame, unit, skip, given_body);
    waiting.push_back({frame, skip, {}});
    if (given_body != nullptr) waiting.back().body = *given_body;
    if (std::int64_t(waiting.size()) > delay) return write_first(unit);
    unit.clear();
    return {};
  }

  Result<void> write_first(std::vector<std::uint8_t>& unit) {
    const internal::WaitingFrame first = std::move(waiting.front());
    waiting.pop_front();
    return write(first.face, unit, first.skip, first.body ? &*first.body : nullptr);
  }

  Result<void> write(const fap::Frame& frame, std::vector<std::uint8_t>& unit, std::uint32_t skip,
                     const BodyFrame* given_body) {
    const LiveMemory before = *this;
    held.take_in(frame, given_body, options);
    if (since_intra >= 0) motion.see(held, last, options);
    if (auto ok = write_best(skip); !ok) {
      static_cast<LiveMemory&>(*this) = before;
      since_intra = -1;  // the plane to come has to be complete in itself
      return ok;
    }
    since_intra = (last_intra ? 1 : since_intra + 1) + skip;
    ++planes;
    last = {encoder.reconstruction(), encoder.body_reconstruction()};
    encoder.take(unit);
    return options.verify ? verify(unit) : Result<void>();
  }

  bool agrees(const Plane& plane) const {
    internal::Shown want = expected.front();
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
      expected.erase(expected.begin());
    }
  }
};

LiveEncoder::LiveEncoder(const LiveOptions& options) : impl_(std::make_unique<Impl>(options)) {}
LiveEncoder::LiveEncoder(LiveEncoder&&) noexcept = default;
LiveEncoder& LiveEncoder::operator=(LiveEncoder&&) noexcept = default;
LiveEncoder::~LiveEncoder() = default;

Result<std::vector<std::uint8_t>> LiveEncoder::write(const fap::Frame& frame, std::uint32_t skip,
                                                     const BodyFrame* body) {
  std::vector<std::uint8_t> unit;
  if (auto ok = impl_->take(frame, unit, skip, body); !ok) return ok.error();
  return unit;
}

Result<void> LiveEncoder::write(const fap::Frame& frame, std::vector<std::uint8_t>& unit,
                                std::uint32_t skip, const BodyFrame* body) {
  return impl_->take(frame, unit, skip, body);
}

std::size_t LiveEncoder::held() const { return impl_->waiting.size(); }

Result<void> LiveEncoder::write_held(std::vector<std::uint8_t>& unit) {
  unit.clear();
  impl_->ended = true;
  return impl_->waiting.empty() ? Result<void>() : impl_->write_first(unit);
}

std::vector<std::uint8_t> LiveEncoder::finish() {
  std::vector<std::uint8_t> all;
  std::vector<std::uint8_t> unit;
  while (held() > 0) {
    if (write_held(unit)) all.insert(all.end(), unit.begin(), unit.end());
  }
  const std::vector<std::uint8_t> end = impl_->encoder.finish();
  all.insert(all.end(), end.begin(), end.end());
  return all;
}

const fap::Frame& LiveEncoder::reconstruction() const { return impl_->last.face; }
bool LiveEncoder::intra() const { return impl_->last_intra; }

}  // namespace animeme::fba
