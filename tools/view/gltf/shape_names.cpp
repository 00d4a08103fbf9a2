#include "tools/view/gltf/shape_names.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

#include "fap/arkit.h"
#include "fap/detail/text_scanner.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"
#include "tools/view/gltf/detail/house_names.h"
#include "tools/view/gltf/detail/words.h"

namespace animeme::gltf {
namespace {

using fap::detail::lower_case;

constexpr int kLeft = 1, kRight = 2, kBoth = 3;

// Words before the name proper, as exporters and rigs put them.
bool is_prefix(const std::string& word) {
  constexpr std::string_view kKnown =
      " blendshape blend shape shapes bs arkit ar kit ak face head ctrl expressions morph morpher "
      "mesh wolf3d fcl expression facial key target bshp facs ectrl pctrl cc ";
  if (kKnown.find(" " + word + " ") != std::string_view::npos) return true;
  // Numbers, and letters with numbers: "09", "a14".
  return !word.empty() &&
         std::all_of(word.begin() + 1, word.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         (word.size() > 1 || (word[0] >= '0' && word[0] <= '9'));
}

// The texts that a name may stand for, longest first.
std::vector<std::vector<std::string>> readings_of(std::string_view name) {
  std::vector<std::vector<std::string>> readings;
  const auto add = [&](std::string_view part) {
    std::vector<std::string> words = words_of(part);
    for (;;) {
      readings.push_back(words);
      // What Daz and Autodesk put behind: "facs_bs_JawOpen_div2", "h_expressions.Kiss_h".
      std::vector<std::string> front = words;
      if (front.size() > 2 && front[front.size() - 2] == "div") front.pop_back();
      if (front.size() > 1 && (front.back() == "div" || front.back() == "h")) {
        front.pop_back();
        readings.push_back(front);
      }
      if (words.empty() || !is_prefix(words.front())) return;
      words.erase(words.begin());
    }
  };
  add(name);
  for (const std::string_view mark : {".", ":", "|", "__"}) {
    const std::size_t at = name.rfind(mark);
    if (at != std::string_view::npos) add(name.substr(at + mark.size()));
  }
  const std::size_t daz = name.find("CTRL");  // eCTRLvAA, pCTRLMouthOpen
  if (daz != std::string_view::npos && daz <= 1) add(name.substr(daz + 4));
  const std::size_t vroid = name.find("Fcl_");
  if (vroid != std::string_view::npos) add(name.substr(vroid + 4));
  return readings;
}

struct OtherName {
  std::string_view keys;
  std::array<std::string_view, 3> shapes;  // of ARKit
};

constexpr OtherName kOthers[] = {
    {"blink eyesclosed eyesclose eyeclose eyeclosed closeeyes まばたき",
     {"eyeBlinkLeft", "eyeBlinkRight"}},
    {"blinkleft winkleft eyecloseleft eyeclosedleft ウィンク", {"eyeBlinkLeft"}},
    {"blinkright winkright eyecloseright eyeclosedright ウィンク右", {"eyeBlinkRight"}},
    {"eyeswide", {"eyeWideLeft", "eyeWideRight"}},
    {"eyeslookup lookup", {"eyeLookUpLeft", "eyeLookUpRight"}},
    {"eyeslookdown lookdown", {"eyeLookDownLeft", "eyeLookDownRight"}},
    {"eyeslookleft lookleft", {"eyeLookOutLeft", "eyeLookInRight"}},
    {"eyeslookright lookright", {"eyeLookInLeft", "eyeLookOutRight"}},
    {"mouthopen openmouth", {"jawOpen"}},
    {"smile", {"mouthSmileLeft", "mouthSmileRight"}},
    {"smileleft", {"mouthSmileLeft"}},
    {"smileright", {"mouthSmileRight"}},
    {"frown", {"mouthFrownLeft", "mouthFrownRight"}},
    // VRoid's brows are "BRW_Angry" and so on; MMD has a word for each.
    {"browsup browup browraise browsraise eyebrowsup brwsurprised 上",
     {"browInnerUp", "browOuterUpLeft", "browOuterUpRight"}},
    {"brwsorrow browssad browsad 困る", {"browInnerUp"}},
    {"brwjoy brwfun browshappy", {"browOuterUpLeft", "browOuterUpRight"}},
    {"eyesurprised びっくり", {"eyeWideLeft", "eyeWideRight"}},
    {"browraiseouterleft", {"browOuterUpLeft"}},
    {"browraiseouterright", {"browOuterUpRight"}},
    {"browsdown eyebrowsdown browsangry browangry brwangry 怒り 下",
     {"browDownLeft", "browDownRight"}},
};

// Spellings of visemes beside their names in the table of FAP 1.
constexpr std::pair<std::string_view, int> kVowels[] = {
    {"a", 10}, {"あ", 10}, {"e", 11}, {"ee", 11}, {"eh", 11}, {"え", 11},
    {"i", 12}, {"い", 12}, {"o", 13}, {"お", 13}, {"u", 14},  {"う", 14}};

// "viseme_PP", "v_PP" and "PP"; the mouth's shapes of VRoid are "MTH_A".
int viseme_of(std::vector<std::string> words) {
  constexpr std::array<std::string_view, 5> kPrefixes = {"vrc", "viseme", "vis", "v", "mth"};
  while (words.size() > 1 &&
         std::find(kPrefixes.begin(), kPrefixes.end(), words.front()) != kPrefixes.end()) {
    words.erase(words.begin());
  }
  if (words.size() != 1) return -1;
  std::string key = words.front();
  if (key.starts_with("viseme")) key = key.substr(6);
  for (int viseme = 0; viseme < int(fap::kVisemes.size()); ++viseme) {
    const fap::VisemeInfo& row = fap::kVisemes[std::size_t(viseme)];
    if (key == lower_case(row.name) ||
        key == lower_case(row.morph.substr(row.morph.find('_') + 1))) {
      return viseme;
    }
  }
  for (const auto& [name, viseme] : kVowels) {
    if (key == name) return viseme;
  }
  return -1;
}

constexpr int kCalmSmile = 7;

int mood_of(const std::string& key) {
  constexpr std::pair<std::string_view, int> kMoods[] = {
      {"joy", 1},   {"happy", 1},     {"sorrow", 2},       {"sad", 2},
      {"angry", 3}, {"surprised", 6}, {"fun", kCalmSmile}, {"relaxed", kCalmSmile}};
  for (const auto& [name, mood] : kMoods) {
    if (key == name || key == "all" + std::string(name)) return mood;
  }
  return 0;
}

int shape_channel(std::string_view name) {
  const std::optional<int> channel = fap::find_arkit(name);
  return channel && *channel < fap::kArkitShapeCount ? *channel : -1;
}

std::vector<ArkitPart> arkit_parts(const std::string& key) {
  if (const int channel = shape_channel(key); channel >= 0) return {{channel, kBoth}};
  for (const auto& [ending, sides] : {std::pair("left", kLeft), {"right", kRight}}) {
    if (!key.ends_with(ending)) continue;
    const int channel = shape_channel(key.substr(0, key.size() - std::string_view(ending).size()));
    if (channel >= 0) return {{channel, sides}};
  }
  return {};
}

std::vector<ArkitPart> other_parts(const std::string& key) {
  std::vector<ArkitPart> parts;
  for (const OtherName& other : kOthers) {
    if ((" " + std::string(other.keys) + " ").find(" " + key + " ") == std::string::npos) continue;
    for (const std::string_view shape : other.shapes) {
      if (!shape.empty()) parts.push_back({shape_channel(shape), kBoth});
    }
  }
  const int left = shape_channel(key + "left"), right = shape_channel(key + "right");
  // ("mouth" and "jaw" alone would be mouthLeft with mouthRight.)
  if (parts.empty() && left >= 0 && right >= 0 && key != "mouth" && key != "jaw") {
    parts = {{left, kBoth}, {right, kBoth}};
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

bool is_side(int fap, int side) {
  const fap::FapInfo& row = fap::info(fap);
  const bool left = row.name.find("_l_") != std::string_view::npos;
  return row.mirror != 0 && (side == kLeft) == left;
}

// Half of a shape: its own side, and half of what lies in the middle.
fap::Frame half_of(const fap::Frame& whole, int side) {
  fap::Frame half;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const std::int32_t value = whole.value[std::size_t(fap)];
    if (fap::info(fap).mirror == 0) {
      half.set(fap, value / 2);
    } else if (is_side(fap, side)) {
      half.set(fap, value);
    }
  }
  return half;
}

// What a shape does to one lip, and half of what it does between them.
fap::Frame lip_of(const fap::Frame& whole, int lip) {
  constexpr int kUpper[] = {4, 8, 9, 17, 51, 55, 56}, kLower[] = {5, 10, 11, 16, 52, 57, 58, 18};
  const auto has = [](std::span<const int> list, int fap) {
    return std::find(list.begin(), list.end(), fap) != list.end();
  };
  fap::Frame part;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const std::int32_t value = whole.value[std::size_t(fap)];
    const bool upper = has(kUpper, fap), lower = has(kLower, fap);
    if (!upper && !lower) part.set(fap, value / 2);
    if ((upper && lip == 1) || (lower && lip == 2)) part.set(fap, value);
  }
  return part;
}

fap::Frame faps_of(const std::vector<ArkitPart>& parts) {
  fap::Frame sum;
  for (const ArkitPart& part : parts) {
    fap::ArkitFrame weights{};
    weights[std::size_t(part.channel)] = 1;
    fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    if (part.sides != kBoth) frame = half_of(frame, part.sides);
    if (part.lips != kBoth) frame = lip_of(frame, part.lips);
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::int32_t value = frame.value[std::size_t(fap)];
      if (value != 0) sum.set(fap, sum.value[std::size_t(fap)] + value);
    }
  }
  return sum;
}

// "openjaw", "fap3", "fap03openjaw": 0 if it is none, or turns the head, which no shape does.
int fap_of(std::string_view key) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(fap::kFapCount + 1);
    for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      all[std::size_t(f)] = joined(words_of(fap::info(f).name));
    }
    return all;
  }();
  int number = 0;
  if (key.starts_with("fap")) {
    key.remove_prefix(3);
    std::size_t digits = 0;
    for (; digits < key.size() && key[digits] >= '0' && key[digits] <= '9'; ++digits) {
      number = std::min(10 * number + (key[digits] - '0'), fap::kFapCount + 1);
    }
    key.remove_prefix(digits);
  }
  if (!key.empty()) {
    const auto found = std::find(names.begin() + fap::kFirstLowLevel, names.end(), key);
    const int named = found == names.end() ? 0 : int(found - names.begin());
    if (number != 0 && named != number) return 0;
    number = named;
  }
  const bool turns_head = number >= 48 && number <= 50;
  return number < fap::kFirstLowLevel || number > fap::kFapCount || turns_head ? 0 : number;
}

fap::Frame face_of_fap(int number) {
  constexpr int kTwentyDegrees = 34907;  // units of an angle
  fap::Frame face;
  face.set(number, fap::info(number).unit == fap::Unit::angle ? kTwentyDegrees : 1024);
  return face;
}

std::optional<ShapeMeaning> meaning_of_words(const std::vector<std::string>& words) {
  const std::string key = joined(words);
  ShapeMeaning meaning;
  meaning.set = ShapeSet::arkit;
  meaning.parts = arkit_parts(key);
  if (meaning.parts.empty()) {
    meaning.set = ShapeSet::other;
    meaning.parts = other_parts(key);
  }
  if (meaning.parts.empty()) {
    meaning.set = ShapeSet::viseme;
    meaning.viseme = viseme_of(words);
  }
  if (meaning.parts.empty() && meaning.viseme < 0) {
    if (const HouseName* known = find_house_name(key)) {
      meaning.set = known->viseme >= 0 ? ShapeSet::viseme : ShapeSet::arkit;
      meaning.viseme = known->viseme;
      meaning.parts = known->parts;
      meaning.house = known->house;
    }
  }
  if (meaning.parts.empty() && meaning.viseme < 0) {
    meaning.set = ShapeSet::other;
    meaning.mood = mood_of(key);
    meaning.fap = meaning.mood == 0 ? fap_of(key) : 0;
    if (meaning.fap != 0) {
      meaning.house = "faps";
      meaning.faps = face_of_fap(meaning.fap);
      return meaning;
    }
    if (meaning.mood == 0) return std::nullopt;
    meaning.faps = meaning.mood == kCalmSmile ? faps_of(other_parts("smile"))
                                              : head::expression_shape(meaning.mood);
    return meaning;
  }
  meaning.faps = meaning.viseme >= 0 ? head::viseme_shape(meaning.viseme) : faps_of(meaning.parts);
  return meaning;
}

bool is_suffix(const std::string& word) {
  constexpr std::string_view kKnown =
      " bs blendshape shape mesh geo morph target weight value ctrl key ";
  return kKnown.find(" " + word + " ") != std::string_view::npos ||
         word.find_first_not_of("0123456789") == std::string::npos;
}

// The words with the side at the end and without what programs put behind the name proper:
// "L_eyeBlink", "eyeLeftBlink_mesh" and "eyeBlinkLeft.001" are "eye blink left".
std::vector<std::string> in_usual_order(std::vector<std::string> words) {
  while (words.size() > 1 && is_suffix(words.back())) words.pop_back();
  const auto is_side = [](const std::string& word) { return word == "left" || word == "right"; };
  if (std::count_if(words.begin(), words.end(), is_side) == 1) {
    const auto side = std::find_if(words.begin(), words.end(), is_side);
    std::rotate(side, side + 1, words.end());
  }
  return words;
}

}  // namespace

std::optional<ShapeMeaning> meaning_of(std::string_view name) {
  constexpr std::size_t kShortest = 4;  // letters: fewer may be anything
  if (name.size() > 200) return std::nullopt;
  const auto readings = readings_of(name);
  for (const std::vector<std::string>& words : readings) {
    if (auto meaning = meaning_of_words(words)) return meaning;
  }
  for (const std::vector<std::string>& words : readings) {
    const std::vector<std::string> usual = in_usual_order(words);
    if (usual == words || joined(usual).size() < kShortest) continue;
    auto meaning = meaning_of_words(usual);
    if (meaning && meaning->mood == 0 && meaning->fap == 0) return meaning;
  }
  return std::nullopt;
}

std::optional<ShapeMeaning> meaning_of(std::string_view name, std::string_view prefix) {
  auto meaning = meaning_of(name);
  if (meaning || prefix.empty() || !name.starts_with(prefix)) return meaning;
  return meaning_of(name.substr(prefix.size()));
}

std::string common_prefix(const std::vector<std::string>& names) {
  constexpr std::size_t kFewest = 3;      // known names behind it
  constexpr std::size_t kMostPlaces = 8;  // where a prefix may end
  std::map<std::string, std::set<std::string>> known;
  std::map<std::string, std::size_t> unknown;
  for (const std::string& name : names) {
    if (name.size() > 200 || meaning_of(name)) continue;
    std::size_t places = 0;
    for (std::size_t i = 0; i + 1 < name.size() && places < kMostPlaces; ++i) {
      if (std::string_view("_-. ").find(name[i]) == std::string_view::npos) continue;
      ++places;
      const std::string prefix = name.substr(0, i + 1), rest = name.substr(i + 1);
      const auto meaning = meaning_of(rest);
      if (meaning && (meaning->set != ShapeSet::other || !meaning->parts.empty())) {
        known[prefix].insert(rest);
      } else {
        ++unknown[prefix];
      }
    }
  }
  std::string best;
  std::size_t most = kFewest - 1;
  for (const auto& [prefix, rests] : known) {
    if (rests.size() <= most || rests.size() < unknown[prefix]) continue;
    most = rests.size();
    best = prefix;
  }
  return best;
}

}  // namespace animeme::gltf
