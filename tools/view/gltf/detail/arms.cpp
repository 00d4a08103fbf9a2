#include "tools/view/gltf/detail/arms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/view/gltf/detail/joints.h"
#include "tools/view/gltf/detail/words.h"

namespace animeme::gltf {
namespace {

using head::Vec3d;

constexpr double kHanging = 75 * std::numbers::pi / 180;  // below the horizontal
constexpr double kStretched = 0.5;  // the share of an arm that points sideways, at least

bool is_upper_arm(const std::vector<std::string>& words, const char* side) {
  if (!has_word(words, side)) return false;
  for (const char* word : {"lower", "fore", "twist", "roll", "end", "ik", "pole", "target", "ctrl",
                           "shoulder", "clavicle", "hand", "share", "bend"}) {
    if (has_word(words, word)) return false;
  }
  return has_word(words, "arm") || has_word(words, "upperarm");
}

// A bone below it that is at the elbow or further.
std::size_t end_of(const std::vector<Node>& nodes, std::size_t arm) {
  const std::vector<bool> below = nodes_below(nodes, arm);
  std::size_t end = kNoNode;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!below[i] || i == arm) continue;
    const std::vector<std::string> words = words_of(nodes[i].name);
    const bool hand = has_word(words, "hand") || has_word(words, "wrist");
    if (hand) return i;
    const bool lower =
        has_word(words, "forearm") || has_word(words, "lowerarm") || has_word(words, "elbow") ||
        (has_word(words, "arm") && (has_word(words, "fore") || has_word(words, "lower")));
    if (lower && end == kNoNode) end = i;
  }
  return end;
}

// A turn about an axis through a place.
Affine turn_about(Vec3d place, Vec3d axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  Affine turn;
  turn.rows = {{{c + axis.x * axis.x * d, axis.x * axis.y * d - axis.z * s,
                 axis.x * axis.z * d + axis.y * s, 0},
                {axis.y * axis.x * d + axis.z * s, c + axis.y * axis.y * d,
                 axis.y * axis.z * d - axis.x * s, 0},
                {axis.z * axis.x * d - axis.y * s, axis.z * axis.y * d + axis.x * s,
                 c + axis.z * axis.z * d, 0}}};
  const Vec3d moved = turn.place(place);
  turn.rows[0][3] = place.x - moved.x;
  turn.rows[1][3] = place.y - moved.y;
  turn.rows[2][3] = place.z - moved.z;
  return turn;
}

void lower(std::vector<Node>& nodes, std::size_t arm, std::size_t end) {
  const Vec3d at = nodes[arm].world.origin();
  const Vec3d along = nodes[end].world.origin() - at;
  const double length = std::hypot(along.x, along.y, along.z);
  const double flat = std::hypot(along.x, along.z);
  // Sideways, not to the front; not hanging already.
  if (!(length > 0) || std::abs(along.x) < kStretched * length || flat <= 0) return;
  const double angle = kHanging + std::atan2(along.y, flat);
  if (angle <= 0) return;
  // The axis is horizontal and square to the arm; a positive angle lowers it.
  const Vec3d axis{along.z / flat, 0, -along.x / flat};
  const Affine turn = turn_about(at, axis, angle);
  const std::vector<bool> below = nodes_below(nodes, arm);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (below[i]) nodes[i].world = turn * nodes[i].world;
  }
}

}  // namespace

void lower_arms(const File& file, std::vector<Node>& nodes) {
  for (const bool left : {true, false}) {
    std::size_t arm = human_bone(file, left ? "leftUpperArm" : "rightUpperArm");
    for (std::size_t i = 0; i < nodes.size() && arm >= nodes.size(); ++i) {
      if (is_upper_arm(words_of(nodes[i].name), left ? "left" : "right") &&
          end_of(nodes, i) != kNoNode) {
        arm = i;
      }
    }
    if (arm >= nodes.size()) continue;
    std::size_t end = human_bone(file, left ? "leftHand" : "rightHand");
    if (end >= nodes.size()) end = end_of(nodes, arm);
    if (end < nodes.size() && nodes_below(nodes, arm)[end] && end != arm) lower(nodes, arm, end);
  }
}

}  // namespace animeme::gltf
