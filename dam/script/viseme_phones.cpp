#include "dam/script/viseme_phones.h"

#include <span>

namespace animeme::dam {
namespace {

struct VisemePhone {
  std::string_view name, label;
};

constexpr VisemePhone kRhubarb[] = {{"A", "P"},  {"B", "S"}, {"C", "EH"}, {"D", "AA"}, {"E", "AO"},
                                    {"F", "UW"}, {"G", "F"}, {"H", "L"},  {"X", "SIL"}};

constexpr VisemePhone kPrestonBlair[] = {{"AI", "AA"}, {"E", "EH"},    {"O", "AO"},  {"U", "UW"},
                                         {"WQ", "W"},  {"L", "L"},     {"MBP", "P"}, {"FV", "F"},
                                         {"etc", "S"}, {"rest", "SIL"}};

constexpr VisemePhone kAzure[] = {
    {"0", "SIL"}, {"1", "AX"}, {"2", "AA"}, {"3", "AO"}, {"4", "EH"},  {"5", "ER"},
    {"6", "IY"},  {"7", "UW"}, {"8", "OW"}, {"9", "AW"}, {"10", "OY"}, {"11", "AY"},
    {"12", "HH"}, {"13", "R"}, {"14", "L"}, {"15", "S"}, {"16", "SH"}, {"17", "DH"},
    {"18", "F"},  {"19", "N"}, {"20", "K"}, {"21", "P"}};

constexpr VisemePhone kPolly[] = {
    {"p", "P"},  {"t", "N"},  {"S", "SH"}, {"T", "DH"}, {"f", "F"},  {"k", "K"},  {"i", "IY"},
    {"l", "L"},  {"r", "R"},  {"s", "S"},  {"u", "UW"}, {"a", "AA"}, {"@", "AX"}, {"e", "EY"},
    {"E", "EH"}, {"o", "OW"}, {"O", "AO"}, {"B", "B"},  {"J", "Y"},  {"x", "K"},  {"sil", "SIL"}};

// In the order of the MPEG-4 visemes, whose names these are.
constexpr VisemePhone kOculus[] = {
    {"sil", "SIL"}, {"PP", "P"}, {"FF", "F"}, {"TH", "DH"}, {"DD", "T"},  {"kk", "K"},
    {"CH", "CH"},   {"SS", "S"}, {"nn", "N"}, {"RR", "R"},  {"aa", "AA"}, {"E", "EH"},
    {"I", "IH"},    {"O", "AO"}, {"U", "UW"}, {"ih", "IH"}, {"oh", "AO"}, {"ou", "UW"}};

std::span<const VisemePhone> table_of(VisemeSet set) {
  switch (set) {
    case VisemeSet::rhubarb:
      return kRhubarb;
    case VisemeSet::preston_blair:
      return kPrestonBlair;
    case VisemeSet::azure:
      return kAzure;
    case VisemeSet::polly:
      return kPolly;
    case VisemeSet::oculus:
      return kOculus;
  }
  return {};
}

}  // namespace

std::optional<std::string_view> phone_of_viseme(VisemeSet set, std::string_view name) {
  if (set == VisemeSet::oculus && name.starts_with("viseme_")) name.remove_prefix(7);
  for (const VisemePhone& entry : table_of(set)) {
    if (entry.name == name) return entry.label;
  }
  return std::nullopt;
}

}  // namespace animeme::dam
