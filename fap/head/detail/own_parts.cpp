#include "fap/head/detail/own_steps.h"

#include <map>

#include "fap/detail/text_scanner.h"
#include "fap/head/detail/paint.h"

namespace animeme::head {
namespace {

using fap::detail::lower_case;

bool has_any(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return text.find(word) != std::string_view::npos;
  });
}

// One name; nothing: it says nothing. kPartCount: not to be shown.
std::optional<int> part_by_word(const std::string& name) {
  if (has_any(name, {"occlusion", "lacrimal", "cornea", "tear", "eyeblend", "eyeshadow", "eyewet"}))
    return kPartCount;
  if (has_any(name, {"lash", "eyeline"})) return int(Part::lashes);
  if (has_any(name, {"brow"})) return int(Part::brows);
  if (has_any(name, {"eyelid", "eyesocket", "eye_socket"})) return int(Part::skin);
  // "eyewear" and "glasses" sit on the head.
  if (has_any(name, {"hair", "beard", "moustache", "hat", "helmet", "glasses", "eyewear",
                     "headwear", "earring", "horn"}) &&
      !has_any(name, {"hatch"})) {
    return int(Part::hair);
  }
  if (has_any(name, {"tongue"}) && !has_any(name, {"gum", "teeth"})) return int(Part::tongue);
  if (has_any(name, {"teeth", "tooth", "gum", "denture"})) {
    return int(has_any(name, {"upper", "_top", "top_"}) ? Part::upper_teeth : Part::lower_teeth);
  }
  if (has_any(name, {"eye", "sclera", "iris", "pupil"})) {
    const bool right = has_any(name, {"right"}) || name.ends_with("_r") || name.ends_with(".r");
    return int(right ? Part::right_eye : Part::left_eye);
  }
  if (has_any(name, {"body", "shirt", "cloth", "torso", "outfit", "shoulder", "jacket", "top",
                     "bottom", "shoe", "hand", "footwear"})) {
    return int(Part::body);
  }
  if (has_any(name, {"head", "face", "skin", "neck"})) return int(Part::skin);
  return std::nullopt;
}

}  // namespace

std::optional<Part> part_by_name(std::string_view name, std::string_view material) {
  // Brows and lashes often share the material of the hair.
  const std::optional<int> hairs = part_by_word(lower_case(name));
  if (hairs == int(Part::brows) || hairs == int(Part::lashes)) {
    if (part_by_word(lower_case(material)) == int(Part::hair)) return Part(*hairs);
  }
  // The material is the finer division: one object often has the skin and the eyes.
  for (const std::string& text : {lower_case(material), lower_case(name)}) {
    const std::optional<int> found = part_by_word(text);
    if (!found) continue;
    if (*found == kPartCount) return std::nullopt;
    return Part(*found);
  }
  return Part::skin;
}

Vec3 colour_by_name(std::string_view name, std::string_view material) {
  const std::string text = lower_case(material.empty() ? name : material);
  return has_any(text, {"gum"}) ? detail::linear_colour(0xC27472) : kNoColour;
}

namespace detail {

std::vector<std::uint32_t> bodies_of(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](std::uint32_t v, std::uint32_t other) {
    const std::uint32_t a = root(v);
    const std::uint32_t b = root(other);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t other : {t[1], t[2]}) join(t[0], other);
  }
  for (const Triangle& t : mesh.facets) {
    for (const std::size_t k : {1u, 2u}) {
      join(mesh.corners[t[0]].vertex, mesh.corners[t[k]].vertex);
    }
  }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

std::vector<std::uint8_t> parts_of(const Piece& piece, float middle, float mouth) {
  const std::size_t count = piece.mesh.positions.size();
  const std::optional<Part> part = part_by_name(piece.name, piece.material);
  // Lashes are mostly cards of which a texture leaves hairs alone: as solid cards they disturb.
  const bool card = part == Part::lashes &&
                    (piece.mesh.colours.size() != count || piece.mesh.colours[0] == kNoColour);
  std::vector<std::uint8_t> out(count,
                                part && !card ? std::uint8_t(*part) : std::uint8_t(kPartCount));
  const bool eyes = part == Part::left_eye || part == Part::right_eye;
  const bool teeth = part == Part::lower_teeth;
  if (!eyes && !teeth) return out;
  struct Sum {
    double x = 0, y = 0;
    int count = 0;
  };
  const std::vector<std::uint32_t> bodies = bodies_of(piece.mesh);
  std::map<std::uint32_t, Sum> sums;
  for (std::size_t v = 0; v < count; ++v) {
    Sum& sum = sums[bodies[v]];
    sum.x += piece.mesh.positions[v].x;
    sum.y += piece.mesh.positions[v].y;
    ++sum.count;
  }
  const bool lower_by_name =
      has_any(lower_case(piece.name + " " + piece.material), {"lower", "bottom"});
  for (std::size_t v = 0; v < count; ++v) {
    const Sum& sum = sums[bodies[v]];
    if (eyes) out[v] = std::uint8_t(sum.x / sum.count > middle ? Part::left_eye : Part::right_eye);
    if (teeth && !lower_by_name && sum.y / sum.count > mouth) {
      out[v] = std::uint8_t(Part::upper_teeth);
    }
  }
  return out;
}

}  // namespace detail
}  // namespace animeme::head
