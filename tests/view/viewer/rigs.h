// Rigs without a head: small, and with some of everything.
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::test {

inline constexpr std::uint32_t kVertices = 24;

struct Dice {
  std::mt19937 engine{7};

  float number(float low, float high) { return low + (high - low) * float(engine() % 1000) / 1000; }
  head::Vec3 point() { return {number(-4, 4), number(-4, 4), number(-4, 4)}; }
};

inline std::vector<std::uint32_t> every_third() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t v = 1; v < kVertices; v += 3) list.push_back(v);
  return list;
}

inline head::Target target_of(int control, Dice& dice) {
  head::Target target;
  target.control = control;
  target.vertices = every_third();
  for (std::size_t i = 0; i < target.vertices.size(); ++i) {
    target.deltas.push_back({0, dice.number(-0.001f, 0.001f), dice.number(-0.001f, 0.001f)});
  }
  return target;
}

// A sheet of skin that has some of everything.
inline head::Rig small_rig() {
  Dice dice;
  head::Rig rig;
  head::Rig::Shape& skin = rig.parts[std::size_t(head::Part::skin)];
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    skin.positions.push_back(dice.point());
    rig.neck_weights.push_back(float(v) / (kVertices - 1));
  }
  skin.normals.resize(kVertices);
  for (std::uint32_t v = 0; v + 2 < kVertices; ++v) skin.triangles.push_back({v, v + 1, v + 2});
  head::Rig::Shape& lashes = rig.parts[std::size_t(head::Part::lashes)];
  lashes = {{{1, 2, 3}, {-1, 2, 3}, {0, 1, 2}}, std::vector<head::Vec3>(3), {{0, 1, 2}}};
  rig.lash_anchors = {4, 5, 6};
  rig.deforms[std::size_t(head::Part::skin)] = rig.deforms[std::size_t(head::Part::lashes)] = true;
  for (const int fap : {3, 5, 19, 53}) rig.targets.push_back(target_of(fap, dice));
  rig.targets.back().low = -100;
  rig.targets.back().high = 250;
  rig.fapu = {1, 6.3, 4, 3, 5};
  rig.eyes = {{{{3, 0, 1}, 1.2f, 0.6f, 0.2f}, {{-3, 0, 1}, 1.2f, 0.6f, 0.2f}}};
  rig.jaw_axis = {0, -2, -3};
  rig.neck_pivot = {0, -6, -2};
  rig.chin = {0, -9, 4};
  rig.lips = {{1, 2}, {3, 4}};
  rig.lids[1] = {{7, 8}};
  rig.lid_vertices[0] = {9, 11};
  rig.eye_skin[1] = {10, 2};  // in any order
  rig.rooms = {100, 200, 300, 400, 500, 600, 700, 800};
  rig.reaches = {{3, -200, 900}};
  rig.usual.fill(700);
  for (std::uint32_t t = 0; t < skin.triangles.size(); t += 5) {
    const auto& [a, b, c] = skin.triangles[t];
    const head::Vec3 at = skin.positions[a];
    rig.outside.push_back(
        {skin.triangles[t], cross(skin.positions[b] - at, skin.positions[c] - at), t % 2 == 0});
  }
  rig.teeth[0] = {{0, -4, 3}, 2, 3, 0.5f, {12, 13, 20}};
  rig.lid_follow = {0.1f, 0.2f};
  return rig;
}

// The same skin, moved by shapes.
inline head::Rig shape_rig() {
  Dice dice;
  head::Rig rig = small_rig();
  rig.targets.clear();
  rig.reaches.clear();
  rig.outside.clear();
  rig.mouth_gain = 1.2;
  for (const auto& [fap, value] : {std::pair(3, 600), std::pair(12, -300)}) {
    head::ShapeControl shape;
    shape.faps.set(fap, value);
    shape.faps.set(5, -value);
    if (fap == 3) shape.arkit = 0;
    if (fap == 12) shape.viseme = 10;
    rig.targets.push_back(target_of(head::kFirstShape + int(rig.shapes.size()), dice));
    rig.shapes.push_back(shape);
    rig.lip_measures.closing.push_back({1, 2, 3});
  }
  rig.lip_measures.at_rest = {4, 5, 6};
  rig.shown_by_shapes[std::size_t(head::Part::lower_teeth)] = true;
  return rig;
}

inline fap::Frame random_frame(unsigned seed) {
  std::mt19937 random(seed);
  fap::Frame frame;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (random() % 3 > 0) frame.set(f, int(random() % 1200) - 600);
  }
  if (seed % 2 == 0) {
    frame = {};
    frame.mask.set(1);
    frame.viseme = {int(seed) % 15, 10, 40, false};
  }
  return frame;
}

}  // namespace animeme::test
