#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "fap/arkit.h"
#include "fap/shape_fit.h"
#include "tools/view/gltf/detail/words.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

constexpr std::size_t kMouthShapes = 6;  // of ARKit's, with a jaw: they make a mouth

constexpr int kExpressions = 7;  // of FAP 2, the neutral one included: smaller moods are among them

constexpr std::size_t kMostNamed = 12;  // in a note

// The convention of names that have a rule: those of the user.
constexpr std::string_view kGiven = "given";

bool is_given(const ShapeMeaning& meaning) { return meaning.house == kGiven; }

// nullopt: unknown. A rule may say that a name means nothing; then it is `at_rest`.
std::optional<ShapeMeaning> meaning_by(const ShapeRules& rules, const std::string& name,
                                       std::string_view prefix, bool& at_rest) {
  const ShapeRule* const rule = find_rule(rules, name);
  at_rest = rule != nullptr && rule->meaning == "-";
  if (at_rest) return std::nullopt;
  std::optional<ShapeMeaning> meaning =
      rule != nullptr ? meaning_of(rule->meaning) : meaning_of(name, prefix);
  if (meaning && rule != nullptr) meaning->house = kGiven;
  return meaning;
}

std::string_view arkit_name(const ArkitPart& part) {
  return fap::kArkitNames[std::size_t(part.channel)];
}

bool is_mouth(const ShapeMeaning& meaning) {
  return meaning.set != ShapeSet::viseme &&
         std::any_of(meaning.parts.begin(), meaning.parts.end(), [](const ArkitPart& part) {
           const std::string_view name = arkit_name(part);
           return name.starts_with("mouth") || name.starts_with("jaw");
         });
}

// What visemes do not show.
bool is_mood(const ShapeMeaning& meaning) {
  return std::any_of(meaning.parts.begin(), meaning.parts.end(), [](const ArkitPart& part) {
    const std::string_view name = arkit_name(part);
    return name.starts_with("mouthSmile") || name.starts_with("mouthFrown");
  });
}

// What of ARKit's, without a jaw, would bend the visemes that open the mouth, and no sound needs.
bool bends_visemes(const ShapeMeaning& meaning) {
  constexpr std::string_view kBend[] = {"mouthFrown", "mouthRollLower"};
  if (meaning.set == ShapeSet::viseme || meaning.parts.empty() || is_given(meaning)) return false;
  return std::any_of(std::begin(kBend), std::end(kBend), [&](std::string_view name) {
    return arkit_name(meaning.parts.front()).starts_with(name);
  });
}

// Shapes named after FAPs that open the mouth.
bool has_fap_mouth(const std::vector<ChosenShape>& shapes) {
  bool jaw = false, lip = false;
  for (const ChosenShape& shape : shapes) {
    jaw = jaw || shape.meaning.fap == 3;
    lip = lip || shape.meaning.fap == 5;
  }
  return jaw && lip;
}

bool has_arkit_mouth(const std::vector<ChosenShape>& shapes) {
  int mouth = 0;
  bool jaw = false;
  for (const ChosenShape& shape : shapes) {
    if (shape.meaning.set != ShapeSet::arkit) continue;
    const std::string_view name = arkit_name(shape.meaning.parts.front());
    mouth += name.starts_with("mouth");
    jaw = jaw || name == "jawOpen";
  }
  return jaw && mouth >= int(kMouthShapes);
}

using MeaningKey = std::tuple<int, int, int, std::vector<ArkitPart>>;

MeaningKey key_of(const ShapeMeaning& meaning) {
  return {meaning.viseme, meaning.mood, meaning.fap, meaning.parts};
}

// Which convention a name follows: those of this file by their set, other houses by name.
std::string house_of(const ShapeMeaning& meaning) {
  if (!meaning.house.empty()) return std::string(meaning.house);
  return meaning.set == ShapeSet::arkit ? "arkit" : meaning.set == ShapeSet::viseme ? "viseme" : "";
}

// How many shapes each convention has here; ARKit's count more than any other's where they have a
// mouth.
std::map<std::string, std::size_t> sizes_of_houses(
    const std::vector<std::optional<ShapeMeaning>>& meanings) {
  std::map<std::string, std::set<MeaningKey>> houses;
  std::size_t mouth = 0;
  bool jaw = false;
  for (const auto& meaning : meanings) {
    if (!meaning) continue;
    const std::string house = house_of(*meaning);
    const bool is_new = houses[house].insert(key_of(*meaning)).second;
    if (house != "arkit" || !is_new) continue;
    const std::string_view name = arkit_name(meaning->parts.front());
    mouth += name.starts_with("mouth") ? 1 : 0;
    jaw = jaw || name == "jawOpen";
  }
  std::map<std::string, std::size_t> sizes;
  for (const auto& [house, keys] : houses) {
    // Of two conventions that are equally full, ARKit's.
    sizes[house] = 2 * keys.size() + (house == "arkit" ? 1 : 0);
    if (house == kGiven) sizes[house] += meanings.size() * 5;
    if (house == "arkit" && jaw && mouth >= kMouthShapes) sizes[house] += meanings.size() * 2;
  }
  return sizes;
}

// Names that mean the same are one shape, whose first names are those of the fullest convention.
// The names of other conventions are `doubled`.
std::vector<ChosenShape> known_shapes(const std::vector<std::string>& names,
                                      const ShapeRules& rules, std::vector<std::string>& unknown,
                                      std::vector<std::string>& doubled) {
  const std::string prefix = common_prefix(names);
  std::vector<std::optional<ShapeMeaning>> meanings;
  for (const std::string& name : names) {
    bool at_rest = false;
    meanings.push_back(meaning_by(rules, name, prefix, at_rest));
    if (!meanings.back() && !at_rest) unknown.push_back(name);
  }
  std::map<std::string, std::size_t> sizes = sizes_of_houses(meanings);
  std::vector<ChosenShape> shapes;
  std::map<MeaningKey, std::size_t> known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!meanings[i]) continue;
    const auto [place, is_new] = known.try_emplace(key_of(*meanings[i]), shapes.size());
    if (is_new) shapes.emplace_back();
    shapes[place->second].names.push_back(i);
  }
  for (ChosenShape& shape : shapes) {
    const auto size = [&](std::size_t name) { return sizes[house_of(*meanings[name])]; };
    std::stable_sort(shape.names.begin(), shape.names.end(),
                     [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    const std::size_t first = shape.names.front();
    shape.name = names[first];
    shape.meaning = *meanings[first];
    for (const std::size_t name : shape.names) {
      if (house_of(*meanings[name]) != house_of(shape.meaning)) doubled.push_back(names[name]);
    }
  }
  return shapes;
}

// Takes out other names for what shapes of ARKit, or names for fewer of them, do.
void drop_doubles(std::vector<ChosenShape>& shapes, std::vector<std::string>& unused) {
  std::map<int, int> taken;  // quarters by channel: left and right of the upper and the lower lip
  const auto quarters = [](const ArkitPart& part) {
    return (part.lips & 1 ? part.sides : 0) | (part.lips & 2 ? part.sides << 2 : 0);
  };
  const auto free = [&](const ShapeMeaning& meaning) {
    return std::all_of(meaning.parts.begin(), meaning.parts.end(), [&](const ArkitPart& part) {
      return (taken[part.channel] & quarters(part)) == 0;
    });
  };
  std::vector<bool> keep(shapes.size(), false);
  const auto take = [&](ShapeSet set, std::size_t parts, bool given = false) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const ShapeMeaning& meaning = shapes[i].meaning;
      if (meaning.mood > 0 || meaning.fap > 0) keep[i] = true;
      if (keep[i] || meaning.set != set || (parts > 0 && meaning.parts.size() != parts)) continue;
      if (given && !is_given(meaning)) continue;
      keep[i] = free(meaning);
      if (!keep[i]) continue;
      for (const ArkitPart& part : meaning.parts) taken[part.channel] |= quarters(part);
    }
  };
  for (const ShapeSet set : {ShapeSet::arkit, ShapeSet::other, ShapeSet::viseme}) {
    take(set, 0, true);
  }
  take(ShapeSet::arkit, 1);
  take(ShapeSet::arkit, 0);
  for (std::size_t parts = 1; parts <= 3; ++parts) take(ShapeSet::other, parts);
  take(ShapeSet::viseme, 0);
  std::vector<ChosenShape> kept;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (keep[i]) {
      kept.push_back(std::move(shapes[i]));
    } else {
      unused.push_back(shapes[i].name);
    }
  }
  shapes = std::move(kept);
}

}  // namespace

std::vector<std::string> unknown_names(const std::vector<std::string>& names,
                                       const ShapeRules& rules) {
  const std::string prefix = common_prefix(names);
  std::vector<std::string> unknown;
  for (const std::string& name : names) {
    bool at_rest = false;
    if (!meaning_by(rules, name, prefix, at_rest) && !at_rest) unknown.push_back(name);
  }
  return unknown;
}

std::string advice_on_names(const std::vector<std::string>& unknown) {
  const std::string none = "no morph target has a known name (ARKit, visemes, VRM)";
  if (unknown.empty()) return none;
  return none + "; its names are " + list_of(unknown, 100) +
         ": say what they mean with --shape-name " + unknown.front().substr(0, 60) +
         "=jawOpen and so on";
}

head::ShapeControl control_of(const ChosenShape& shape) {
  const ShapeMeaning& meaning = shape.meaning;
  head::ShapeControl control{shape.name, meaning.faps};
  const bool whole = meaning.parts.size() == 1 && meaning.parts.front().sides == 3 &&
                     meaning.parts.front().lips == 3;
  if (meaning.viseme > 0) control.viseme = meaning.viseme;
  const bool fitted = meaning.faps.mask.any();
  if (meaning.mood > 0 && fitted) control.arkit = fap::kWholeFace;
  if (meaning.mood > 0 && meaning.mood < kExpressions) control.expression = meaning.mood;
  if (meaning.set == ShapeSet::arkit && whole) control.arkit = meaning.parts.front().channel;
  return control;
}

std::vector<ChosenShape> choose_shapes(const std::vector<std::string>& names, MouthShapes mouth,
                                       std::vector<std::string>& notes, const ShapeRules& rules) {
  std::vector<std::string> unknown;
  std::vector<std::string> unused;
  std::vector<ChosenShape> shapes = known_shapes(names, rules, unknown, unused);
  const bool any_viseme = std::any_of(shapes.begin(), shapes.end(), [](const ChosenShape& shape) {
    return shape.meaning.set == ShapeSet::viseme;
  });
  const bool arkit =
      mouth == MouthShapes::arkit || (mouth == MouthShapes::automatic && has_arkit_mouth(shapes));
  const auto move_out = [&](auto wanted) {
    std::erase_if(shapes, [&](const ChosenShape& shape) {
      if (!wanted(shape.meaning)) return false;
      unused.push_back(shape.name);
      return true;
    });
  };
  // ARKit's shapes make any of these faces; those of FAP 2 are shown for FAP 2 alone.
  if (arkit) {
    move_out([](const ShapeMeaning& meaning) {
      return meaning.mood >= kExpressions || meaning.fap > 0;
    });
    for (ChosenShape& shape : shapes) {
      if (shape.meaning.mood > 0) shape.meaning.faps = {};
    }
  }
  const bool by_fap = has_fap_mouth(shapes);
  if (any_viseme && (arkit || by_fap)) {
    // They show FAP 1; lips that are coded one by one are better followed by ARKit's.
    for (ChosenShape& shape : shapes) {
      if (shape.meaning.set == ShapeSet::viseme) shape.meaning.faps = {};
    }
  } else if (any_viseme && mouth == MouthShapes::visemes) {
    move_out([](const ShapeMeaning& meaning) { return is_mouth(meaning) && !is_mood(meaning); });
  }
  if (any_viseme && !arkit && !by_fap) move_out(bends_visemes);
  drop_doubles(shapes, unused);
  // Silence is what is left when nothing else is shown.
  std::erase_if(shapes, [](const ChosenShape& shape) { return shape.meaning.viseme == 0; });
  if (!unused.empty()) {
    notes.push_back("shapes that are not needed besides the others: " +
                    list_of(unused, kMostNamed));
  }
  if (!unknown.empty()) {
    notes.push_back("shapes with unknown names, which stay at rest: " +
                    list_of(unknown, kMostNamed));
  }
  return shapes;
}

}  // namespace animeme::gltf
