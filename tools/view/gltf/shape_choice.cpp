#include <algorithm>
#include <map>
#include <tuple>

#include "fap/arkit.h"
#include "fap/shape_fit.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

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
  if (meaning.set == ShapeSet::viseme || meaning.parts.empty()) return false;
  return std::any_of(std::begin(kBend), std::end(kBend), [&](std::string_view name) {
    return arkit_name(meaning.parts.front()).starts_with(name);
  });
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
  return jaw && mouth >= 6;
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
    text += (i == 0 ? "" : ", ") + names[i].substr(0, 60);
  }
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

// Names that mean the same are one shape.
std::vector<ChosenShape> known_shapes(const std::vector<std::string>& names,
                                      std::vector<std::string>& unknown) {
  std::vector<ChosenShape> shapes;
  std::map<std::tuple<int, int, std::vector<ArkitPart>>, std::size_t> known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::optional<ShapeMeaning> meaning = meaning_of(names[i]);
    if (!meaning) {
      unknown.push_back(names[i]);
      continue;
    }
    const auto [place, is_new] =
        known.try_emplace({meaning->viseme, meaning->mood, meaning->parts}, shapes.size());
    if (is_new) shapes.push_back({names[i], std::move(*meaning), {}});
    shapes[place->second].names.push_back(i);
  }
  return shapes;
}

// Takes out other names for what shapes of ARKit, or names for fewer of them, do.
void drop_doubles(std::vector<ChosenShape>& shapes, std::vector<std::string>& unused) {
  std::map<int, int> taken;  // sides by channel
  const auto free = [&](const ShapeMeaning& meaning) {
    return std::all_of(meaning.parts.begin(), meaning.parts.end(), [&](const ArkitPart& part) {
      return (taken[part.channel] & part.sides) == 0;
    });
  };
  std::vector<bool> keep(shapes.size(), false);
  const auto take = [&](ShapeSet set, std::size_t parts) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const ShapeMeaning& meaning = shapes[i].meaning;
      if (meaning.mood > 0) keep[i] = true;
      if (meaning.mood > 0 || meaning.set != set || (parts > 0 && meaning.parts.size() != parts))
        continue;
      keep[i] = free(meaning);
      if (!keep[i]) continue;
      for (const ArkitPart& part : meaning.parts) taken[part.channel] |= part.sides;
    }
  };
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

head::ShapeControl control_of(const ChosenShape& shape) {
  const ShapeMeaning& meaning = shape.meaning;
  head::ShapeControl control{shape.name, meaning.faps};
  const bool whole = meaning.parts.size() == 1 && meaning.parts.front().sides == 3;
  if (meaning.viseme > 0) control.viseme = meaning.viseme;
  if (meaning.mood > 0) control.arkit = fap::kWholeFace;
  if (meaning.set == ShapeSet::arkit && whole) control.arkit = meaning.parts.front().channel;
  return control;
}

std::vector<ChosenShape> choose_shapes(const std::vector<std::string>& names, MouthShapes mouth,
                                       std::vector<std::string>& notes) {
  std::vector<std::string> unknown;
  std::vector<std::string> unused;
  std::vector<ChosenShape> shapes = known_shapes(names, unknown);
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
  // ARKit's shapes make any of these faces.
  if (arkit) move_out([](const ShapeMeaning& meaning) { return meaning.mood > 0; });
  if (any_viseme && arkit) {
    // They show FAP 1; lips that are coded one by one are better followed by ARKit's.
    for (ChosenShape& shape : shapes) {
      if (shape.meaning.set == ShapeSet::viseme) shape.meaning.faps = {};
    }
  } else if (any_viseme && mouth == MouthShapes::visemes) {
    move_out([](const ShapeMeaning& meaning) { return is_mouth(meaning) && !is_mood(meaning); });
  }
  if (any_viseme && !arkit) move_out(bends_visemes);
  drop_doubles(shapes, unused);
  // Silence is what is left when nothing else is shown.
  std::erase_if(shapes, [](const ChosenShape& shape) { return shape.meaning.viseme == 0; });
  if (!unused.empty()) {
    notes.push_back("shapes that are not needed besides the others: " + list_of(unused));
  }
  if (!unknown.empty()) {
    notes.push_back("shapes with unknown names, which stay at rest: " + list_of(unknown));
  }
  return shapes;
}

}  // namespace animeme::gltf
