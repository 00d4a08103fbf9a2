#include <unicode/ucurr.h>
#include <unicode/udat.h>
#include <unicode/uloc.h>
#include <unicode/unum.h>
#include <unicode/unumberformatter.h>
#include <unicode/ustring.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/icu_internal.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {

std::string utf8_of(const UChar* text, std::int32_t length) {
  std::string out(std::size_t(length) * 3 + 1, '\0');
  std::int32_t written = 0;
  UErrorCode status = U_ZERO_ERROR;
  u_strToUTF8(out.data(), std::int32_t(out.size()), &written, text, length, &status);
  if (U_FAILURE(status)) return {};
  out.resize(std::size_t(written));
  return out;
}

std::u16string utf16_of(std::string_view text) {
  std::u16string out(text.size() + 1, u'\0');
  std::int32_t written = 0;
  UErrorCode status = U_ZERO_ERROR;
  u_strFromUTF8(out.data(), std::int32_t(out.size()), &written, text.data(),
                std::int32_t(text.size()), &status);
  if (U_FAILURE(status)) return {};
  out.resize(std::size_t(written));
  return out;
}

// Codes of espeak-ng that CLDR knows by another name.
std::string locale_of(std::string_view language) {
  std::string tag = dam::lower_case(language.substr(0, language.find('+')));
  if (tag == "cmn" || tag.starts_with("cmn-")) return "zh";
  if (tag == "nb" || tag.starts_with("nb-")) tag.replace(0, 2, "no");
  if (tag == "hyw") return "hy";
  if (tag == "fa-latn") return "fa_Latn";
  // Variants of espeak-ng's own: en-gb-x-rp, en-gb-scotland.
  std::size_t parts = 0, end = 0;
  while (end < tag.size() && parts < 2) {
    end = std::min(tag.find_first_of("-_", end + 1), tag.size());
    ++parts;
  }
  tag.resize(end);
  std::array<char, ULOC_FULLNAME_CAPACITY> locale{};
  UErrorCode status = U_ZERO_ERROR;
  uloc_forLanguageTag(tag.c_str(), locale.data(), std::int32_t(locale.size()), nullptr, &status);
  return U_FAILURE(status) ? std::string() : std::string(locale.data());
}

namespace {

bool available(std::string_view own) {
  const std::int32_t count = uloc_countAvailable();
  for (std::int32_t i = 0; i < count; ++i) {
    const std::string_view name = uloc_getAvailable(i);
    if (name.starts_with(own) && (name.size() == own.size() || name[own.size()] == '_')) {
      return true;
    }
  }
  return false;
}

}  // namespace

// ICU answers for any locale, by its root data if there are no others.
bool has_locale(const std::string& locale) {
  std::array<char, ULOC_LANG_CAPACITY> language{};
  UErrorCode status = U_ZERO_ERROR;
  uloc_getLanguage(locale.c_str(), language.data(), std::int32_t(language.size()), &status);
  if (U_FAILURE(status) || language[0] == '\0') return false;
  // Hundreds of names are looked at, at every number: once is enough.
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = known.try_emplace(language.data(), false);
  if (is_new) found->second = available(language.data());
  return found->second;
}

std::string language_code(std::string_view language) {
  const std::string code = uloc_getISO3Language(locale_of(language).c_str());
  return code.size() == 3 ? code : "und";
}

namespace {

using Numbers = Owned<UNumberFormat, &unum_close>;

// The first that the language has; none: no such number.
std::vector<std::u16string_view> rules_of(NumberForm form) {
  switch (form) {
    case NumberForm::ordinal:
      return {u"%spellout-ordinal-masculine", u"%spellout-ordinal"};
    case NumberForm::ordinal_feminine:
      return {u"%spellout-ordinal-feminine", u"%spellout-ordinal"};
    case NumberForm::cardinal_and:
      return {u"%spellout-cardinal-verbose", u""};
    case NumberForm::year:
      return {u"%spellout-numbering-year", u""};
    default:
      return {u""};
  }
}

Numbers open_numbers(const std::string& locale, NumberForm form) {
  UErrorCode status = U_ZERO_ERROR;
  const auto style = form == NumberForm::ordinal_digits ? UNUM_ORDINAL : UNUM_SPELLOUT;
  Numbers format(unum_open(style, nullptr, 0, locale.c_str(), nullptr, &status));
  if (U_FAILURE(status)) return {};
  for (const std::u16string_view rule : rules_of(form)) {
    if (rule.empty()) return format;
    UErrorCode known = U_ZERO_ERROR;
    unum_setTextAttribute(format.get(), UNUM_DEFAULT_RULESET, rule.data(),
                          std::int32_t(rule.size()), &known);
    if (U_SUCCESS(known)) return format;
  }
  return {};
}

}  // namespace

// Made once, since it takes a while. Calls share them, one at a time.
std::string spell_number(std::string_view digits, std::string_view language, NumberForm form) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, NumberForm>, Numbers> made;
  const std::string locale = locale_of(language);
  const std::lock_guard lock(mutex);
  auto known = made.find({locale, form});
  if (known == made.end()) {
    Numbers format = has_locale(locale) ? open_numbers(locale, form) : Numbers();
    known = made.emplace(std::pair{locale, form}, std::move(format)).first;
  }
  if (!known->second) return {};
  const std::string ascii(digits);
  return written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
    return unum_formatDecimal(known->second.get(), ascii.c_str(), std::int32_t(ascii.size()), out,
                              size, nullptr, error);
  });
}

bool is_date(int year, int month, int day) {
  if (year < 1 || year > 9999 || month < 1 || month > 12 || day < 1) return false;
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return day <= kDays[std::size_t(month - 1)] + (month == 2 && leap ? 1 : 0);
}

std::string spell_date(int year, int month, int day, std::string_view language) {
  // Thai and others count years of their own; the numbers given are Gregorian.
  const std::string locale = locale_of(language);
  if (!has_locale(locale)) return {};
  const std::string gregorian = locale + "@calendar=gregorian";
  UErrorCode status = U_ZERO_ERROR;
  const char16_t zone[] = u"UTC";
  const Owned<UDateFormat, &udat_close> format(
      udat_open(UDAT_NONE, UDAT_LONG, gregorian.c_str(), zone, -1, nullptr, 0, &status));
  const Owned<UCalendar, &ucal_close> calendar(
      ucal_open(zone, -1, gregorian.c_str(), UCAL_GREGORIAN, &status));
  if (U_FAILURE(status)) return {};
  ucal_setDateTime(calendar.get(), year, month - 1, day, 12, 0, 0, &status);
  const UDate when = ucal_getMillis(calendar.get(), &status);
  if (U_FAILURE(status)) return {};
  return written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
    return udat_format(format.get(), when, out, size, nullptr, error);
  });
}

std::string date_order(std::string_view language) {
  const std::string locale = locale_of(language);
  UErrorCode status = U_ZERO_ERROR;
  const Owned<UDateFormat, &udat_close> format(
      udat_open(UDAT_NONE, UDAT_SHORT, locale.c_str(), nullptr, 0, nullptr, 0, &status));
  if (U_FAILURE(status)) return "dmy";
  const std::string pattern =
      written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
        return udat_toPattern(format.get(), 0, out, size, error);
      });
  std::string order;
  for (const char c : dam::lower_case(pattern)) {
    const char part = c == 'l' ? 'm' : c;
    const bool counts = part == 'd' || part == 'm' || part == 'y';
    if (counts && order.find(part) == std::string::npos) order += part;
  }
  return order.size() == 3 ? order : "dmy";
}

std::string spell_amount(std::string_view number, std::string_view unit,
                         std::string_view language) {
  const std::string locale = locale_of(language);
  if (!has_locale(locale)) return {};
  const bool currency = unit.size() == 3 && unit[0] >= 'A' && unit[0] <= 'Z';
  const std::size_t point = number.find('.');
  const std::size_t places = point == std::string_view::npos ? 0 : number.size() - point - 1;
  std::string skeleton = currency ? "currency/" : "unit/";
  skeleton += std::string(unit) + " unit-width-full-name ." + std::string(places, '0');
  if (places == 0) skeleton.replace(skeleton.size() - 1, 1, "precision-integer");
  skeleton += " group-off latin";
  // Made once, as those of spell_number().
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, Owned<UNumberFormatter, &unumf_close>> made;
  const std::lock_guard lock(mutex);
  constexpr std::size_t kMostMade = 100;
  if (made.size() > kMostMade) made.clear();
  UErrorCode status = U_ZERO_ERROR;
  auto& format = made[{skeleton, locale}];
  if (!format) {
    const std::u16string wide = utf16_of(skeleton);
    format.reset(unumf_openForSkeletonAndLocale(wide.data(), std::int32_t(wide.size()),
                                                locale.c_str(), &status));
  }
  const Owned<UFormattedNumber, &unumf_closeResult> result(unumf_openResult(&status));
  if (U_FAILURE(status)) return {};
  const std::string ascii(number);
  unumf_formatDecimal(format.get(), ascii.c_str(), std::int32_t(ascii.size()), result.get(),
                      &status);
  if (U_FAILURE(status)) return {};
  return written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
    return unumf_resultToString(result.get(), out, size, error);
  });
}

char decimal_point(std::string_view language) {
  const std::string locale = locale_of(language);
  UErrorCode status = U_ZERO_ERROR;
  const Owned<UNumberFormat, &unum_close> format(
      unum_open(UNUM_DECIMAL, nullptr, 0, locale.c_str(), nullptr, &status));
  if (U_FAILURE(status)) return '.';
  const std::string point =
      written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
        return unum_getSymbol(format.get(), UNUM_DECIMAL_SEPARATOR_SYMBOL, out, size, error);
      });
  return point == "," ? ',' : '.';
}

bool groups_by_blank(std::string_view language) {
  const std::string locale = locale_of(language);
  UErrorCode status = U_ZERO_ERROR;
  const Owned<UNumberFormat, &unum_close> format(
      unum_open(UNUM_DECIMAL, nullptr, 0, locale.c_str(), nullptr, &status));
  if (U_FAILURE(status)) return false;
  const std::string sign =
      written<UErrorCode>([&](UChar* out, std::int32_t size, UErrorCode* error) {
        return unum_getSymbol(format.get(), UNUM_GROUPING_SEPARATOR_SYMBOL, out, size, error);
      });
  return sign == "\u00A0" || sign == "\u202F";
}

}  // namespace animeme::text
