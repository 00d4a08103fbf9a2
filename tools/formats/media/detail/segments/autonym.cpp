#include "tools/formats/media/detail/segments/autonym.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

namespace animeme::media {
namespace {

// As CLDR has them, by the tag.
constexpr std::pair<std::string_view, std::string_view> kAutonyms[] = {
    {"af", "Afrikaans"},  {"am", "አማርኛ"},          {"ar", "العربية"},      {"az", "azərbaycan"},
    {"be", "беларуская"}, {"bg", "български"},     {"bn", "বাংলা"},        {"bs", "bosanski"},
    {"ca", "català"},     {"cmn", "中文"},         {"cs", "čeština"},      {"cy", "Cymraeg"},
    {"da", "dansk"},      {"de", "Deutsch"},       {"el", "Ελληνικά"},     {"en", "English"},
    {"eo", "esperanto"},  {"es", "español"},       {"et", "eesti"},        {"eu", "euskara"},
    {"fa", "فارسی"},      {"fi", "suomi"},         {"fr", "français"},     {"ga", "Gaeilge"},
    {"gl", "galego"},     {"gu", "ગુજરાતી"},        {"he", "עברית"},        {"hi", "हिन्दी"},
    {"hr", "hrvatski"},   {"hu", "magyar"},        {"hy", "հայերեն"},      {"id", "Indonesia"},
    {"is", "íslenska"},   {"it", "italiano"},      {"ja", "日本語"},       {"ka", "ქართული"},
    {"kk", "қазақ тілі"}, {"kn", "ಕನ್ನಡ"},          {"ko", "한국어"},       {"ku", "kurdî"},
    {"ky", "кыргызча"},   {"la", "Latina"},        {"lt", "lietuvių"},     {"lv", "latviešu"},
    {"mk", "македонски"}, {"ml", "മലയാളം"},        {"mr", "मराठी"},        {"ms", "Melayu"},
    {"mt", "Malti"},      {"my", "မြန်မာ"},         {"nb", "norsk bokmål"}, {"ne", "नेपाली"},
    {"nl", "Nederlands"}, {"nn", "norsk nynorsk"}, {"no", "norsk"},        {"pa", "ਪੰਜਾਬੀ"},
    {"pl", "polski"},     {"pt", "português"},     {"ro", "română"},       {"ru", "русский"},
    {"sk", "slovenčina"}, {"sl", "slovenščina"},   {"sq", "shqip"},        {"sr", "српски"},
    {"sv", "svenska"},    {"sw", "Kiswahili"},     {"ta", "தமிழ்"},         {"te", "తెలుగు"},
    {"th", "ไทย"},        {"tr", "Türkçe"},        {"uk", "українська"},   {"ur", "اردو"},
    {"uz", "o‘zbek"},     {"vi", "Tiếng Việt"},    {"yue", "粵語"},        {"zh", "中文"},
    {"zu", "isiZulu"},
};

}  // namespace

std::string autonym_of(std::string_view tag) {
  std::string language(tag.substr(0, tag.find('-')));
  for (char& c : language) c = char(std::tolower(static_cast<unsigned char>(c)));
  const auto* const found = std::lower_bound(
      std::begin(kAutonyms), std::end(kAutonyms), language,
      [](const auto& row, const std::string& wanted) { return row.first < wanted; });
  if (found == std::end(kAutonyms) || found->first != language) return std::string(tag);
  const std::string rest(tag.substr(language.size()));
  return std::string(found->second) + (rest.empty() ? "" : " (" + rest.substr(1) + ")");
}

}  // namespace animeme::media
