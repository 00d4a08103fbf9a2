#include <algorithm>
#include <bit>

#include "fap/arkit.h"
#include "fap/head/detail/normals.h"
#include "tools/view/viewer/rig/fields.h"
#include "tools/view/viewer/rig/packed_rig.h"

namespace animeme::viewer::detail {
namespace {

using head::Vec3;

// The reading archive of fields.h. Past the end it returns 0, and good() is false.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// All was there, and nothing more.
  bool done() const { return good_ && at_ == bytes_.size(); }

  template <class Number>
  void whole(Number& value) {
    const std::int64_t read = zigzag();
    value = Number(read);
    good_ = good_ && std::int64_t(value) == read;
  }
  void number(float& value) { value = std::bit_cast<float>(u32()); }
  void number(double& value) {
    const std::uint64_t low = u32();
    value = std::bit_cast<double>(std::uint64_t(u32()) << 32 | low);
  }
  void flag(bool& value) { value = u8() != 0; }
  void choice(head::Part& part) {
    const std::uint64_t value = varint();
    good_ = good_ && value < std::uint64_t(head::kPartCount);
    part = good_ ? head::Part(value) : head::Part::skin;
  }
  void perhaps(std::optional<int>& value) {
    if (u8() != 0) whole(value.emplace());
  }
  void vector(Vec3& v) {
    for (float* value : {&v.x, &v.y, &v.z}) number(*value);
  }

  template <class List, class Each>
  void list(List& items, Each each) {
    items.resize(count());
    for (auto& item : items) each(item);
  }

  void places(std::vector<Vec3>& places) {
    places.resize(count(6));
    Vec3 low;
    float step = 0;
    vector(low);
    number(step);
    for (float Vec3::*axis : kAxes) {
      for (Vec3& p : places) p.*axis = low.*axis + float(u16()) * step;
    }
  }

  void triangles(std::vector<head::Triangle>& triangles, std::size_t vertices) {
    triangles.resize(count(3));
    std::int64_t last = 0;
    for (head::Triangle& triangle : triangles) {
      for (std::uint32_t& vertex : triangle) vertex = index(last, vertices);
    }
  }

  void indices(std::vector<std::uint32_t>& list) {
    list.resize(count());
    std::int64_t last = 0;
    for (std::uint32_t& vertex : list) vertex = index(last, std::size_t(1) << 31);
  }

  void deltas(std::vector<Vec3>& deltas, std::size_t size) {
    deltas.resize(size);
    for (float Vec3::*axis : kAxes) {
      float step = 0;
      number(step);
      if (step == 0) continue;
      for (Vec3& d : deltas) d.*axis = float(std::int16_t(u16())) * step;
    }
  }

  void frame(fap::Frame& frame) {
    for (std::size_t left = count(2); left > 0; --left) {
      std::uint32_t f = 0;
      std::int32_t value = 0;
      whole(f);
      whole(value);
      if (f >= std::uint32_t(fap::kFirstLowLevel) && f < frame.value.size()) {
        frame.set(int(f), value);
      } else {
        good_ = false;
      }
    }
  }

  void shares(std::vector<float>& shares) {
    shares.resize(count(2));
    for (float& share : shares) share = float(u16()) / 65535;
  }

  void runs(Flags& flags) {
    const std::uint64_t size = varint();
    if (size > kMostFlags) good_ = false;
    for (bool value = true; good_ && flags.size() < size; value = !value) {
      const std::uint64_t run = varint();
      if (run > size - flags.size()) good_ = false;
      if (good_) flags.insert(flags.end(), std::size_t(run), value);
    }
  }

 private:
  static constexpr float Vec3::*kAxes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
  static constexpr std::uint64_t kMostFlags = 1 << 24;

  std::uint8_t u8() {
    if (at_ >= bytes_.size()) good_ = false;
    return good_ ? bytes_[at_++] : 0;
  }
  std::uint32_t u16() {
    const std::uint32_t low = u8();
    return low | std::uint32_t(u8()) << 8;
  }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    return low | u16() << 16;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t byte = u8();
      value |= std::uint64_t(byte & 0x7F) << shift;
      if (byte < 0x80) return value;
    }
    good_ = false;
    return 0;
  }
  std::int64_t zigzag() {
    const std::uint64_t value = varint();
    return std::int64_t(value >> 1 ^ (0 - (value & 1)));
  }
  // Things that take so many bytes each at least.
  std::size_t count(std::size_t bytes = 1) {
    const std::uint64_t value = varint();
    if (value > (bytes_.size() - at_) / bytes) good_ = false;
    return good_ ? std::size_t(value) : 0;
  }
  std::uint32_t index(std::int64_t& last, std::size_t limit) {
    const std::int64_t step = zigzag();
    if (step < -last || step >= std::int64_t(limit) - last) good_ = false;
    if (good_) last += step;
    return good_ ? std::uint32_t(last) : 0;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

bool within(const std::vector<std::uint32_t>& list, std::size_t size) {
  return std::all_of(list.begin(), list.end(), [size](std::uint32_t v) { return v < size; });
}

bool within(const std::vector<head::ContactPair>& pairs, std::size_t size) {
  return std::all_of(pairs.begin(), pairs.end(), [size](const head::ContactPair& pair) {
    return pair.upper < size && pair.lower < size;
  });
}

bool is_target(const head::Rig& rig, const head::Target& target) {
  const auto part = std::size_t(target.part);
  return target.control >= fap::kFirstLowLevel && target.low <= target.high &&
         std::size_t(target.control) < head::kFirstShape + rig.shapes.size() && rig.deforms[part] &&
         within(target.vertices, rig.parts[part].positions.size());
}

bool is_shape(const head::ShapeControl& shape) {
  const int arkit = shape.arkit.value_or(0);
  const int viseme = shape.viseme.value_or(1), expression = shape.expression.value_or(1);
  return arkit >= fap::kWholeFace && arkit < int(fap::kArkitChannelCount) && viseme >= 1 &&
         viseme <= 14 && expression >= 1 && expression <= 6;
}

// What pose() takes for granted.
bool is_whole(const head::Rig& rig) {
  const auto skin = std::size_t(head::Part::skin);
  const auto lashes = std::size_t(head::Part::lashes);
  const std::size_t size = rig.parts[skin].positions.size();
  const auto on_skin = [size](const auto& list) { return within(list, size); };
  const std::size_t anchored = rig.lash_anchors.size();
  const std::size_t closing = rig.lip_measures.closing.size();
  return rig.deforms[skin] && rig.neck_weights.size() == size &&
         (closing == 0 || closing == rig.shapes.size()) &&
         (anchored == 0 ||
          (anchored == rig.parts[lashes].positions.size() && rig.deforms[lashes])) &&
         on_skin(rig.lash_anchors) && on_skin(rig.lips) &&
         std::all_of(rig.lids.begin(), rig.lids.end(), on_skin) &&
         std::all_of(rig.lid_vertices.begin(), rig.lid_vertices.end(), on_skin) &&
         std::all_of(rig.eye_skin.begin(), rig.eye_skin.end(), on_skin) &&
         std::all_of(rig.teeth.begin(), rig.teeth.end(),
                     [&](const head::DentalArch& arch) { return on_skin(arch.vertices); }) &&
         std::all_of(rig.reaches.begin(), rig.reaches.end(),
                     [](const head::Reach& reach) {
                       return reach.fap >= fap::kFirstLowLevel && reach.fap <= fap::kFapCount;
                     }) &&
         std::all_of(rig.shapes.begin(), rig.shapes.end(), is_shape) &&
         std::all_of(rig.targets.begin(), rig.targets.end(),
                     [&](const head::Target& target) { return is_target(rig, target); });
}

bool set_outside(head::Rig& rig, const OutsideFlags& flags) {
  const auto& [places, normals, triangles] = rig.parts[std::size_t(head::Part::skin)];
  if (flags.outside.size() != triangles.size()) return false;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!flags.outside[t]) continue;
    const std::size_t k = rig.outside.size();
    if (k >= flags.rolls.size()) return false;
    const head::Triangle& corners = triangles[t];
    const Vec3 a = places[corners[0]];
    rig.outside.push_back(
        {corners, cross(places[corners[1]] - a, places[corners[2]] - a), flags.rolls[k]});
  }
  return rig.outside.size() == flags.rolls.size();
}

}  // namespace

std::optional<head::Rig> unpack_rig(std::span<const std::uint8_t> bytes) {
  std::optional<head::Rig> rig(std::in_place);
  OutsideFlags outside;
  Unpacker unpacker(bytes);
  pass_rig(unpacker, *rig, outside);
  if (!unpacker.done() || !is_whole(*rig) || !set_outside(*rig, outside)) return {};
  for (head::Rig::Shape& part : rig->parts) {
    head::detail::smooth_normals(part.positions, part.triangles, part.normals);
  }
  return rig;
}

}  // namespace animeme::viewer::detail
