#include <cstdio>  // the header of CLD2 uses FILE without it
//
#include <cld2/public/compact_lang_det.h>
#include <cld2/public/encodings.h>

#include "tools/speech/text/guess.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kFewestLetters = 7;
// Of CLD2's share of the first language. What is missing to 100 is what it can't tell, so that it
// is lower for a few words than for many: 88 for "Bonjour" with 7 letters.
constexpr int kLeastShare = 60;

// CLD2 names some languages by codes that are retired; espeak-ng speaks one Norwegian.
std::string code_of(CLD2::Language language) {
  const std::string code = CLD2::LanguageCode(language);
  if (code == "no" || code == "nn") return "nb";
  if (code == "iw") return "he";
  if (code == "zh" || code == "zh-Hant") return "cmn";
  return code;
}

bool is_long_enough(std::u32string_view text) {
  std::size_t letters = 0, words = 0;
  bool inside = false;
  for (const char32_t c : text) {
    const bool letter = is_letter(c);
    letters += letter ? 1 : 0;
    words += letter && !inside ? 1 : 0;
    inside = letter || (inside && kind_of(c) == Kind::mark) || (inside && c == U'\'');
  }
  return letters >= kFewestLetters && words >= 2;
}

}  // namespace

bool can_guess() { return true; }

std::string guess_language(std::u32string_view text) {
  if (!is_long_enough(text)) return {};
  const std::string bytes = utf8(text);
  const CLD2::CLDHints hints{nullptr, nullptr, CLD2::UNKNOWN_ENCODING, CLD2::UNKNOWN_LANGUAGE};
  CLD2::Language languages[3] = {};
  int shares[3] = {}, looked_at = 0, valid = 0;
  double scores[3] = {};
  bool reliable = false;
  CLD2::ExtDetectLanguageSummaryCheckUTF8(bytes.data(), int(bytes.size()), true, &hints,
                                          CLD2::kCLDFlagBestEffort, languages, shares, scores,
                                          nullptr, &looked_at, &reliable, &valid);
  if (!reliable || shares[0] < kLeastShare || languages[0] == CLD2::UNKNOWN_LANGUAGE) return {};
  return code_of(languages[0]);
}

}  // namespace animeme::text
