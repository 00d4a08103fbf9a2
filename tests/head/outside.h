// The skin that is seen from outside: without the bag of the mouth and the sockets of the eyes.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "tests/head/head_support.h"

namespace animeme::test {

/// Where the outside of the face ends: the contact line of the lips and the rims of the lids.
inline std::vector<bool> seam_of(const head::Head& head) {
  std::vector<bool> seam(head.part(head::Part::skin).positions.size());
  const auto add = [&seam](const std::vector<head::ContactPair>& pairs) {
    for (const head::ContactPair& pair : pairs) seam[pair.upper] = seam[pair.lower] = true;
  };
  add(head.seams.lips);
  for (const auto& lids : head.seams.lids) add(lids);
  for (const char* corner : {"2.4", "2.5", "3.7", "3.8", "3.11", "3.12"}) {
    seam[head.point(corner).vertex] = true;
  }
  return seam;
}

/// Triangles that can be reached from the chin without crossing a seam, those at a seam left out
/// if not asked for: there the skin rolls in.
inline std::vector<head::Triangle> outside_of(const head::Head& head, bool with_seam = false) {
  const auto& triangles = head.part(head::Part::skin).triangles;
  const std::vector<bool> seam = seam_of(head);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> by_edge;
  std::vector<std::size_t> open;
  std::vector<bool> reached(triangles.size());
  const std::uint32_t chin = head.point("2.1").vertex;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      by_edge[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
      if (triangles[t][k] == chin) open.push_back(t);
    }
  }
  std::vector<head::Triangle> outside;
  while (!open.empty()) {
    const std::size_t t = open.back();
    open.pop_back();
    if (reached[t]) continue;
    reached[t] = true;
    const head::Triangle& corners = triangles[t];
    const bool at_seam = seam[corners[0]] || seam[corners[1]] || seam[corners[2]];
    if (with_seam || !at_seam) outside.push_back(corners);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[(k + 1) % 3];
      const auto next = by_edge.find({b, a});
      if (next != by_edge.end() && !(seam[a] && seam[b])) open.push_back(next->second);
    }
  }
  return outside;
}

}  // namespace animeme::test
