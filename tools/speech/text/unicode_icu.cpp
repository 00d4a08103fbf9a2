#include <unicode/uchar.h>
#include <unicode/uloc.h>
#include <unicode/ulocdata.h>
#include <unicode/uscript.h>
#include <unicode/uset.h>
#include <unicode/utrans.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/icu_internal.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

std::string likely(const std::string& locale, bool language) {
  std::array<char, ULOC_FULLNAME_CAPACITY> full{};
  UErrorCode status = U_ZERO_ERROR;
  uloc_addLikelySubtags(locale.c_str(), full.data(), std::int32_t(full.size()), &status);
  std::array<char, 32> part{};
  if (language) {
    uloc_getLanguage(full.data(), part.data(), std::int32_t(part.size()), &status);
  } else {
    uloc_getScript(full.data(), part.data(), std::int32_t(part.size()), &status);
  }
  return U_FAILURE(status) ? std::string() : std::string(part.data());
}

// Scripts of several: Japanese is written in "Jpan".
void add_script(UScriptCode code, std::vector<std::string>& out) {
  if (code == USCRIPT_JAPANESE) {
    for (const char* script : {"Hani", "Hira", "Kana"}) out.emplace_back(script);
  } else if (code == USCRIPT_KOREAN) {
    out.emplace_back("Hang");
  } else if (code == USCRIPT_SIMPLIFIED_HAN || code == USCRIPT_TRADITIONAL_HAN) {
    out.emplace_back("Hani");
  } else {
    out.emplace_back(uscript_getShortName(code));
  }
}

using Transliterator = Owned<UTransliterator, &utrans_close>;

// Made once: to make one takes a while. Calls share it, one at a time.
std::string transliterate(const char16_t* name, char32_t code) {
  static std::mutex mutex;
  static std::map<std::u16string, Transliterator> made;
  const std::lock_guard lock(mutex);
  Transliterator& own = made[name];
  if (!own) {
    UErrorCode status = U_ZERO_ERROR;
    own.reset(utrans_openU(name, -1, UTRANS_FORWARD, nullptr, 0, nullptr, &status));
    if (U_FAILURE(status)) return {};
  }
  std::string utf8;
  dam::append_utf8(utf8, code);
  std::u16string text = utf16_of(utf8);
  std::array<UChar, 64> buffer{};
  std::copy(text.begin(), text.end(), buffer.begin());
  std::int32_t length = std::int32_t(text.size()), limit = length;
  UErrorCode status = U_ZERO_ERROR;
  utrans_transUChars(own.get(), buffer.data(), &length, std::int32_t(buffer.size()), 0, &limit,
                     &status);
  return U_FAILURE(status) ? std::string() : utf8_of(buffer.data(), length);
}

char32_t one_character(const char16_t* name, char32_t code) {
  if (script_of(code) != "Hani") return code;
  const std::string out = transliterate(name, code);
  std::string_view rest = out;
  if (rest.empty()) return code;
  const char32_t other = dam::take_code_point(rest);
  return rest.empty() ? other : code;
}

}  // namespace

bool unicode_here() { return true; }

Kind kind_of(char32_t code) {
  const auto c = UChar32(code);
  if (code == 0x200D || code == 0x20E3 || (code >= 0xFE00 && code <= 0xFE0F) ||
      (code >= 0xE0020 && code <= 0xE007F)) {
    return Kind::emoji;
  }
  if (code > 0xFF && (u_hasBinaryProperty(c, UCHAR_EXTENDED_PICTOGRAPHIC) != 0 ||
                      u_hasBinaryProperty(c, UCHAR_EMOJI_MODIFIER) != 0 ||
                      u_hasBinaryProperty(c, UCHAR_REGIONAL_INDICATOR) != 0)) {
    return Kind::emoji;
  }
  const auto mask = U_MASK(u_charType(c));
  if ((mask & (U_GC_L_MASK | U_GC_NL_MASK)) != 0) return Kind::letter;
  if ((mask & U_GC_M_MASK) != 0) return Kind::mark;
  if ((mask & (U_GC_ND_MASK | U_GC_NO_MASK)) != 0) return Kind::digit;
  if ((mask & U_GC_S_MASK) != 0) return Kind::symbol;
  if ((mask & (U_GC_Z_MASK | U_GC_C_MASK)) != 0) return Kind::blank;
  return Kind::punctuation;
}

bool is_vowel_sign(char32_t code) {
  const auto c = UChar32(code);
  return kind_of(code) == Kind::mark &&
         u_getIntPropertyValue(c, UCHAR_INDIC_SYLLABIC_CATEGORY) == U_INSC_VOWEL_DEPENDENT;
}

int digit_value(char32_t code) { return u_charDigitValue(UChar32(code)); }

char32_t lower(char32_t code) { return char32_t(u_tolower(UChar32(code))); }

std::string script_of(char32_t code) {
  UErrorCode status = U_ZERO_ERROR;
  const UScriptCode script = uscript_getScript(UChar32(code), &status);
  const char* name = U_FAILURE(status) ? nullptr : uscript_getShortName(script);
  return name == nullptr ? "Zzzz" : name;
}

std::string script_name(std::string_view script) {
  if (script == "Hani") return "Chinese";
  if (script == "Hira" || script == "Kana") return "Japanese";
  if (script == "Hang") return "Korean";
  std::array<UScriptCode, 8> codes{};
  UErrorCode status = U_ZERO_ERROR;
  const std::int32_t count = uscript_getCode(std::string(script).c_str(), codes.data(),
                                             std::int32_t(codes.size()), &status);
  const char* name = U_FAILURE(status) || count < 1 ? nullptr : uscript_getName(codes[0]);
  return name == nullptr ? std::string(script) : std::string(name);
}

std::vector<std::string> scripts_of_language(std::string_view language) {
  const std::string locale = locale_of(language);
  std::vector<std::string> out;
  std::array<UScriptCode, 8> codes{};
  UErrorCode status = U_ZERO_ERROR;
  const std::int32_t count =
      uscript_getCode(locale.c_str(), codes.data(), std::int32_t(codes.size()), &status);
  if (U_SUCCESS(status) && locale.find('_') != std::string::npos) {
    for (std::int32_t i = 0; i < count; ++i) add_script(codes[std::size_t(i)], out);
    if (!out.empty()) return out;
  }
  const std::string script = likely(locale, false);
  UErrorCode again = U_ZERO_ERROR;
  const std::int32_t found =
      script.empty() ? 0 : uscript_getCode(script.c_str(), codes.data(), 1, &again);
  if (U_SUCCESS(again) && found == 1) add_script(codes[0], out);
  return out;
}

std::string language_of_script(std::string_view script) {
  const std::string language = likely("und_" + std::string(script), true);
  return language == "und" || (language == "en" && script != "Latn") ? std::string() : language;
}

std::string language_name(std::string_view language) {
  const std::string locale = locale_of(language);
  const std::string name =
      written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* status) {
        return uloc_getDisplayLanguage(locale.c_str(), "en", out, size, status);
      });
  return name.empty() ? std::string(language) : name;
}

std::vector<std::u32string> letters_of_language(std::string_view language) {
  const std::string locale = locale_of(language);
  if (!has_locale(locale)) return {};
  UErrorCode status = U_ZERO_ERROR;
  const Owned<ULocaleData, &ulocdata_close> data(ulocdata_open(locale.c_str(), &status));
  if (U_FAILURE(status)) return {};
  const Owned<USet, &uset_close> set(
      ulocdata_getExemplarSet(data.get(), nullptr, 0, ULOCDATA_ES_STANDARD, &status));
  if (U_FAILURE(status) || !set) return {};
  std::vector<std::u32string> letters;
  const std::int32_t count = uset_getItemCount(set.get());
  for (std::int32_t i = 0; i < count; ++i) {
    UChar32 first = 0, last = 0;
    std::array<UChar, 32> item{};
    const std::int32_t length =
        uset_getItem(set.get(), i, &first, &last, item.data(), std::int32_t(item.size()), &status);
    if (U_FAILURE(status)) return {};
    if (length == 0) {
      for (UChar32 c = first; c <= last; ++c) letters.push_back({char32_t(c)});
      continue;
    }
    std::u32string text;
    const std::string utf8 = utf8_of(item.data(), length);
    for (std::string_view rest = utf8; !rest.empty();) text += dam::take_code_point(rest);
    letters.push_back(std::move(text));
  }
  return letters;
}

char32_t simplified(char32_t code) { return one_character(u"Traditional-Simplified", code); }
char32_t traditional(char32_t code) { return one_character(u"Simplified-Traditional", code); }

std::string pinyin_of(char32_t code) {
  if (script_of(code) != "Hani") return {};
  std::string out = transliterate(u"Han-Latin; Latin-NumericPinyin", code);
  // Rime and espeak-ng write v.
  if (const std::size_t round = out.find("ü"); round != std::string::npos) {
    out.replace(round, std::string_view("ü").size(), "v");
  }
  const bool ascii = std::all_of(out.begin(), out.end(), [](char c) { return c > 0; });
  if (!out.empty() && (!ascii || out.find(' ') != std::string::npos)) return {};
  return out;
}

}  // namespace animeme::text
