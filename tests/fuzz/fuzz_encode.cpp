// encode() and LiveEncoder on any clip with any options: an error that says something, or a stream
// that decodes to the clip within the quantiser and holds no false start code. Everything is
// checked again here, from the bytes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;  // NOLINT: a test

using Bytes = std::vector<std::uint8_t>;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz_encode: %s\n", what.c_str());
  std::abort();
}

// Numbers from the input; zeros when it is used up.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t(0); }
  int range(int low, int high) {
    std::uint32_t value = byte();
    if (high - low > 255) value = (value << 8) | byte();
    return low + int(value % std::uint32_t(high - low + 1));
  }
  bool one_in(int n) { return range(0, n - 1) == n - 1; }
  bool flag() { return (byte() & 1) != 0; }
  double limit() {
    constexpr double kLimits[] = {0.5,  1,     2,    5,      50,       1e4, 1e9,
                                  1e-9, 1e300, -1.0, 1e-300, INFINITY, NAN};
    return kLimits[std::size_t(one_in(8) ? range(0, 12) : range(0, 5))];
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

// How one parameter moves.
class Motion {
 public:
  /// Wild ones reach numbers that cannot be coded.
  Motion(Source& in, bool wild)
      : kind_(in.range(0, wild ? 9 : 7)), size_(in.range(0, 2000)), value_(in.range(-1860, 1860)) {}
  std::int32_t next(Source& in) {
    switch (kind_) {
      case 0:
        return 0;
      case 1:
        return std::int32_t(value_);
      case 2:
        return move(size_ - 1000);
      case 3:
        return in.range(-1860, 1860);
      case 4:
        return in.flag() ? size_ : -size_;
      case 8:
        return in.one_in(8) ? extreme(in) : std::int32_t(value_);
      case 9:
        return move(in.one_in(6) ? 10000000 : 0);
      default:
        return move(in.range(-size_ / 8, size_ / 8));
    }
  }

 private:
  static std::int32_t extreme(Source& in) {
    constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
    constexpr std::int32_t kValues[] = {kMin, kMax, kMin + 1, kMax - 1, 1860, -1860, 316201, 1861};
    return kValues[std::size_t(in.range(0, 7))];
  }
  std::int32_t move(int by) {
    value_ = std::clamp<std::int64_t>(value_ + by, std::numeric_limits<std::int32_t>::min(),
                                      std::numeric_limits<std::int32_t>::max());
    return std::int32_t(value_);
  }

  int kind_;
  int size_;
  std::int64_t value_;
};

// Frames of a face, one after the other.
class Face {
 public:
  explicit Face(Source& in) : legal_(!in.one_in(8)), dense_(in.flag()) {
    const bool wild = in.one_in(8);
    const int groups = in.range(0, 1023);
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      if ((groups >> group & 1) == 0) continue;
      for (int i = 0; i < fap::kGroups[group].size; ++i) {
        if (!in.one_in(4)) used_.set(std::size_t(fap::kGroups[group].first + i));
      }
    }
    motion_.assign(fap::kFapCount + 1, Motion(in, false));
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!used_[fap]) continue;
      const std::size_t mirror = std::size_t(fap::info(int(fap)).mirror);
      same_as_[fap] = mirror != 0 && mirror < fap && used_[mirror] && in.flag() ? mirror : 0;
      motion_[fap] = Motion(in, wild);
    }
  }
  fap::Frame next(Source& in) {
    fap::Frame frame;
    for (std::size_t fap = 1; fap <= fap::kFapCount; ++fap) {
      if (!used_[fap] || (!dense_ && in.one_in(8))) continue;
      frame.mask.set(fap);
      if (fap >= fap::kFirstLowLevel) frame.value[fap] = motion_[fap].next(in);
      if (same_as_[fap] != 0) frame.value[fap] = frame.value[same_as_[fap]];
    }
    if (used_[1]) {
      frame.viseme = {high(in, 14), high(in, 14), high(in, 63), in.one_in(8)};
    }
    if (used_[2]) {
      frame.expression = {high(in, 6),  high(in, 63), high(in, 6),
                          high(in, 63), in.one_in(8), in.one_in(8)};
    }
    return frame;
  }

 private:
  std::int32_t high(Source& in, int most) {
    if (!legal_ && in.one_in(16)) return in.flag() ? most + 1 : INT32_MIN;
    return in.one_in(4) ? most : in.range(0, most);
  }

  bool legal_;
  bool dense_;
  fap::Mask used_;
  std::vector<Motion> motion_;
  std::array<std::size_t, fap::kFapCount + 1> same_as_{};
};

// The same of a body.
class Body {
 public:
  explicit Body(Source& in) {
    const bool wild = in.one_in(8);
    for (int i = in.range(0, 12); i > 0; --i) used_.set(std::size_t(in.range(1, fba::kBapCount)));
    if (in.one_in(8)) used_.set().reset(0);
    for (std::size_t bap = 1; bap <= std::size_t(fba::kBapCount); ++bap) {
      if (used_[bap]) motion_.emplace_back(in, wild);
    }
  }
  fba::BodyFrame next(Source& in) {
    fba::BodyFrame frame;
    std::size_t at = 0;
    for (std::size_t bap = 1; bap <= std::size_t(fba::kBapCount); ++bap) {
      if (!used_[bap]) continue;
      const std::int32_t value = motion_[at++].next(in);
      if (in.one_in(16)) continue;
      frame.mask.set(bap);
      frame.value[bap] = value;
    }
    return frame;
  }

 private:
  std::bitset<fba::kBapCount + 1> used_;
  std::vector<Motion> motion_;
};

// What has been given up to now, as the encoders are to hold it.
struct Held {
  fap::Frame face;
  fba::BodyFrame body;

  void take(const fap::Frame& frame) {
    face.mask |= frame.mask;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[fap]) face.value[fap] = frame.value[fap];
    }
    // Flags are events, not states.
    face.viseme.def = face.expression.def = face.expression.init_face = false;
    if (frame.mask[1]) face.viseme = frame.viseme;
    if (frame.mask[2]) face.expression = frame.expression;
  }
  void take(const fba::BodyFrame& frame) {
    body.mask |= frame.mask;
    for (std::size_t bap = 1; bap <= std::size_t(fba::kBapCount); ++bap) {
      if (frame.mask[bap]) body.value[bap] = frame.value[bap];
    }
  }
};

bool near(std::int64_t a, std::int64_t b, std::int64_t step) { return std::abs(a - b) <= step / 2; }

void check_high_level(const fap::Frame& got, const Held& held, int quant) {
  const int step = fba::fap_scale(quant);
  // The nearest multiple of the quantiser, or the one below if that is above 63; what lies out of
  // 0..63 is refused.
  const auto same = [&](std::int32_t a, std::int32_t b) {
    return b >= 0 && b <= 63 && a >= 0 && a <= 63 && std::abs(a - b) < step;
  };
  if (got.mask[1]) {
    const fap::Viseme& a = got.viseme;
    const fap::Viseme& b = held.face.viseme;
    require(a.select1 == b.select1 && a.select2 == b.select2 && a.def == b.def &&
                same(a.blend, b.blend),
            "FAP 1 differs");
  }
  if (got.mask[2]) {
    const fap::Expression& a = got.expression;
    const fap::Expression& b = held.face.expression;
    require(a.select1 == b.select1 && a.select2 == b.select2 && a.def == b.def &&
                a.init_face == b.init_face && same(a.intensity1, b.intensity1) &&
                same(a.intensity2, b.intensity2),
            "FAP 2 differs");
  }
}

void check_face(const fap::Frame& got, const Held& held, int quant) {
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!got.mask[fap]) continue;
    const std::int64_t step =
        quant == 0 ? 1 : std::int64_t(fap::info(int(fap)).quant_step) * fba::fap_scale(quant);
    require(near(got.value[fap], held.face.value[fap], step), "a FAP differs");
  }
}

void check_body(const fba::BodyFrame& got, const Held& held, int quant) {
  for (std::size_t slot = 0; slot < fba::kBapOrder.size(); ++slot) {
    const std::size_t bap = fba::kBapOrder[slot];
    if (!got.mask[bap]) continue;
    const std::int64_t step =
        quant == 0 ? 1 : std::int64_t(fba::kBapSteps[slot]) * fba::bap_scale(quant);
    require(near(got.value[bap], held.body.value[bap], step), "a BAP differs");
  }
}

bool bit_at(const Bytes& bytes, std::size_t bit) {
  return bit < bytes.size() * 8 && (bytes[bit / 8] >> (7 - bit % 8) & 1) != 0;
}

// A start code that the decoder did not take for one, or 22 zeros from a plane's last segment into
// the 14 bits behind it.
bool has_hazard(const Bytes& bytes, const std::vector<fba::Plane>& planes, bool end_code) {
  std::set<std::size_t> real = {0};
  if (end_code) real.insert(bytes.size() * 8 - 32);
  for (const fba::Plane& plane : planes) {
    if (plane.start_code) real.insert(std::size_t(plane.bit_begin) - 32);
    const std::size_t end = std::size_t(plane.bit_end);
    std::size_t zeros = 0;
    while (!bit_at(bytes, end - 1 - zeros)) ++zeros;
    const std::size_t tail = zeros;
    while (zeros < tail + 14 && !bit_at(bytes, end + zeros - tail)) ++zeros;
    if (zeros >= 22) return true;
  }
  std::size_t zeros = 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    if (!bit_at(bytes, bit)) {
      ++zeros;
      continue;
    }
    if (zeros >= 23 && real.count(bit - 23) == 0) return true;
    zeros = 0;
  }
  return false;
}

// The segments of FAP 1 and 2, next to each other, may hold a hazard that no choice of an encoder
// changes.
bool both_high_level(const std::vector<fba::Plane>& planes) {
  return std::any_of(planes.begin(), planes.end(), [](const fba::Plane& plane) {
    return plane.face.mask[1] && plane.face.mask[2];
  });
}

// So may a parameter at the end of what can be coded: the highest symbol of the widest range is
// zeros.
bool at_the_end(const std::vector<fba::Plane>& planes) {
  return std::any_of(planes.begin(), planes.end(), [](const fba::Plane& plane) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::int64_t value = plane.face.mask[fap] ? plane.face.value[fap] : 0;
      if (std::abs(value) >= 1800LL * fap::info(int(fap)).quant_step) return true;
    }
    for (std::size_t slot = 0; plane.body && slot < fba::kBapCount; ++slot) {
      const std::int64_t value = plane.body->value[fba::kBapOrder[slot]];
      if (std::abs(value) >= 1800LL * fba::kBapSteps[slot]) return true;
    }
    return false;
  });
}

bool unavoidable(const std::vector<fba::Plane>& planes) {
  return both_high_level(planes) || at_the_end(planes);
}

void check_error(const Error& error) {
  require(error.code != Code::internal, error.message.c_str());
  require(!error.message.empty() && error.message.find('\n') == std::string::npos,
          "an error without a sentence");
}

fap::Rate rate(Source& in) {
  constexpr fap::Rate kRates[] = {{25, 1}, {30000, 1001}, {1, 16},    {4095, 16},
                                  {0, 1},  {25, 0},       {1000, 16}, {10, 3}};
  return kRates[std::size_t(in.one_in(16) ? in.range(0, 7) : in.range(0, 1))];
}

std::int64_t step_of_number(Source& in) {
  if (!in.one_in(8)) return 1;
  constexpr std::int64_t kSteps[] = {2, 3, 17, 500, 1048577, 1048578, 4294967297, INT64_MAX / 2};
  return kSteps[std::size_t(in.one_in(64) ? in.range(0, 7) : in.range(0, 3))];
}

struct Clip {
  fap::Sequence face;
  std::vector<fba::BodyFrame> body;
};

Clip make_clip(Source& in) {
  Clip clip;
  clip.face.rate = rate(in);
  Face face(in);
  Body body(in);
  const int what = in.range(0, 7);
  const std::int64_t first = in.one_in(16) ? INT64_MIN : in.one_in(8) ? -5 : 0;
  std::int64_t number = first;
  for (int i = in.range(0, 40); i > 0; --i) {
    if (what != 7 && (what < 6 || in.flag())) {
      clip.face.frames.push_back(face.next(in));
      clip.face.frames.back().number = number;
    }
    if (what > 4 && !in.one_in(8)) {
      clip.body.push_back(body.next(in));
      clip.body.back().number = number;
    }
    const std::int64_t step = step_of_number(in);
    if (number > 0 && step > INT64_MAX - number) break;
    number += step;
  }
  if (clip.face.frames.size() > 2 && in.one_in(32)) clip.face.frames[1].number = first;
  return clip;
}

fba::EncodeOptions make_options(Source& in) {
  fba::EncodeOptions options;
  options.fap_quant = in.one_in(16) ? in.range(-1, 32) : in.range(0, 8);
  options.bap_quant = in.one_in(16) ? in.range(-1, 32) : in.range(0, 8);
  options.intra_seconds = (in.one_in(4) ? in.range(-1, 20) : 0) / 25.0;
  options.stream.plane_start_codes = fba::PlaneStartCodes(in.range(0, 2));
  options.stream.old_codes = in.flag();
  options.leave_out = in.flag();
  options.extra_intra = in.flag();
  options.skip_still = in.flag();
  if (in.one_in(16)) options.max_rms = in.limit();
  if (in.one_in(16)) options.max_bits_per_second = in.limit();
  if (in.one_in(4)) options.still_below = in.limit();
  options.verify = in.flag();
  if (options.intra_seconds == 0) options.kept_ranges = in.flag();
  if (!options.kept_ranges) options.default_ranges = in.flag();
  return options;
}

bool is_lossy(const fba::EncodeOptions& options, const fba::EncodeReport& report) {
  return options.max_rms > 0 || options.max_bits_per_second > 0 || options.still_below > 0 ||
         report.limited > 0;
}

// The planes of a stream are those of the clip, held between.
void check_planes(const fba::DecodedStream& stream, const Clip& clip,
                  const fba::EncodeOptions& options, const fba::EncodeReport& report) {
  const bool lossy = is_lossy(options, report);
  auto face = clip.face.frames.begin();
  auto body = clip.body.begin();
  const auto next_number = [&] {
    std::int64_t number = INT64_MAX;
    if (face != clip.face.frames.end()) number = face->number;
    if (body != clip.body.end()) number = std::min(number, body->number);
    return number;
  };
  const std::int64_t first = next_number();
  Held held;
  const fba::Plane* shown = nullptr;
  std::size_t at = 0;
  std::size_t frames = 0;
  while (face != clip.face.frames.end() || body != clip.body.end()) {
    const std::int64_t number = next_number();
    held.take(fap::Frame{});
    if (face != clip.face.frames.end() && face->number == number) held.take(*face++);
    if (body != clip.body.end() && body->number == number) held.take(*body++);
    ++frames;
    if (at < stream.planes.size() && stream.planes[at].number == number - first) {
      shown = &stream.planes[at++];
      if (report.kept_ranges && at == 1) continue;  // coarse
      check_high_level(shown->face, held, report.fap_quant);
    } else {
      require(options.skip_still, "a frame is missing");
    }
    require(shown != nullptr, "the first frame is missing");
    if (lossy || (report.kept_ranges && at == 1)) continue;
    check_face(shown->face, held, report.fap_quant);
    if (shown->body) check_body(*shown->body, held, report.bap_quant);
  }
  require(at == stream.planes.size(), "planes that are no frames");
  require(report.planes == at && report.skipped == frames - at, "the report miscounts planes");
  if (options.leave_out) return;
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    require(!held.face.mask[fap] || stream.planes[0].face.mask[fap], "a FAP is not coded");
  }
}

// What is left out or left to the decoder comes back in fill().
void check_filled(const fba::DecodedStream& stream, const Clip& clip,
                  const fba::EncodeReport& report, bool like_public_decoder) {
  const auto filled = fba::fill(stream, {.like_public_decoder = like_public_decoder});
  if (!filled) fail(filled.error().describe());
  Held held;
  const std::int64_t first = clip.face.frames.front().number;
  for (const fap::Frame& frame : clip.face.frames) {
    held.take(frame);
    const std::size_t at = std::size_t(frame.number - first);
    require(at < filled->frames.size(), "fill() gives too few frames");
    if (at == 0 && report.kept_ranges) continue;
    fap::Frame got = filled->frames[at];
    got.mask = held.face.mask;
    check_face(got, held, report.fap_quant);
  }
}

void try_encode(Source& in) {
  const Clip clip = make_clip(in);
  const fba::EncodeOptions options = make_options(in);
  fba::EncodeReport report;
  const Result<Bytes> bytes = fba::encode(clip.face, options, clip.body, &report);
  if (!bytes) return check_error(bytes.error());
  const Result<fba::DecodedStream> stream = fba::decode(*bytes);
  if (!stream) fail(stream.error().describe());
  require(stream->warnings.empty(), "the decoder warns");
  check_planes(*stream, clip, options, report);
  const bool lossy = is_lossy(options, report);
  if (!clip.face.frames.empty() && clip.body.empty() && !lossy &&
      clip.face.frames.back().number - clip.face.frames.front().number < 1000) {
    for (const bool copies : {false, true}) {
      // A decoder that copies sides whatever the mask type may do so to what the clip leaves out.
      if (!copies || options.leave_out) check_filled(*stream, clip, report, copies);
    }
  }
  const bool as_wanted = report.limited == 0 && !report.kept_ranges;
  if (options.max_rms > 0 && options.max_bits_per_second <= 0 && options.still_below <= 0 &&
      as_wanted) {
    const double finest = 2;  // lips and angles at the finest quantiser
    require(report.rms <= std::max(options.max_rms, finest), "the error limit is not kept");
    require(report.rms_other <= std::max(options.max_rms, 1.0), "the error limit is not kept");
  }
  if (has_hazard(*bytes, stream->planes, true))
    require(report.hazards > 0, "a hazard is not reported");
  require(report.hazards == 0 || unavoidable(stream->planes), "a hazard is left");
  if (in.one_in(8)) require(*fba::encode(clip.face, options, clip.body) == *bytes, "not the same");
}

// Beyond what an intra plane can tell: it shows the nearest.
bool reaches_too_far(const Held& held, const fba::LiveOptions& options) {
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const std::int64_t most = 1800LL * fap::info(int(fap)).quant_step;
    if (options.fap_quant != 0 && std::abs(std::int64_t(held.face.value[fap])) > most) return true;
  }
  for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
    const std::int64_t most = 1800LL * fba::kBapSteps[slot];
    const std::int64_t value = held.body.value[fba::kBapOrder[slot]];
    if (options.bap_quant != 0 && std::abs(value) > most) return true;
  }
  return false;
}

void try_live(Source& in) {
  fba::LiveOptions options;
  options.rate = rate(in);
  options.fap_quant = in.one_in(16) ? in.range(-1, 32) : in.range(0, 8);
  options.bap_quant = in.one_in(16) ? in.range(-1, 32) : in.range(0, 8);
  options.intra_seconds = (in.one_in(8) ? in.range(-1, 20) : in.range(0, 20)) / 25.0;
  if (in.one_in(4)) {
    options.faps.emplace();
    for (std::size_t fap = 0; fap <= fap::kFapCount; ++fap) (*options.faps)[fap] = in.flag();
  }
  if (in.one_in(4)) {
    options.ranges.emplace();
    for (std::uint8_t& m : *options.ranges) m = std::uint8_t(in.range(0, 31));
    if (in.one_in(8)) (*options.ranges)[5] = 32;
  }
  options.old_codes = in.flag();
  options.verify = in.flag();
  const bool units_alone = !in.one_in(3);
  if (!units_alone) options.plane_start_codes = fba::PlaneStartCodes(in.range(0, 1));
  fba::LiveEncoder encoder(options);
  Face face(in);
  Face other(in);
  Body body(in);
  std::vector<Bytes> units;
  std::vector<bool> intra;
  std::vector<Held> expected;
  std::vector<std::int64_t> numbers;
  std::int64_t number = 0;
  Held held;
  for (int i = in.range(0, 60); i > 0; --i) {
    fap::Frame frame = in.one_in(16) ? other.next(in) : face.next(in);
    if (in.one_in(16)) frame.mask.reset();
    if (in.one_in(32)) frame.mask.set(0);
    const std::uint32_t skip =
        in.one_in(16) ? in.one_in(8) ? UINT32_MAX : std::uint32_t(in.range(1, 300)) : 0;
    fba::BodyFrame given = body.next(in);
    const bool with_body = in.one_in(4);
    const fap::Frame before = encoder.reconstruction();
    const bool was_intra = encoder.intra();
    const Result<Bytes> unit = encoder.write(frame, skip, with_body ? &given : nullptr);
    if (!unit) {
      check_error(unit.error());
      require(encoder.reconstruction() == before, "an error changes the reconstruction");
      require(encoder.intra() == was_intra, "an error changes what the last unit is");
      continue;
    }
    if (options.faps) frame.mask &= *options.faps;
    held.take(frame);
    if (with_body) held.take(given);
    units.push_back(*unit);
    intra.push_back(encoder.intra());
    expected.push_back(held);
    numbers.push_back(number);
    number += 1 + std::int64_t(skip);
  }
  if (units.empty()) return;
  units.push_back(encoder.finish());
  for (std::size_t from = 0; from < intra.size(); ++from) {
    if (!intra[from] || (from != 0 && !(units_alone && in.one_in(4)))) continue;
    Bytes bytes;
    for (std::size_t i = from; i < units.size(); ++i) {
      bytes.insert(bytes.end(), units[i].begin(), units[i].end());
    }
    const Result<fba::DecodedStream> stream = fba::decode(bytes);
    if (!stream) fail(stream.error().describe());
    require(stream->planes.size() == intra.size() - from, "planes are missing");
    for (std::size_t i = from; i < intra.size(); ++i) {
      const fba::Plane& plane = stream->planes[i - from];
      require(plane.intra == intra[i] && plane.number == numbers[i] - numbers[from],
              "another plane");
      require(plane.start_code || !units_alone, "a plane without a start code");
      check_high_level(plane.face, expected[i], options.fap_quant);
      if (reaches_too_far(expected[i], options)) continue;
      check_face(plane.face, expected[i], options.fap_quant);
      if (plane.body) check_body(*plane.body, expected[i], options.bap_quant);
    }
    require(unavoidable(stream->planes) || !has_hazard(bytes, stream->planes, true),
            "a hazard is left");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source in(data, size);
  if (in.flag()) {
    try_encode(in);
  } else {
    try_live(in);
  }
  return 0;
}
