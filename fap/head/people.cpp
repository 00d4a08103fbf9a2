// Descriptions of people, and the heads that have names.
#include "fap/head/people.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>

namespace animeme::head {

const std::array<std::string_view, 9> kPeople = {"woman", "man",  "child", "amara", "mei",
                                                 "rosa",  "omar", "kenji", "george"};
const std::array<std::string_view, 8> kHairColours = {"black", "brown",  "auburn", "blond",
                                                      "red",   "ginger", "grey",   "white"};
const std::array<std::string_view, 7> kHairForms = {"bob", "short", "fringe", "long",
                                                    "bun", "curly", "bald"};
const std::array<std::string_view, 6> kEyeColours = {"brown", "hazel", "green",
                                                     "blue",  "grey",  "black"};

namespace {

constexpr std::array<std::uint32_t, 8> kHairValues = {0x17120F, 0x3F2A1D, 0x4A2A1B, 0xB58A4E,
                                                      0x7A2E14, 0xA8551F, 0x8A8884, 0xD9D6CF};
constexpr std::array<std::uint32_t, 6> kEyeValues = {0x5A3A1E, 0x7A5A2A, 0x5F6A42,
                                                     0x54707F, 0x75808A, 0x2A1A10};

// What a skin type looks like; lips and cheeks differ less from darker skin.
struct SkinTone {
  std::uint32_t skin, lips, cheeks;
};
constexpr std::array<SkinTone, 6> kSkins = {{{0xF2C4A8, 0xD07A74, 0xEB9A84},
                                             {0xE8AC88, 0xC4605C, 0xDE8468},
                                             {0xD6A07C, 0xB66A5C, 0xCB8668},
                                             {0xB48260, 0x9A5A4C, 0xA86C50},
                                             {0x8A5A40, 0x7C453A, 0x825036},
                                             {0x5E4433, 0x63392F, 0x5C3C2A}}};

double between(double a, double b, double t) { return a + (b - a) * t; }

std::uint32_t blend(std::uint32_t a, std::uint32_t b, double t) {
  std::uint32_t mixed = 0;
  for (int shift = 0; shift <= 16; shift += 8) {
    const double value = between((a >> shift) & 255u, (b >> shift) & 255u, t);
    mixed |= std::uint32_t(value + 0.5) << shift;
  }
  return mixed;
}

double ramp(double from, double to, double value) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

// Sizes that growing changes, most of them from those of a child.
constexpr double HeadParameters::*kGrowing[] = {
    &HeadParameters::scale,       &HeadParameters::skull_width,  &HeadParameters::skull_height,
    &HeadParameters::face_width,  &HeadParameters::jaw_width,    &HeadParameters::chin_drop,
    &HeadParameters::chin_size,   &HeadParameters::cheek,        &HeadParameters::brow_ridge,
    &HeadParameters::neck,        &HeadParameters::eye_distance, &HeadParameters::eye_radius,
    &HeadParameters::eye_opening, &HeadParameters::eye_width,    &HeadParameters::iris,
    &HeadParameters::nose_length, &HeadParameters::nose_size,    &HeadParameters::nose_bridge,
    &HeadParameters::mouth_drop,  &HeadParameters::mouth_width,  &HeadParameters::lip_fullness,
    &HeadParameters::brow_height, &HeadParameters::ear};

constexpr double kChildsAge = 7;
constexpr double kGrown = 19;

struct Person {
  HeadParameters head;
  double age;
};

HeadParameters amara() {
  HeadParameters p;
  p.lip_fullness = 1.24;
  p.nose_size = 0.75;
  p.nose_length = 3.45;
  p.face_width = 5.9;
  p.cheek = 2.2;
  p.mouth_width = 2.12;
  p.hair = HairStyle::curly;
  p.hair_colour = kHairValues[0];
  p.brow_colour = 0x17120F;
  p.iris_colour = kEyeValues[5];
  p.cloth_colour = 0xC9892E;
  return p;
}

HeadParameters mei() {
  HeadParameters p;
  p.eye_opening = 1.16;
  p.eye_width = 2.95;
  p.eye_radius = 1.66;
  p.nose_length = 3.5;
  p.nose_size = 0.62;
  p.face_width = 6.0;
  p.lashes = 0.26;
  p.brow_thickness = 0.22;
  p.hair = HairStyle::lengthy;
  p.hair_colour = kHairValues[0];
  p.brow_colour = 0x1E1714;
  p.iris_colour = kEyeValues[5];
  p.cloth_colour = 0x7D3046;
  return p;
}

HeadParameters rosa() {
  HeadParameters p;
  p.face_width = 6.1;
  p.cheek = 2.25;
  p.nose_size = 0.7;
  p.hair = HairStyle::bun;
  p.hair_colour = 0x2B2220;
  p.brow_colour = 0x2E2522;
  p.iris_colour = kEyeValues[0];
  p.cloth_colour = 0x3E5A49;
  p.glasses = Glasses::round;
  return p;
}

// `name`: one of kPeople.
Person person(std::string_view name) {
  const auto with_skin = [](HeadParameters p, std::size_t type) {
    const SkinTone& tone = kSkins[type - 1];
    p.skin_colour = tone.skin;
    p.lip_colour = tone.lips;
    p.cheek_colour = tone.cheeks;
    return p;
  };
  if (name == "amara") return {with_skin(amara(), 6), 28};
  if (name == "mei") return {with_skin(mei(), 2), 24};
  if (name == "rosa") return {with_skin(rosa(), 3), 64};
  if (name == "omar" || name == "kenji" || name == "george") {
    HeadParameters p = *head_parameters("man");
    if (name == "omar") {
      p.nose_size = 0.84;
      p.nose_bridge = 0.5;
      p.lip_fullness = 0.95;
      p.brow_thickness = 0.4;
      p.hair_colour = kHairValues[0];
      p.brow_colour = 0x17120F;
      p.iris_colour = kEyeValues[0];
      p.beard = Beard::full;
      p.cloth_colour = 0x2F4F4A;
      return {with_skin(p, 4), 36};
    }
    if (name == "kenji") {
      p.eye_opening = 1.0;
      p.eye_radius = 1.55;
      p.nose_bridge = 0.12;
      p.nose_size = 0.74;
      p.face_width = 6.45;
      p.jaw_width = 3.75;
      p.brow_ridge = 0.18;
      p.brow_thickness = 0.3;
      p.hair_colour = kHairValues[0];
      p.brow_colour = 0x1A1513;
      p.iris_colour = kEyeValues[5];
      p.glasses = Glasses::square;
      p.cloth_colour = 0x3A3F4C;
      return {with_skin(p, 3), 48};
    }
    p.nose_size = 0.86;
    p.ear = 1.5;
    p.brow_thickness = 0.42;
    p.hair = HairStyle::bald;
    p.iris_colour = kEyeValues[3];
    p.beard = Beard::stubble;
    p.cloth_colour = 0x6B4A3A;
    return {with_skin(p, 1), 72};
  }
  return {*head_parameters(name), name == "child" ? kChildsAge : name == "man" ? 32.0 : 28.0};
}

// Sizes and colours at an age, from those of the person's own.
void grow_to(double age, Person& person, bool own_hair_colour) {
  HeadParameters& p = person.head;
  const double young = 1 - ramp(kChildsAge, kGrown, age);
  const double was_young = 1 - ramp(kChildsAge, kGrown, person.age);
  const HeadParameters small = *head_parameters("child");
  const HeadParameters large;
  if (was_young > young) {
    const double t = (was_young - young) / was_young;
    for (const auto size : kGrowing) p.*size = between(p.*size, large.*size, t);
  } else if (young > was_young) {
    const double t = (young - was_young) / (1 - was_young);
    for (const auto size : kGrowing) p.*size = between(p.*size, small.*size, t);
  }
  const double old = ramp(35, 80, age);
  p.lines = ramp(30, 75, age);
  p.lip_fullness *= 1 - 0.25 * old;
  p.eye_opening *= 1 - 0.14 * old;
  p.nose_size *= 1 + 0.08 * old;
  p.ear *= 1 + 0.08 * old;
  p.brow_height -= 0.12 * old;
  p.lashes *= 1 - 0.4 * old;
  p.cheek_colour = blend(p.cheek_colour, p.skin_colour, 0.35 * old);
  p.lip_colour = blend(p.lip_colour, p.skin_colour, 0.35 * old);
  if (!own_hair_colour) p.hair_colour = blend(p.hair_colour, kHairValues[6], ramp(45, 70, age));
  if (!own_hair_colour) p.hair_colour = blend(p.hair_colour, kHairValues[7], ramp(70, 90, age));
  p.brow_colour = blend(p.brow_colour, kHairValues[6], 0.8 * ramp(55, 80, age));
}

template <std::size_t N>
std::string list_of(const std::array<std::string_view, N>& names) {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    text += i == 0 ? "" : i + 1 < N ? ", " : " or ";
    text += names[i];
  }
  return text;
}

template <std::size_t N>
std::optional<std::size_t> index_in(const std::array<std::string_view, N>& names,
                                    std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return std::size_t(found - names.begin());
}

std::optional<std::uint32_t> hexadecimal_colour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
  if (error != std::errc() || end != text.data() + 7) return std::nullopt;
  return value;
}

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Error wrong(std::string_view word, const std::string& choices) {
  return make_error(Code::invalid_argument,
                    "\"" + std::string(word) + "\" is not understood: " + choices);
}

// What the words ask for besides parameters of the head.
struct Wishes {
  std::optional<double> age;
  bool hair_colour = false;
};

std::optional<Error> set_skin(std::string_view word, std::string_view value, HeadParameters& p) {
  if (const auto colour = hexadecimal_colour(value)) {
    p.skin_colour = *colour;
    p.lip_colour = blend(*colour, 0x8A2A2A, 0.45);
    p.cheek_colour = blend(*colour, 0xB04A3A, 0.3);
    return std::nullopt;
  }
  const auto type = whole_number(value);
  if (!type || *type < 1 || *type > int(kSkins.size())) {
    return wrong(word, "skin is 1 (very light) to 6 (very dark), or a colour such as #C08A60");
  }
  const SkinTone& tone = kSkins[std::size_t(*type - 1)];
  p.skin_colour = tone.skin;
  p.lip_colour = tone.lips;
  p.cheek_colour = tone.cheeks;
  return std::nullopt;
}

std::optional<Error> set_hair(std::string_view word, std::string_view value, HeadParameters& p,
                              Wishes& wishes) {
  while (!value.empty()) {
    const std::size_t dash = value.find('-');
    const std::string_view part = value.substr(0, dash);
    value = dash == std::string_view::npos ? "" : value.substr(dash + 1);
    if (const auto form = index_in(kHairForms, part)) {
      p.hair = HairStyle(*form);
      continue;
    }
    const auto named = index_in(kHairColours, part);
    const auto colour = named ? std::optional(kHairValues[*named]) : hexadecimal_colour(part);
    if (!colour) {
      return wrong(word, "hair is a colour (" + list_of(kHairColours) + ", or #RRGGBB), a form (" +
                             list_of(kHairForms) + "), or both, such as black-bob");
    }
    p.hair_colour = *colour;
    p.brow_colour = blend(*colour, 0x201510, 0.5);
    wishes.hair_colour = true;
  }
  return std::nullopt;
}

std::optional<Error> apply(std::string_view word, HeadParameters& p, Wishes& wishes) {
  const std::size_t equals = word.find('=');
  const std::string_view key = word.substr(0, equals);
  const bool bare = equals == std::string_view::npos;
  const std::string_view value = bare ? "" : word.substr(equals + 1);
  if (key == "skin") return set_skin(word, value, p);
  if (key == "hair" && !value.empty()) return set_hair(word, value, p, wishes);
  if (key == "eyes") {
    const auto named = index_in(kEyeColours, value);
    const auto colour = named ? std::optional(kEyeValues[*named]) : hexadecimal_colour(value);
    if (!colour) return wrong(word, "eyes are " + list_of(kEyeColours) + ", or #RRGGBB");
    p.iris_colour = *colour;
    return std::nullopt;
  }
  if (key == "clothes") {
    const auto colour = hexadecimal_colour(value);
    if (!colour) return wrong(word, "clothes have a colour such as #3F6F86");
    p.cloth_colour = *colour;
    return std::nullopt;
  }
  if (key == "age") {
    const auto years = whole_number(value);
    if (!years || *years < 5 || *years > 90) return wrong(word, "age is 5 to 90 years");
    wishes.age = *years;
    return std::nullopt;
  }
  if (key == "glasses") {
    if (!bare && value != "round" && value != "square" && value != "none") {
      return wrong(word, "glasses are round, square or none");
    }
    p.glasses = value == "none"     ? Glasses::none
                : value == "square" ? Glasses::square
                                    : Glasses::round;
    return std::nullopt;
  }
  if (key == "beard") {
    if (!bare && value != "stubble" && value != "full" && value != "none") {
      return wrong(word, "a beard is stubble, full or none");
    }
    p.beard = value == "none" ? Beard::none : value == "stubble" ? Beard::stubble : Beard::full;
    return std::nullopt;
  }
  return wrong(word, "words are skin=, hair=, eyes=, age=, glasses, beard and clothes=");
}

}  // namespace

bool names_person(std::string_view text) {
  return index_in(kPeople, text.substr(0, text.find(':'))).has_value();
}

Result<HeadParameters> parse_head(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  if (!names_person(text)) {
    return make_error(Code::not_found, "no built-in head is called \"" + std::string(name) +
                                           "\"; there are " + list_of(kPeople));
  }
  Person chosen = person(name);
  Wishes wishes;
  std::string_view rest = text.substr(name.size());
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const std::string_view word = rest.substr(0, rest.find(':'));
    rest.remove_prefix(word.size());
    if (auto error = apply(word, chosen.head, wishes)) return std::move(*error);
  }
  const bool plain = name == "woman" || name == "man" || name == "child";
  if (wishes.age || !plain) grow_to(wishes.age.value_or(chosen.age), chosen, wishes.hair_colour);
  chosen.head.name = text;
  return std::move(chosen.head);
}

}  // namespace animeme::head
