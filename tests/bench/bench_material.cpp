#include "tests/bench/bench_material.h"

#include <algorithm>
#include <cmath>

#include "codec/decode/decoder.h"

namespace animeme::bench {

namespace {

constexpr int kPlanes = 2000;

// Writes fixed fields; used for the intra header, which both coders need as bits.
class Header {
 public:
  explicit Header(textbook::Bits& out) : out_(out) {}
  void put(std::uint32_t value, int size) { out_.put(value, size); }

  // Rate, time code and skipped frames: none.
  void temporal() { put(0, 3); }

  // The four sets of ranges (codec/bitstream.md, section 3.2) of masked parameters; groups of these
  // sizes.
  template <class Sizes, class Number>
  void ranges(const Sizes& sizes, const Number& number_of) {
    put(0xF, 4);
    for (int kind = 0; kind < 4; ++kind) {
      std::size_t slot = 0;
      for (const int size : sizes) {
        for (int i = 0; i < size; ++i, ++slot) {
          if (i % 4 == 0) put(1, 1);
          put(number_of(kind, slot), 5);
        }
      }
    }
  }

 private:
  textbook::Bits& out_;
};

textbook::Parameter parameter(int step, const std::array<int, 4>& m) {
  return {step,
          {-60 * m[fba::kIntraMin], -60 * m[fba::kPredictiveMin]},
          {60 * m[fba::kIntraMax], 60 * m[fba::kPredictiveMax]}};
}

template <class Range>
std::array<int, 4> sent(const Range& range, std::size_t number) {
  return {range[0][number], range[1][number], range[2][number], range[3][number]};
}

// All low-level FAPs, with the ranges of the settings.
Material low_level_face(std::string name, const std::vector<fap::Frame>& faces,
                        const fba::FaceSettings& ranges) {
  Material out;
  out.name = std::move(name);
  out.faces = faces;
  out.face_settings = ranges;
  fba::FaceSettings& settings = out.face_settings;
  settings.mask_type.fill(fba::MaskType::all);
  settings.mask_type[0] = fba::MaskType::none;
  settings.send_range = {true, true, true, true};
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) settings.mask.set(fap);

  Header header(out.layout.intra_header);
  header.temporal();
  header.put(1, 5);  // fap_quant
  header.put(0b100, 3);
  for (int group = 1; group < fap::kGroupCount; ++group) header.put(0b111, 3);
  header.put(0, 2);  // gender, coding type
  std::vector<int> sizes;
  for (int group = 1; group < fap::kGroupCount; ++group) {
    sizes.push_back(fap::kGroups[std::size_t(group)].size);
  }
  header.ranges(sizes, [&settings](int kind, std::size_t slot) {
    return settings.range[std::size_t(kind)][slot + fap::kFirstLowLevel];
  });
  out.layout.segment.emplace_back();
  out.layout.flags = {0};
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    out.layout.segment[0].push_back(
        parameter(fap::info(int(fap)).quant_step, sent(settings.range, fap)));
  }
  for (const fap::Frame& face : faces) {
    out.planes.emplace_back(face.value.begin() + fap::kFirstLowLevel, face.value.end());
  }
  out.stream = encode_planes(out);
  return out;
}

// Values of a plane as the textbook coder has them.
std::vector<int> values_of(const Material& material, const fba::Plane& plane) {
  std::vector<int> values;
  if (material.object_mask == fba::ObjectMask::body) {
    for (const std::uint16_t bap : fba::kBapOrder) values.push_back(plane.body->value[bap]);
  } else if (material.face_settings.mask[1]) {
    values = {plane.face.viseme.select1, plane.face.viseme.select2, plane.face.viseme.blend};
  } else {
    values.assign(plane.face.value.begin() + fap::kFirstLowLevel, plane.face.value.end());
  }
  return values;
}

}  // namespace

fap::Sequence moving_face(int frames) {
  fap::Sequence clip;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const double speed = 0.05 + 0.01 * (fap % 17);
      frame.set(fap, int(std::lround(150 * std::sin(speed * i + fap))));
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

Material wide_face() {
  fba::FaceSettings settings;
  for (auto& set : settings.range) set.fill(31);
  return low_level_face("wide", moving_face(kPlanes).frames, settings);
}

Material tight_face() {
  const std::vector<fap::Frame> faces = moving_face(kPlanes).frames;
  // The smallest multiple of 60 levels that holds every value and every difference.
  fba::FaceSettings settings;
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const int step = fap::info(int(fap)).quant_step;
    int largest = 0;
    for (const fap::Frame& face : faces) {
      largest = std::max(largest, std::abs(textbook::quantise(face.value[fap], step)));
    }
    int rec = 0;
    int change = 0;
    for (const fap::Frame& face : faces) {
      const int level = textbook::quantise(face.value[fap] - rec, step);
      if (&face != &faces.front()) change = std::max(change, std::abs(level));
      rec += level * step;
    }
    for (const auto kind : {fba::kIntraMax, fba::kIntraMin}) {
      settings.range[kind][fap] = std::uint8_t((largest + 59) / 60);
    }
    for (const auto kind : {fba::kPredictiveMax, fba::kPredictiveMin}) {
      settings.range[kind][fap] = std::uint8_t((change + 59) / 60);
    }
  }
  return low_level_face("tight", faces, settings);
}

Material visemes() {
  Material out;
  out.name = "visemes";
  out.face_settings.mask_type[0] = fba::MaskType::hold;
  out.face_settings.mask.set(1);
  Header header(out.layout.intra_header);
  header.temporal();
  header.put(1, 5);
  header.put(0b10110, 5);  // group 1: by mask, FAP 1
  for (int group = 1; group < fap::kGroupCount; ++group) header.put(0b100, 3);
  header.put(0, 6);  // gender, coding type, no ranges
  const textbook::Parameter select{1, {0, -14}, {14, 14}};
  const textbook::Parameter blend{1, {0, -63}, {63, 63}};
  out.layout.segment = {{select, select, blend}, {}};
  out.layout.flags = {1, 0};
  // A new viseme every six planes, blended over from the one before.
  for (int i = 0; i < kPlanes; ++i) {
    const int index = i / 6;
    fap::Frame frame;
    frame.number = i;
    frame.viseme = {index * 5 % 15, (index + 1) * 5 % 15, 63 - 63 * (i % 6) / 5, false};
    out.planes.push_back({frame.viseme.select1, frame.viseme.select2, frame.viseme.blend});
    out.faces.push_back(frame);
  }
  out.stream = encode_planes(out);
  return out;
}

Material body() {
  Material out;
  out.name = "body";
  out.object_mask = fba::ObjectMask::body;
  fba::BodySettings& settings = out.body_settings;
  settings.mask_type.fill(fba::MaskType::all);
  for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) settings.mask.set(bap);
  settings.send_range = {true, true, true, true};
  for (auto& set : settings.range) set.fill(31);
  out.layout.object_mask = 2;
  Header header(out.layout.intra_header);
  header.temporal();
  header.put(1, 5);
  for (int group = 0; group < fba::kBodyGroupCount; ++group) header.put(0b111, 3);
  header.put(0, 2);
  header.ranges(fba::kBodyGroupSizes, [](int, std::size_t) { return 31U; });
  out.layout.segment.emplace_back();
  out.layout.flags = {0};
  for (const int step : fba::kBapSteps) {
    out.layout.segment[0].push_back(parameter(step, {31, 31, 31, 31}));
  }
  for (int i = 0; i < kPlanes / 4; ++i) {
    fba::BodyFrame frame;
    std::vector<int> values;
    for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
      const std::uint16_t bap = fba::kBapOrder[slot];
      const double speed = 0.02 + 0.01 * (bap % 13);
      frame.value[bap] = int(std::lround(60 * fba::kBapSteps[slot] * std::sin(speed * i + bap)));
      values.push_back(frame.value[bap]);
    }
    out.bodies.push_back(frame);
    out.planes.push_back(values);
  }
  out.stream = encode_planes(out);
  return out;
}

std::vector<std::uint8_t> encode_planes(const Material& material) {
  fba::Encoder encoder;
  for (std::size_t i = 0; i < material.planes.size(); ++i) {
    fba::PlaneInput plane;
    plane.intra = i == 0;
    plane.object_mask = material.object_mask;
    plane.face_settings = &material.face_settings;
    plane.body_settings = &material.body_settings;
    if (fba::has_face(material.object_mask)) plane.face = &material.faces[i];
    if (fba::has_body(material.object_mask)) plane.body = &material.bodies[i];
    if (!encoder.write(plane)) return {};
  }
  return encoder.finish();
}

std::string check(const Material& material) {
  if (material.stream.empty()) return "the codec cannot code this";
  if (textbook::encode(material.layout, material.planes) != material.stream) {
    return "the textbook coder and the codec write different bytes";
  }
  const auto decoded = fba::decode(material.stream);
  if (!decoded) return decoded.error().describe();
  const textbook::Planes expected =
      textbook::decode(material.layout, material.stream, material.planes.size());
  if (decoded->planes.size() != expected.size()) return "planes are missing";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (values_of(material, decoded->planes[i]) != expected[i]) {
      return "the textbook coder and the codec read different values";
    }
  }
  return {};
}

}  // namespace animeme::bench
