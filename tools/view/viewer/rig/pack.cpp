#include <algorithm>
#include <bit>
#include <cmath>

#include "tools/view/viewer/rig/fields.h"
#include "tools/view/viewer/rig/numbers.h"
#include "tools/view/viewer/rig/packed_rig.h"

namespace animeme::viewer::detail {
namespace {

using head::Vec3;

// What fields.h calls an archive, to write.
class Packer {
 public:
  const std::vector<std::uint8_t>& data() const { return out_.data(); }

  template <class Number>
  void whole(Number value) {
    out_.zigzag(std::int64_t(value));
  }
  void number(float value) { out_.u32(std::bit_cast<std::uint32_t>(value)); }
  void number(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    out_.u32(std::uint32_t(bits & 0xFFFFFFFF));
    out_.u32(std::uint32_t(bits >> 32));
  }
  void flag(bool value) { out_.u8(value ? 1 : 0); }
  template <class Enum>
  void choice(Enum value) {
    out_.varint(std::uint64_t(value));
  }
  void perhaps(const std::optional<int>& value) {
    flag(value.has_value());
    if (value) whole(*value);
  }
  void vector(Vec3 v) {
    for (const float value : {v.x, v.y, v.z}) number(value);
  }

  template <class List, class Each>
  void list(const List& items, Each each) {
    out_.varint(items.size());
    for (const auto& item : items) each(item);
  }

  void places(const std::vector<Vec3>& places) {
    out_.varint(places.size());
    Vec3 low;
    float size = 0;
    for (float Vec3::*axis : kAxes) {
      if (places.empty()) break;
      const auto [least, most] =
          std::minmax_element(places.begin(), places.end(),
                              [axis](const Vec3& a, const Vec3& b) { return a.*axis < b.*axis; });
      low.*axis = (*least).*axis;
      size = std::max(size, (*most).*axis - (*least).*axis);
    }
    const float step = std::max(size, 1e-6f) / 65535;
    vector(low);
    number(step);
    for (float Vec3::*axis : kAxes) {
      for (const Vec3& p : places) u16((p.*axis - low.*axis) / step);
    }
  }

  void triangles(const std::vector<head::Triangle>& triangles, std::size_t) {
    out_.varint(triangles.size());
    std::int64_t last = 0;
    for (const head::Triangle& triangle : triangles) {
      for (const std::uint32_t vertex : triangle) index(vertex, last);
    }
  }

  void indices(const std::vector<std::uint32_t>& list) {
    out_.varint(list.size());
    std::int64_t last = 0;
    for (const std::uint32_t vertex : list) index(vertex, last);
  }

  // Most targets move along one axis: a step of 0 stands for no numbers.
  void deltas(const std::vector<Vec3>& deltas, std::size_t) {
    for (float Vec3::*axis : kAxes) {
      float most = 0;
      for (const Vec3& d : deltas) most = std::max(most, std::abs(d.*axis));
      const float step = most / 32767;
      number(step);
      if (step == 0) continue;
      for (const Vec3& d : deltas) {
        out_.u16(std::uint32_t(std::lround((d.*axis) / step)) & 0xFFFF);
      }
    }
  }

  void frame(const fap::Frame& frame) {
    out_.varint(frame.mask.count());
    for (std::size_t f = 0; f < frame.mask.size(); ++f) {
      if (!frame.mask[f]) continue;
      whole(f);
      whole(frame.value[f]);
    }
  }

  void shares(const std::vector<float>& shares) {
    out_.varint(shares.size());
    for (const float share : shares) u16(share * 65535);
  }

  // How many are set, then how many are not, and so on.
  void runs(const Flags& flags) {
    out_.varint(flags.size());
    bool value = true;
    for (std::size_t at = 0; at < flags.size(); value = !value) {
      const std::size_t begin = at;
      while (at < flags.size() && flags[at] == value) ++at;
      out_.varint(at - begin);
    }
  }

 private:
  static constexpr float Vec3::*kAxes[] = {&Vec3::x, &Vec3::y, &Vec3::z};

  void index(std::uint32_t vertex, std::int64_t& last) {
    out_.zigzag(std::int64_t(vertex) - last);
    last = vertex;
  }
  void u16(float value) { out_.u16(std::uint32_t(std::lround(std::clamp(value, 0.0f, 65535.0f)))); }

  Bytes out_;
};

OutsideFlags outside_flags(const head::Rig& rig) {
  OutsideFlags flags;
  auto next = rig.outside.begin();
  for (const head::Triangle& triangle : rig.parts[std::size_t(head::Part::skin)].triangles) {
    flags.outside.push_back(next != rig.outside.end() && next->corners == triangle);
    if (!flags.outside.back()) continue;
    flags.rolls.push_back(next->rolls);
    ++next;
  }
  return flags;
}

}  // namespace

std::vector<std::uint8_t> pack_rig(const head::Rig& rig) {
  Packer packer;
  const OutsideFlags outside = outside_flags(rig);
  pass_rig(packer, rig, outside);
  return packer.data();
}

}  // namespace animeme::viewer::detail
