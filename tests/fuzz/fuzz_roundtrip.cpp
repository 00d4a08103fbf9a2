// Random legal settings and values, taken from the input: what is encoded is decoded again. The
// face is what the encoder says a decoder has, the body is within half a step, headers are equal
// but for the skips of 0 frames that save short planes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/encode/encoder.h"
#include "codec/syntax/bits.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;  // NOLINT: a test

// Numbers from the input; zeros when it is used up.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  int range(int low, int high) {
    std::uint32_t value = byte();
    if (high - low > 255) value = (value << 8) | byte();
    return low + int(value % std::uint32_t(high - low + 1));
  }
  bool flag() { return (byte() & 1) != 0; }
  bool empty() const { return at_ >= size_; }

 private:
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t(0); }
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

// Ranges of the four sets: all wide, all equal, or each parameter its own; any set may be left
// out, and then its former ranges are in force.
template <class Settings>
void choose_ranges(Source& in, Settings& settings) {
  for (bool& send : settings.send_range) send = in.range(0, 7) != 0;
  const int kind = in.range(0, 2);
  for (auto& set : settings.range) {
    const std::uint8_t all = kind == 0 ? std::uint8_t(31) : std::uint8_t(in.range(0, 31));
    for (auto& m : set) m = kind == 2 ? std::uint8_t(in.range(0, 31)) : all;
  }
}

fba::FaceSettings face_settings(Source& in) {
  fba::FaceSettings face;
  face.fap_quant = in.range(0, 31);
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    face.mask_type[group] = fba::MaskType(in.range(0, 3));
    for (int i = 0; i < fap::kGroups[group].size; ++i) {
      const bool coded = face.mask_type[group] == fba::MaskType::all ||
                         (face.mask_type[group] != fba::MaskType::none && in.flag());
      face.mask[std::size_t(fap::kGroups[group].first + i)] = coded;
    }
  }
  face.male = in.flag();
  choose_ranges(in, face);
  return face;
}

fba::BodySettings body_settings(Source& in) {
  constexpr fba::MaskType kTypes[] = {fba::MaskType::none, fba::MaskType::hold, fba::MaskType::all};
  fba::BodySettings body;
  body.bap_quant = in.range(0, 31);
  std::size_t slot = 0;
  for (std::size_t group = 0; group < fba::kBodyGroupCount; ++group) {
    body.mask_type[group] = kTypes[in.range(0, 2)];
    for (int i = 0; i < fba::kBodyGroupSizes[group]; ++i, ++slot) {
      body.mask[fba::kBapOrder[slot]] = body.mask_type[group] == fba::MaskType::all ||
                                        (body.mask_type[group] == fba::MaskType::hold && in.flag());
    }
  }
  body.male = in.flag();
  choose_ranges(in, body);
  return body;
}

// How the values of a plane move: anywhere in the range, little, to the ends of the range (whose
// code is full of zeros), or without regard to ranges.
enum class Motion { anywhere, little, ends, wild };

Motion choose_motion(Source& in) {
  constexpr Motion kMotions[] = {Motion::anywhere, Motion::anywhere, Motion::little, Motion::little,
                                 Motion::ends,     Motion::ends,     Motion::ends,   Motion::wild};
  return kMotions[in.range(0, 7)];
}

// The next value of a parameter. On the grid of its quantiser and within the ranges that are sent,
// so that most planes can be coded; a range that is not sent counts as 0.
template <class Settings>
std::int32_t next_value(Source& in, Motion motion, const Settings& settings, bool intra,
                        std::size_t number, int scale, int step, std::int32_t last) {
  const auto reach = [&](fba::RangeKind kind) {
    return settings.send_range[kind] ? settings.range[kind][number] * 60 / scale : 0;
  };
  const int high = reach(intra ? fba::kIntraMax : fba::kPredictiveMax);
  const int low = -reach(intra ? fba::kIntraMin : fba::kPredictiveMin);
  int level = 0;
  switch (motion) {
    case Motion::anywhere:
      level = in.range(low, high);
      break;
    case Motion::little:
      level = std::clamp(in.range(-3, 3), low, high);
      break;
    case Motion::ends:
      level = in.range(0, 15) != 0 ? high : low;
      break;
    case Motion::wild:
      return in.range(-30000, 30000);
  }
  return (intra ? 0 : last) + level * step;
}

void move_face(Source& in, const fba::FaceSettings& settings, bool intra, fap::Frame& face) {
  const Motion motion = choose_motion(in);
  const int scale = fba::fap_scale(settings.fap_quant);
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!settings.mask[fap]) continue;
    const int step = settings.fap_quant == 0 ? 1 : fap::info(int(fap)).quant_step * scale;
    face.value[fap] = next_value(in, motion, settings, intra, fap, scale, step, face.value[fap]);
  }
  face.viseme = {in.range(0, 14), in.range(0, 14), in.range(0, 63), in.flag()};
  face.expression = {in.range(0, 6),  in.range(0, 63), in.range(0, 6),
                     in.range(0, 63), in.flag(),       in.flag()};
}

void move_body(Source& in, const fba::BodySettings& settings, bool intra, fba::BodyFrame& body) {
  const Motion motion = choose_motion(in);
  const int scale = fba::bap_scale(settings.bap_quant);
  for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
    const std::size_t bap = fba::kBapOrder[slot];
    if (!settings.mask[bap]) continue;
    const int step = settings.bap_quant == 0 ? 1 : fba::kBapSteps[slot] * scale;
    body.value[bap] = next_value(in, motion, settings, intra, bap, scale, step, body.value[bap]);
  }
}

fba::TemporalHeader temporal_header(Source& in, bool intra) {
  fba::TemporalHeader temporal;
  if (intra && in.flag()) {
    temporal.rate =
        fba::CodedRate{std::uint8_t(in.range(1, 255)), std::uint8_t(in.range(0, 15)), in.flag()};
  }
  if (intra && in.flag()) {
    temporal.time_code = fba::TimeCode{std::uint8_t(in.range(0, 23)), std::uint8_t(in.range(0, 59)),
                                       std::uint8_t(in.range(0, 59))};
  }
  if (in.range(0, 7) == 0) temporal.skip = std::uint32_t(in.range(0, 400));
  return temporal;
}

// What was written, to be found again.
struct Written {
  fba::PlaneInput input;  // its pointers are not used
  fap::Frame face;        // as reconstructed
  fba::BodyFrame body;    // as given
  fba::FaceSettings face_settings;
  fba::BodySettings body_settings;
  std::int64_t bit_begin = 0;  // start code included
  std::int64_t bit_end = 0;
  bool start_code = false;
};

bool stuffed(const std::vector<std::uint8_t>& bytes, std::size_t from, std::size_t to) {
  fba::BitReader in(bytes, from);
  bool good = in.bit() == 0;
  while (in.position() < to) good = in.bit() != 0 && good;
  return good;
}

// A plane without start code may by chance begin like stuffing and a start code. The standard
// tells an encoder to avoid that; Encoder, which writes what it is told, does not.
bool looks_like_a_start_code(const std::vector<std::uint8_t>& bytes, const Written& plane) {
  if (plane.start_code) return false;
  const std::size_t begin = std::size_t(plane.bit_begin);
  const std::size_t border = (begin / 8 + 1) * 8;
  const fba::BitReader in(bytes);
  const auto is_code = [](std::uint32_t code) {
    constexpr std::uint32_t kCodes[] = {
        fba::kPlaneStart,     fba::kOldPlaneStart, fba::kSequenceEnd,  fba::kObjectStart,
        fba::kOldObjectStart, fba::kSequenceStart, fba::kVisualObject, fba::kUserData};
    return std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
  };
  if (begin % 8 == 0 && is_code(in.peek32(begin))) return true;
  if (border >= std::size_t(plane.bit_end)) return false;
  const std::uint32_t code = in.peek32(border);
  return is_code(code) || (code >> 8 == 1 && stuffed(bytes, begin, border));
}

// It lies whole in the byte in front of a start code, where decoders take it for stuffing. Encoder
// makes such planes longer by a skip of 0 frames; those without face and body cannot have one.
bool is_endangered(const Written& plane, bool before_start_code) {
  return before_start_code && !plane.start_code && plane.bit_begin / 8 == plane.bit_end / 8;
}

// As it is in the stream, instead of as it was asked for.
void lengthen(Written& plane) {
  if (plane.input.temporal.skip) return;
  plane.input.temporal.skip = 0;
  plane.bit_end += 4;  // and the flag is there in any case
}

void compare_bodies(const Written& expected, const fba::BodyFrame& got) {
  const fba::BodySettings& settings = expected.body_settings;
  require(got.mask == settings.mask);
  for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
    const std::size_t bap = fba::kBapOrder[slot];
    if (!settings.mask[bap]) {
      require(got.value[bap] == 0);
      continue;
    }
    const int step =
        settings.bap_quant == 0 ? 1 : fba::kBapSteps[slot] * fba::bap_scale(settings.bap_quant);
    require(std::abs(got.value[bap] - expected.body.value[bap]) <= step / 2);
  }
}

void compare(const Written& expected, const fba::Plane& got) {
  require(got.intra == expected.input.intra);
  require(got.object_mask == expected.input.object_mask);
  require(got.start_code == expected.start_code && got.bit_end == expected.bit_end);
  if (got.object_mask != fba::ObjectMask::nothing) {
    require(got.temporal == expected.input.temporal);
  }
  if (fba::has_face(got.object_mask)) {
    fap::Frame face = expected.face;
    face.number = got.face.number;
    require(got.face == face);
    require(got.face_settings->mask == expected.face_settings.mask);
    require(got.face_settings->mask_type == expected.face_settings.mask_type);
    require(got.face_settings->fap_quant == expected.face_settings.fap_quant);
    require(got.face_settings->male == expected.face_settings.male);
  }
  require((got.body != nullptr) == fba::has_body(got.object_mask));
  if (got.body) {
    compare_bodies(expected, *got.body);
    require(got.body_settings->mask_type == expected.body_settings.mask_type);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source in(data, size);
  fba::StreamOptions options;
  options.plane_start_codes = fba::PlaneStartCodes(in.range(0, 2));
  options.old_codes = in.flag();
  const int objects = in.range(1, 3);
  fba::Encoder encoder(options);
  std::vector<Written> written;
  Written plane;
  fap::Frame face;
  fba::BodyFrame body;
  for (int i = 0; i < 40 && !in.empty(); ++i) {
    fba::PlaneInput& input = plane.input;
    input.intra = i == 0 || in.range(0, 9) == 0;
    input.object_mask = fba::ObjectMask(in.range(0, 15) != 0 ? objects : in.range(0, 3));
    input.temporal = temporal_header(in, input.intra);
    fba::FaceSettings new_face = plane.face_settings;
    fba::BodySettings new_body = plane.body_settings;
    const fap::Frame last_face = face;
    const fba::BodyFrame last_body = body;
    if (fba::has_face(input.object_mask)) {
      if (input.intra) new_face = face_settings(in);
      move_face(in, new_face, input.intra, face);
    }
    if (fba::has_body(input.object_mask)) {
      if (input.intra) new_body = body_settings(in);
      move_body(in, new_body, input.intra, body);
    }
    input.face = &face;
    input.body = &body;
    input.face_settings = &new_face;
    input.body_settings = &new_body;
    plane.bit_begin = encoder.bits() == 0 ? 32 : encoder.bits();
    if (!encoder.write(input)) {
      face = last_face;
      body = last_body;
      continue;
    }
    plane.bit_end = encoder.bits();
    plane.face_settings = new_face;
    plane.body_settings = new_body;
    plane.start_code = options.plane_start_codes == fba::PlaneStartCodes::all ||
                       (options.plane_start_codes == fba::PlaneStartCodes::intra && input.intra);
    plane.face = encoder.reconstruction();
    plane.body = body;
    written.push_back(plane);
  }
  if (written.empty()) return 0;
  const std::vector<std::uint8_t> stream = encoder.finish();
  for (std::size_t i = 0; i < written.size(); ++i) {
    const bool last = i + 1 == written.size();
    if (is_endangered(written[i], last || written[i + 1].start_code)) {
      if (written[i].input.object_mask == fba::ObjectMask::nothing) return 0;
      lengthen(written[i]);
    }
    if (looks_like_a_start_code(stream, written[i])) return 0;
  }
  const auto decoded = fba::decode(stream);
  require(decoded.has_value() && decoded->planes.size() == written.size());
  for (std::size_t i = 0; i < written.size(); ++i) compare(written[i], decoded->planes[i]);
  return 0;
}
