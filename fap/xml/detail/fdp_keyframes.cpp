#include "fap/xml/detail/fdp_keyframes.h"

#include <algorithm>

#include "fap/head/shapes.h"

namespace animeme::head::detail {
namespace {

constexpr float kStill = 1e-3f;  // cm: what moves less stays

// Visemes 4 and 7 share a mesh; 0 is the entity Rest.
constexpr struct {
  int viseme;
  std::string_view alias;
} kVisemes[] = {{1, "b"}, {2, "f"},    {3, "th"},  {4, "d"},  {5, "k"},   {6, "ch"}, {8, "n"},
                {9, "r"}, {10, "aah"}, {11, "eh"}, {12, "i"}, {13, "oh"}, {14, "q"}};

constexpr std::string_view kExpressions[] = {"SmileClosed", "Sad",     "Anger",
                                             "Fear",        "Disgust", "Surprise"};

std::vector<Vec3> placed(const Rig& rig, const Pose& pose, Part part) {
  const std::size_t p = std::size_t(part);
  std::vector<Vec3> out = pose.positions[p].empty() ? rig.parts[p].positions : pose.positions[p];
  for (Vec3& v : out) v = pose.transforms[p](v);
  return out;
}

bool moves(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  return !std::equal(from.begin(), from.end(), to.begin(), to.end(),
                     [](const Vec3& a, const Vec3& b) {
                       const Vec3 by = b - a;
                       return dot(by, by) <= kStill * kStill;
                     });
}

}  // namespace

std::vector<FdpKeyframe> fdp_keyframes(const Rig& rig, const std::vector<Part>& parts) {
  std::vector<FdpKeyframe> all;
  std::vector<char> moved(parts.size(), 0);
  const auto add = [&](std::string_view alias, std::string_view category, const fap::Frame& face) {
    FdpKeyframe& keyframe = all.emplace_back(FdpKeyframe{alias, category, {}});
    const Pose shown = pose(rig, face);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      keyframe.positions.push_back(placed(rig, shown, parts[i]));
      const auto& rest = rig.parts[std::size_t(parts[i])].positions;
      if (moves(rest, keyframe.positions.back())) moved[i] = 1;
    }
  };
  for (const auto& [viseme, alias] : kVisemes) add(alias, "Viseme", viseme_shape(viseme));
  for (std::size_t i = 0; i < std::size(kExpressions); ++i) {
    add(kExpressions[i], "Expression", expression_shape(int(i) + 1));
  }
  for (FdpKeyframe& keyframe : all) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (moved[i] == 0) keyframe.positions[i].clear();
    }
  }
  return all;
}

}  // namespace animeme::head::detail
