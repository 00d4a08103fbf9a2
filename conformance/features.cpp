#include "conformance/features.h"

#include <algorithm>
#include <map>

#include "codec/syntax/body_tables.h"
#include "fap/tables.h"

namespace animeme::conformance {
namespace {

std::vector<std::string> numbers(int first, int last) {
  std::vector<std::string> out;
  for (int n = first; n <= last; ++n) out.push_back(std::to_string(n));
  return out;
}

// "g01.type0" ...
std::vector<std::string> group_types(int groups, std::initializer_list<int> types) {
  std::vector<std::string> out;
  for (int g = 1; g <= groups; ++g) {
    for (const int type : types)
      out.push_back("g" + two_digits(g) + ".type" + std::to_string(type));
  }
  return out;
}

// "0000" .. "1111": I max, I min, P max, P min.
std::vector<std::string> flags() {
  std::vector<std::string> out;
  for (int n = 0; n < 16; ++n) {
    std::string text;
    for (int bit = 3; bit >= 0; --bit) text += char('0' + ((n >> bit) & 1));
    out.push_back(text);
  }
  return out;
}

struct Place {
  const Family* family;
  std::size_t order;
};

const std::map<std::string, Place, std::less<>>& places() {
  static const std::map<std::string, Place, std::less<>> map = [] {
    std::map<std::string, Place, std::less<>> out;
    for (const Family& family : families()) {
      for (const std::string& member : family.members) {
        out.emplace(std::string(family.name) + "." + member, Place{&family, out.size()});
      }
    }
    return out;
  }();
  return map;
}

}  // namespace

const std::vector<Family>& families() {
  static const std::vector<Family> table = {
      {"object",
       "face, body or both in a plane, and neither",
       "2",
       'C',
       {"face", "body", "face_and_body", "nothing", "mixed"}},
      {"plane", "intra and predictive planes", "2", 'C', {"intra", "predictive", "intra_again"}},
      {"start", "object start codes", "1", 'C', {"object"}},
      {"start_old", "start codes of the 1999 edition", "1", 'S', {"object", "plane"}},
      {"start_again", "objects one behind the other in a stream", "1", 'M', {"object"}},
      {"plane_code", "plane start codes", "1", 'S', {"none", "intra", "all", "some"}},
      {"header", "headers before the object", "1", 'S', {"sequence", "visual_object", "user_data"}},
      {"end", "how the stream ends", "1", 'C', {"stuffed", "aligned"}},
      {"end_odd",
       "ends that the standard does not have",
       "1",
       'T',
       {"unstuffed", "missing", "bytes_behind"}},
      {"rate", "frame rates", "2", 'C', {"whole", "default"}},
      {"rate_odd",
       "sixteenths, 1000/1001 and changes of the rate",
       "2",
       'S',
       {"sixteenths", "offset", "change"}},
      {"time", "time codes", "2", 'S', {"code"}},
      {"skip", "skipped frames", "2", 'S', {"0", "1_to_13", "14", "15", "16_to_29", "30_or_more"}},
      {"mask", "mask type of each face group", "3.1", 'C',
       group_types(fap::kGroupCount, {0, 1, 2, 3})},
      {"mask_empty", "no FAP coded", "3.1", 'S', {"face"}},
      {"mask_change", "another mask at a later intra plane", "3.1", 'S', {"face", "body"}},
      {"gender", "suggested gender", "3.1", 'C', {"female", "male"}},
      {"quant", "fap_quant", "5", 'S', numbers(1, 31)},
      {"quant_zero", "no quantisation", "5", 'S', {"face", "body"}},
      {"quant_change", "another quantiser at a later intra plane", "5", 'S', {"face", "body"}},
      {"range_flags", "which ranges a face plane sends (I max, I min, P max, P min)", "3.2", 'C',
       flags()},
      {"range", "sizes of ranges", "3.2", 'C', {"one_symbol", "smallest", "largest"}},
      {"range_default", "ranges that were never sent", "3.2", 'S', {"intra", "predictive"}},
      {"range_kept", "ranges of an earlier intra plane", "3.2", 'S', {"same_quant"}},
      {"range_rescaled", "ranges kept over a change of fap_quant", "3.2", '?', {"face", "body"}},
      {"coder", "arithmetic coder", "4", 'C', {"adaptive"}},
      {"coder_trap",
       "stuffing, zero runs, halving",
       "4",
       'S',
       {"stuffed", "zeros_behind_segment", "start_code_inside", "halved", "empty_segment"}},
      {"viseme", "FAP 1: viseme_select1", "6", 'C', numbers(0, 14)},
      {"viseme_second", "FAP 1: viseme_select2", "6", 'C', numbers(0, 14)},
      {"viseme_flag", "FAP 1: blend and definition", "6", 'S', {"blend", "def"}},
      {"expression", "FAP 2: expression_select1", "6", 'S', numbers(0, 6)},
      {"expression_second", "FAP 2: expression_select2", "6", 'S', numbers(0, 6)},
      {"expression_flag",
       "FAP 2: intensities and flags",
       "6",
       'S',
       {"intensity", "init_face", "def"}},
      {"body_mask", "mask type of each body group", "7", 'S',
       group_types(fba::kBodyGroupCount, {0, 1, 3})},
      {"body_quant", "body quantiser index", "7", 'S', numbers(1, 31)},
      {"body_flags", "which ranges a body plane sends", "7", 'S', flags()},
      {"damage",
       "damaged streams: what is wrong",
       "1",
       'S',
       {"dct", "marker", "truncated", "stuffed_bit", "rate_zero", "body_type2", "garbage",
        "predictive_first", "no_end_code", "foreign_object", "not_fba"}},
      {"recovery", "what comes after the damage", "1", 'M', {"nothing", "next_intra"}},
  };
  return table;
}

const Family* family_of(std::string_view feature) {
  const auto found = places().find(feature);
  return found == places().end() ? nullptr : found->second.family;
}

std::vector<std::string> sections_of(std::span<const std::string> features) {
  std::vector<std::string> out;
  for (const std::string& feature : features) {
    const Family* family = family_of(feature);
    if (family != nullptr) out.emplace_back(family->section);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

char certainty_of(std::span<const std::string> features) {
  constexpr std::string_view kOrder = "CSMT?";
  std::size_t worst = 0;
  for (const std::string& feature : features) {
    const Family* family = family_of(feature);
    if (family != nullptr) worst = std::max(worst, kOrder.find(family->certainty));
  }
  return kOrder[worst];
}

void sort_features(std::vector<std::string>& features) {
  const auto order = [](const std::string& feature) {
    const auto found = places().find(feature);
    return found == places().end() ? places().size() : found->second.order;
  };
  std::sort(features.begin(), features.end(), [&](const std::string& a, const std::string& b) {
    return std::pair(order(a), std::string_view(a)) < std::pair(order(b), std::string_view(b));
  });
  features.erase(std::unique(features.begin(), features.end()), features.end());
}

}  // namespace animeme::conformance
