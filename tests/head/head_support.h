// Heads for the tests, made once.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "fap/head/rig.h"

namespace animeme::test {

inline const head::Head& head_of(const std::string& name) {
  static std::map<std::string, head::Head> heads;
  auto found = heads.find(name);
  if (found == heads.end()) {
    found = heads.emplace(name, *head::make_head(*head::head_parameters(name))).first;
  }
  return found->second;
}

inline const head::Rig& rig_of(const std::string& name) {
  static std::map<std::string, head::Rig> rigs;
  auto found = rigs.find(name);
  if (found == rigs.end()) found = rigs.emplace(name, head::make_rig(head_of(name))).first;
  return found->second;
}

/// Where a feature point of a vertex is in a pose.
inline head::Vec3 posed(const head::Head& head, const head::Rig& rig, const head::Pose& pose,
                        std::string_view id) {
  const head::FeaturePoint point = head.point(id);
  const auto part = std::size_t(point.part);
  const auto& moved = pose.positions[part];
  return pose.transforms[part]((moved.empty() ? rig.parts[part].positions : moved)[point.vertex]);
}

/// Each FAP moves its feature point by value * FAPU/1024 along its axis, within 3 %. Points that
/// the head lacks, and those of parts other than `only`, if given, are left out. Returns the number
/// of moves that were compared.
inline int expect_table_moves(const head::Head& head, const head::Rig& rig,
                              std::initializer_list<int> values,
                              std::optional<head::Part> only = {}) {
  int compared = 0;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const fap::Move move = fap::move_of(fap);
    const std::string_view id = fap::info(fap).feature_point;
    if (move.kind != fap::MoveKind::translate || !head.point(id).exists()) continue;
    if (only && head.point(id).part != *only) continue;
    for (const int value : values) {
      fap::Frame frame;
      frame.set(fap, value);
      const head::Vec3 d =
          posed(head, rig, head::pose(rig, frame, {.contact = false}), id) - head.at(id);
      const double wanted = fap::displacement(fap, value, rig.fapu);
      const double along = move.axis[0] * d.x + move.axis[1] * d.y + move.axis[2] * d.z;
      EXPECT_NEAR(along, wanted, 0.03 * std::abs(wanted)) << "FAP " << fap << " on " << id;
      ++compared;
    }
  }
  return compared;
}

/// Triangles of the skin that look inwards: against the mean normal of their corners.
inline int inverted_triangles(const std::vector<head::Vec3>& places,
                              const std::vector<head::Vec3>& normals,
                              const std::vector<head::Triangle>& triangles) {
  int count = 0;
  for (const head::Triangle& t : triangles) {
    const head::Vec3 n = cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
    count += dot(n, normals[t[0]] + normals[t[1]] + normals[t[2]]) < 0 ? 1 : 0;
  }
  return count;
}

}  // namespace animeme::test
