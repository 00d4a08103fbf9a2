#include "codec/decode/unit_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/decode/decoder_internal.h"
#include "codec/decode/unit_writer_internal.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/plane.h"

namespace animeme::fba {

namespace {

// Profiles (codec/bitstream.md, section 13): a face alone, or anything with a body. Level 2 is for
// more than 16 or 32 kbit/s in any second.
constexpr std::uint8_t kSimpleFaceLevel1 = 0x61;
constexpr std::uint8_t kSimpleFbaLevel1 = 0x63;
constexpr std::int64_t kFaceLevel1Rate = 16000, kFbaLevel1Rate = 32000;
constexpr std::uint32_t kMinimumTimescale = 10000;  // muxers replace coarser ones
constexpr std::uint32_t kFallbackTimescale = 90000;

struct TimeBase {
  std::uint32_t timescale = kFallbackTimescale;
  std::int64_t frame = 0;  // ticks per frame; 0: rates change, round absolute times
};

// Exact for every rate that the stream can express. Source: tools/formats/media/containers.md,
// section 1.3.
TimeBase time_base(fap::Rate rate, bool rate_changes) {
  const std::optional<CodedRate> coded = rate_changes ? std::nullopt : code_rate(rate);
  if (!coded) return {};
  TimeBase base{(16U * coded->frame_rate + coded->sixteenths) * 1000U,
                std::int64_t(16) * (coded->frequency_offset ? 1001 : 1000)};
  if (coded->sixteenths % 2 == 0) {
    base.timescale /= 16;
    base.frame /= 16;
  }
  const std::uint32_t factor = (kMinimumTimescale + base.timescale - 1) / base.timescale;
  base.timescale *= factor;
  base.frame *= factor;
  return base;
}

// The most bits in any second that begins with a plane or a unit.
template <class Time>
class Peak {
 public:
  explicit Peak(Time second) : second_(second) {}
  void add(Time time, std::int64_t bits) {
    while (!recent_.empty() && time >= recent_.front().first + second_) {
      bits_ -= recent_.front().second;
      recent_.pop_front();
    }
    recent_.emplace_back(time, bits);
    bits_ += bits;
    most_ = std::max(most_, bits_);
  }
  std::int64_t bits() const { return most_; }

 private:
  Time second_;
  std::deque<std::pair<Time, std::int64_t>> recent_;
  std::int64_t bits_ = 0;
  std::int64_t most_ = 0;
};

std::vector<std::uint8_t> configuration(std::uint8_t profile) {
  BitWriter out;
  out.start_code(kSequenceStart);
  out.bits(profile, 8);
  out.start_code(kVisualObject);
  out.bit(1);                                        // is_visual_object_identifier
  out.bits(profile >= kSimpleFbaLevel1 ? 2 : 1, 4);  // visual_object_verid
  out.bits(1, 3);                                    // visual_object_priority
  out.bits(4, 4);                                    // visual_object_type: FBA
  out.stuff();
  return out.take();
}

}  // namespace

struct UnitReader::Impl {
  ReadStreamAt source;
  std::optional<UnitSource> units;  // in place of `source`
  UnitSummary summary;
  TimeBase base;
  Decoder decoder;
  // From the plane before on, as far as the stream was read.
  std::vector<std::uint8_t> window;
  std::uint64_t window_begin = 0;  // bytes of the stream before it
  bool begun = false;
  double start = 0;  // of the first plane
  std::int64_t first_number = 0;
  AccessUnit unit;
  std::optional<AccessUnit> ahead;
  Result<void> trouble;

  // nullopt: there are no more.
  Result<std::optional<Plane>> next_plane() {
    for (;;) {
      Result<Event> event = decoder.next();
      if (event && event->kind == Event::Kind::plane) return std::optional(std::move(event->plane));
      if (event) continue;
      if (event.error().code == Code::end_of_stream) return std::optional<Plane>();
      if (event.error().code != Code::need_data) return event.error();
      if (auto done = read_on(); !done) return done.error();
    }
  }

  Result<void> read_on() {
    const std::size_t kept = window.size();
    window.resize(kept + internal::kPieceBytes);
    const Result<std::size_t> more = source(window_begin + kept, std::span(window).subspan(kept));
    window.resize(kept + (more ? *more : 0));
    if (!more) return more.error();
    decoder.push(std::span(window).subspan(kept));
    if (*more == 0) decoder.finish();
    return {};
  }

  // Bytes before this bit of the stream are over.
  void forget(std::int64_t bit) {
    const std::size_t over = std::size_t(std::uint64_t(bit) / 8 - window_begin);
    window.erase(window.begin(), window.begin() + std::ptrdiff_t(over));
    window_begin += over;
  }

  // An error is told by next().
  void rewind() {
    if (units) trouble = units->rewind();
    decoder = Decoder();
    window.clear();
    window_begin = 0;
    begun = false;
    ahead.reset();
  }

  Result<void> look() {
    Peak<double> peak(1.0);
    std::optional<fap::Rate> rate;
    bool rate_changes = false;
    bool body = false;
    for (;;) {
      const auto plane = next_plane();
      if (!plane) return plane.error();
      if (!*plane) break;
      if (!rate) rate = (*plane)->rate;
      rate_changes = rate_changes || (*plane)->rate != *rate;
      body = body || has_body((*plane)->object_mask);
      peak.add((*plane)->seconds, (*plane)->bit_end - (*plane)->bit_begin);
      if (window.size() > 2 * internal::kPieceBytes) forget((*plane)->bit_end);
    }
    if (!rate) return make_error(Code::truncated, "the stream holds no plane");
    base = time_base(*rate, rate_changes);
    const bool level2 = peak.bits() > (body ? kFbaLevel1Rate : kFaceLevel1Rate);
    summary.config = configuration(
        std::uint8_t((body ? kSimpleFbaLevel1 : kSimpleFaceLevel1) + (level2 ? 1 : 0)));
    summary.timescale = base.timescale;
    rewind();
    return {};
  }

  Result<void> add_up() {
    Peak<std::int64_t> peak(summary.timescale);
    for (;;) {
      const Result<const AccessUnit*> next_unit = next();
      if (!next_unit) return next_unit.error();
      if (*next_unit == nullptr) break;
      const AccessUnit& one = **next_unit;
      if (summary.units++ == 0) summary.first_duration = one.duration;
      summary.bytes += one.bytes.size();
      summary.largest = std::max(summary.largest, one.bytes.size());
      summary.end = one.time + one.duration;
      peak.add(one.time, 8 * std::int64_t(one.bytes.size()));
    }
    summary.peak_bits = peak.bits();
    rewind();
    return {};
  }

  Result<void> read_ahead() {
    const auto plane = next_plane();
    if (!plane) return plane.error();
    ahead.reset();
    if (!*plane) return {};
    const Plane& one = **plane;
    AccessUnit& next_unit = ahead.emplace();
    const std::int64_t before = 8 * std::int64_t(window_begin);
    next_unit.bytes =
        internal::write_unit(window, one.bit_begin - before, one.bit_end - before, !begun);
    if (window.size() > 2 * internal::kPieceBytes) forget(one.bit_end);
    next_unit.intra = one.intra;
    if (!begun) {
      start = one.seconds;
      first_number = one.number;
    }
    begun = true;
    next_unit.time = base.frame > 0 ? (one.number - first_number) * base.frame
                                    : std::llround((one.seconds - start) * base.timescale);
    // Of the last unit; of all others, until the next one.
    next_unit.duration =
        base.frame > 0 ? base.frame : std::llround(one.rate.seconds(base.timescale));
    return {};
  }

  Result<const AccessUnit*> next_of_source() {
    if (!trouble) return trouble.error();
    const Result<bool> more = units->next(unit);
    if (!more) return more.error();
    return *more ? &unit : nullptr;
  }

  Result<const AccessUnit*> next() {
    if (units) return next_of_source();
    if (!begun) {
      if (auto read = read_ahead(); !read) return read.error();
    }
    if (!ahead) return nullptr;
    unit = std::move(*ahead);
    if (auto read = read_ahead(); !read) return read.error();
    if (ahead) unit.duration = std::max<std::int64_t>(1, ahead->time - unit.time);
    return &unit;
  }
};

UnitReader::UnitReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UnitReader::UnitReader(UnitReader&&) noexcept = default;
UnitReader& UnitReader::operator=(UnitReader&&) noexcept = default;
UnitReader::~UnitReader() = default;

namespace {

ReadStreamAt from_memory(std::span<const std::uint8_t> stream) {
  return [stream](std::uint64_t offset, std::span<std::uint8_t> to) -> Result<std::size_t> {
    const auto rest = stream.subspan(std::size_t(std::min<std::uint64_t>(offset, stream.size())));
    const std::size_t count = std::min(rest.size(), to.size());
    std::copy_n(rest.begin(), count, to.begin());
    return count;
  };
}

}  // namespace

Result<UnitReader> UnitReader::open(std::span<const std::uint8_t> stream) {
  return open(from_memory(stream));
}

Result<UnitReader> UnitReader::open(ReadStreamAt read) {
  auto impl = std::make_unique<Impl>();
  impl->source = std::move(read);
  if (auto seen = impl->look(); !seen) return seen.error();
  if (auto added = impl->add_up(); !added) return added.error();
  return UnitReader(std::move(impl));
}

Result<UnitReader> UnitReader::open(std::vector<std::uint8_t> config, std::uint32_t timescale,
                                    UnitSource source) {
  auto impl = std::make_unique<Impl>();
  impl->units = std::move(source);
  impl->summary.config = std::move(config);
  impl->summary.timescale = timescale;
  impl->rewind();
  if (auto added = impl->add_up(); !added) return added.error();
  if (impl->summary.units == 0) return make_error(Code::truncated, "the face has no access units");
  return UnitReader(std::move(impl));
}

const UnitSummary& UnitReader::summary() const { return impl_->summary; }
Result<const AccessUnit*> UnitReader::next() { return impl_->next(); }
void UnitReader::rewind() { impl_->rewind(); }

Result<AccessUnits> split_access_units(std::span<const std::uint8_t> stream) {
  UnitReader::Impl reader;
  reader.source = from_memory(stream);
  if (auto seen = reader.look(); !seen) return seen.error();
  AccessUnits out;
  out.config = reader.summary.config;
  out.timescale = reader.summary.timescale;
  for (;;) {
    const Result<const AccessUnit*> unit = reader.next();
    if (!unit) return unit.error();
    if (*unit == nullptr) return out;
    out.units.push_back(**unit);
  }
}

}  // namespace animeme::fba
