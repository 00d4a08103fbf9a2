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

// Words of a name in lower case: parted where a capital follows a small letter, and at what is
// neither a letter nor a digit.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  char before = '_';
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool capital = c >= 'A' && c <= 'Z';
    const bool letter = capital || (c >= 'a' && c <= 'z') || (c & 0x80) != 0;
    const bool after_letter = (before >= 'a' && before <= 'z') ||
                              (before >= 'A' && before <= 'Z') || (before & 0x80) != 0;
    const bool small_before = before >= 'a' && before <= 'z';
    const bool next_small = i + 1 < name.size() && name[i + 1] >= 'a' && name[i + 1] <= 'z';
    const bool part = capital && (small_before || (after_letter && next_small));
    if (letter && (!after_letter || part)) words.emplace_back();
    if (letter) words.back() += capital ? char(c - 'A' + 'a') : c;
    before = c;
  }
  return words;
}

// What stands beside the words for parts where they are written as one ("upperteeth", "hairback").
constexpr std::string_view kBeside[] = {
    "left",   "right",  "upper",   "lower", "inner",    "outer",  "front", "back",  "top",
    "bottom", "up",     "low",     "l",     "r",        "t",      "s",     "es",    "mesh",
    "mat",    "geo",    "obj",     "main",  "base",     "full",   "card",  "cards", "long",
    "short",  "wear",   "ball",    "balls", "line",     "lines",  "lid",   "lids",  "cap",
    "cut",    "style",  "tex",     "poly",  "material", "shadow", "wet",   "white", "whites",
    "and",    "socket", "sockets", "model", "group",    "grp"};
// What tells a part of a head, and what is longer is found within other words.
constexpr std::string_view kParts[] = {
    "hair",   "beard", "hat",    "helmet",  "horn",   "horns", "gum",   "gums", "eye",   "eyes",
    "iris",   "brow",  "brows",  "lash",    "lashes", "tear",  "tears", "top",  "tops",  "shoe",
    "shoes",  "hand",  "hands",  "head",    "face",   "skin",  "neck",  "body", "tooth", "teeth",
    "tongue", "pupil", "bottom", "bottoms", "cloth",  "shirt", "torso"};
constexpr std::size_t kTelling = 5;  // letters of a word that is found within others

// Whether a word consists of words for parts, and what stands beside them.
bool is_compound(std::string_view word, bool first = true) {
  if (word.empty()) return !first;
  const auto begins = [&](std::string_view part) {
    return word.starts_with(part) && is_compound(word.substr(part.size()), false);
  };
  return std::any_of(std::begin(kParts), std::end(kParts), begins) ||
         std::any_of(std::begin(kBeside), std::end(kBeside), begins);
}

// Whether a name has one of these words: a long one anywhere, a short one ("hat", "iris") as a word
// or a part of a compound, since it also is within others (Chatbot, Christopher).
class NameWords {
 public:
  explicit NameWords(std::string_view name) : text_(lower_case(name)), words_(words_of(name)) {}

  // The word that is there; empty: none.
  std::string_view find(std::initializer_list<std::string_view> wanted) const {
    for (const std::string_view word : wanted) {
      if (has(word)) return word;
    }
    return {};
  }
  bool any(std::initializer_list<std::string_view> wanted) const { return !find(wanted).empty(); }
  bool ends_with(std::string_view ending) const { return text_.ends_with(ending); }

 private:
  bool has(std::string_view wanted) const {
    if (wanted.size() > kTelling || wanted.find('_') != std::string_view::npos) {
      return text_.find(wanted) != std::string::npos;
    }
    return std::any_of(words_.begin(), words_.end(), [&](const std::string& word) {
      const std::size_t at = word.find(wanted);
      return at != std::string::npos && (word == wanted || is_compound(word));
    });
  }

  std::string text_;
  std::vector<std::string> words_;
};

// What a name says, and by which word. kPartCount: not to be shown.
struct Told {
  int part;
  std::string_view word;
};

std::optional<Told> part_by_word(std::string_view given) {
  const NameWords name(given);
  const auto told = [](int part, std::string_view word) { return Told{part, word}; };
  if (const auto word = name.find({"occlusion", "lacrimal", "cornea", "tear", "tearline",
                                   "eyeblend", "eyeshadow", "eyewet"});
      !word.empty()) {
    return told(kPartCount, word);
  }
  if (const auto word = name.find({"lash", "lashes", "eyelash", "eyeline"}); !word.empty()) {
    return told(int(Part::lashes), word);
  }
  if (const auto word = name.find({"brow", "brows", "eyebrow"}); !word.empty()) {
    return told(int(Part::brows), word);
  }
  if (const auto word = name.find({"eyelid", "eyesocket", "eye_socket"}); !word.empty()) {
    return told(int(Part::skin), word);
  }
  // "eyewear" and "glasses" sit on the head.
  if (const auto word =
          name.find({"hair", "haircut", "hairstyle", "ponytail", "beard", "moustache", "mustache",
                     "hat", "helmet", "glasses", "eyewear", "headwear", "earring", "horn"});
      !word.empty()) {
    return told(int(Part::hair), word);
  }
  if (const auto word = name.find({"tongue"});
      !word.empty() && !name.any({"gum", "gums", "teeth"})) {
    return told(int(Part::tongue), word);
  }
  if (const auto word = name.find({"teeth", "tooth", "gum", "gums", "denture"}); !word.empty()) {
    return told(int(name.any({"upper", "_top", "top_"}) ? Part::upper_teeth : Part::lower_teeth),
                word);
  }
  if (const auto word = name.find({"eye", "eyes", "eyeball", "sclera", "iris", "pupil", "pupils"});
      !word.empty()) {
    const bool right = name.any({"right"}) || name.ends_with("_r") || name.ends_with(".r");
    return told(int(right ? Part::right_eye : Part::left_eye), word);
  }
  if (const auto word = name.find({"body", "shirt", "cloth", "clothes", "clothing", "torso",
                                   "outfit", "shoulder", "jacket", "top", "bottom", "shoe", "hand",
                                   "hands", "footwear", "trousers", "pants", "dress"});
      !word.empty()) {
    return told(int(Part::body), word);
  }
  if (const auto word = name.find({"head", "face", "skin", "neck"}); !word.empty()) {
    return told(int(Part::skin), word);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Part> part_by_name(std::string_view name, std::string_view material) {
  // Brows and lashes often share the material of the hair.
  const auto hairs = part_by_word(name);
  if (hairs && (hairs->part == int(Part::brows) || hairs->part == int(Part::lashes))) {
    const auto own = part_by_word(material);
    if (own && own->part == int(Part::hair)) return Part(hairs->part);
  }
  // The material is the finer division: one object often has the skin and the eyes.
  for (const std::string_view text : {material, name}) {
    const auto found = part_by_word(text);
    if (!found) continue;
    if (found->part == kPartCount) return std::nullopt;
    return Part(found->part);
  }
  return Part::skin;
}

std::string_view word_of_part(std::string_view name, std::string_view material) {
  for (const std::string_view text : {material, name}) {
    if (const auto found = part_by_word(text)) return found->word;
  }
  return {};
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
  const std::optional<Part> part =
      piece.face ? Part::skin : part_by_name(piece.name, piece.material);
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
