// The rig of the page as WebAssembly: what js/rig.js calls. One instance has all heads of a page,
// for as long as the page is there.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tools/view/viewer/rig/packed_rig.h"

#if defined(__wasm__)
#define ANIMEME_EXPORT(name) extern "C" __attribute__((export_name(#name)))
#else
#define ANIMEME_EXPORT(name) extern "C"
#endif

namespace animeme::viewer {
namespace {

// A head that moves.
struct Shown {
  const head::Rig* rig;
  head::Pose pose;
};

// A frame as the page fills it in, numbers of 32 bits.
struct Wanted {
  std::array<std::int32_t, fap::kFapCount + 1> value;
  std::array<std::int32_t, fap::kFapCount + 1> given;
  std::array<std::int32_t, 3> viseme;      // select1, select2, blend
  std::array<std::int32_t, 4> expression;  // select1, intensity1, select2, intensity2
};

// A part at rest, for the page.
struct PartView {
  const head::Vec3* positions;
  const head::Vec3* normals;
  std::uint32_t vertices;
  const head::Triangle* triangles;
  std::uint32_t triangle_count;
  std::uint32_t deforms;
};

std::vector<std::uint8_t> packed;
std::vector<std::unique_ptr<head::Rig>> rigs;
std::vector<std::unique_ptr<Shown>> heads;
head::ControlValues controls;
Wanted wanted;
PartView part_view;

std::size_t control_count(const head::Rig& rig) { return head::kFirstShape + rig.shapes.size(); }

fap::Frame wanted_frame() {
  fap::Frame frame;
  for (std::size_t f = 1; f < wanted.value.size(); ++f) {
    if (wanted.given[f] == 0) continue;
    frame.mask.set(f);
    frame.value[f] = wanted.value[f];
  }
  const auto& [first, second, blend] = wanted.viseme;
  frame.viseme = {first, second, blend, false};
  const auto& [select1, intensity1, select2, intensity2] = wanted.expression;
  frame.expression = {select1, intensity1, select2, intensity2, false, false};
  return frame;
}

}  // namespace

/// Room for the bytes of pack_rig().
ANIMEME_EXPORT(room) std::uint8_t* room(std::size_t size) {
  packed.resize(size);
  return packed.data();
}

/// The rig of these bytes: its number, -1 if they are damaged.
ANIMEME_EXPORT(load) int load() {
  std::optional<head::Rig> rig = detail::unpack_rig(packed);
  packed = {};
  if (!rig) return -1;
  rigs.push_back(std::make_unique<head::Rig>(std::move(*rig)));
  return int(rigs.size()) - 1;
}

/// A part of a rig at rest; good until the next call.
ANIMEME_EXPORT(part) const PartView* part_of(std::size_t rig, std::size_t index) {
  const head::Rig::Shape& shape = rigs[rig]->parts[index];
  part_view = {shape.positions.data(),
               shape.normals.data(),
               std::uint32_t(shape.positions.size()),
               shape.triangles.data(),
               std::uint32_t(shape.triangles.size()),
               rigs[rig]->deforms[index]};
  return &part_view;
}

/// Another head with a rig: its number.
ANIMEME_EXPORT(add) std::size_t add(std::size_t rig) {
  heads.push_back(std::make_unique<Shown>(Shown{rigs[rig].get(), {}}));
  return heads.size() - 1;
}

/// Where the page puts values by control: FAPs, then the shapes of the rig.
ANIMEME_EXPORT(values) float* values(std::size_t head) {
  controls.assign(control_count(*heads[head]->rig), 0);
  return controls.data();
}

/// Moves a head by these.
ANIMEME_EXPORT(move) void move(std::size_t head) {
  Shown& shown = *heads[head];
  pose(*shown.rig, controls, shown.pose);
}

/// Where the page puts a frame.
ANIMEME_EXPORT(frame) Wanted* frame() {
  wanted = {};
  return &wanted;
}

/// Moves a head by that.
ANIMEME_EXPORT(show) void show(std::size_t head) {
  Shown& shown = *heads[head];
  pose(*shown.rig, wanted_frame(), shown.pose);
}

/// Of a part that deforms, when the head has been moved.
ANIMEME_EXPORT(positions) const head::Vec3* positions(std::size_t head, std::size_t part) {
  return heads[head]->pose.positions[part].data();
}
ANIMEME_EXPORT(normals) const head::Vec3* normals(std::size_t head, std::size_t part) {
  return heads[head]->pose.normals[part].data();
}
/// Rows, then the shift.
ANIMEME_EXPORT(transform) const head::Transform* transform(std::size_t head, std::size_t part) {
  return &heads[head]->pose.transforms[part];
}

}  // namespace animeme::viewer
