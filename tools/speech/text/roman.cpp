#include "tools/speech/text/roman_internal.h"

#include <algorithm>

#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/fractions_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kLongestNumeral = 8;
constexpr std::size_t kTitleWords = 4;  // back from the numeral: "Pope John Paul II"

// How a language reads numerals behind names of rulers, and what stands before others.
struct RomanManner {
  std::string_view base;
  int ordinals;    // the last one that is an ordinal behind a ruler's name: 1 "François premier"
  bool cardinals;  // all others are put in words, since the voice does not read them as numbers
  std::string_view masculine, feminine;  // the article before an ordinal
  std::string_view sections;             // what has numbers: chapters, wars
  std::string_view titles;               // what stands before the name of a ruler
};

constexpr RomanManner kManners[] = {
    {"en", 99, true, "the ", "the ",
     " chapter part act scene book volume vol section article title phase level type class grade "
     "stage war bowl figure table appendix unit lesson canto mark step episode season version "
     "group "
     "category tier factor league quadrant division corps battalion cranial louisiana ",
     " king queen pope emperor empress tsar czar kaiser prince princess sultan pharaoh archduke "
     "duke shah "},
    {"de", 99, true, "der ", "die ",
     " kapitel teil akt szene band buch abschnitt artikel stufe typ klasse phase tafel weltkrieg "
     "anlage gruppe lektion staffel folge ",
     " könig königin papst kaiser kaiserin zar zarin fürst fürstin herzog prinz prinzessin sultan "
     "pharao queen king "},
    {"fr", 1, true, "", "",
     " chapitre partie acte scène livre tome volume section article titre phase type niveau groupe "
     "annexe guerre saison épisode ",
     " roi reine pape empereur impératrice tsar prince princesse sultan pharaon duc "},
    {"es", 10, false, "", "",
     " capítulo parte acto escena libro tomo volumen sección artículo título fase tipo siglo "
     "guerra "
     "grupo nivel anexo ",
     " rey reina papa emperador emperatriz zar príncipe princesa sultán faraón duque "},
    {"it", 99, false, "", "",
     " capitolo parte atto scena libro tomo volume sezione articolo titolo fase tipo secolo guerra "
     "gruppo livello allegato ",
     " re regina papa imperatore imperatrice zar principe principessa sultano faraone duca "},
    {"pt", 10, true, "", "",
     " capítulo parte ato acto cena livro tomo volume seção secção artigo título fase tipo século "
     "guerra grupo nível anexo ",
     " rei rainha papa imperador imperatriz czar príncipe princesa sultão faraó duque dom dona "},
    {"nl", 99, true, "de ", "de ",
     " hoofdstuk deel akte scène boek band artikel fase type klasse wereldoorlog bijlage groep ",
     " koning koningin paus keizer keizerin tsaar prins prinses sultan farao hertog "},
};

// Names that rulers of that number had, in these seven languages.
constexpr std::string_view kRulers =
    " henry edward richard george william charles james louis philip francis ferdinand frederick "
    "leopold joseph maximilian nicholas alexander peter ivan napoleon ramses ramesses thutmose "
    "amenhotep seti ptolemy darius xerxes artaxerxes cyrus pius benedict paul john gregory "
    "innocent "
    "clement leo urban boniface julius sixtus haakon harald olav christian gustav gustavus carl "
    "mehmed murad selim suleiman bayezid rama baldwin robert kenneth constantine justinian "
    "theodosius alexios andronikos manuel umberto emmanuel carol ludwig karl heinrich friedrich "
    "wilhelm otto rudolf konrad georg albrecht leopold josef franz ferdinand philipp alexander "
    "nikolaus peter iwan paul johannes benedikt innozenz clemens henri charles françois philippe "
    "guillaume jean benoît grégoire clément léon frédéric alexandre pierre édouard jacques "
    "napoléon felipe carlos alfonso fernando enrique juan pedro sancho jaime luis benedicto "
    "gregorio inocencio pío pablo francisco vittorio emanuele carlo luigi enrico federico filippo "
    "ferdinando benedetto giovanni paolo pio gregorio innocenzo clemente leone giulio joão josé "
    "pedro manuel afonso filipe sebastião luís bento paulo gregório willem filips hendrik karel "
    "lodewijk frederik jan johannes paulus benedictus ";
constexpr std::string_view kQueens =
    " elizabeth mary anne margaret margrethe catherine christina isabella victoria beatrix "
    "wilhelmina cleopatra juliana elisabeth katharina maria margarethe christine élisabeth marie "
    "marguerite isabelle isabel catalina juana cristina maría elisabetta caterina margherita "
    "giovanna ana leonor beatriz leonora ";

// German cases of what stands before the name.
constexpr std::string_view kDative = " mit von unter bei nach zu seit aus vom zum gegenüber außer ";
constexpr std::string_view kAccusative = " für gegen durch ohne um ";
// What stands behind an IV that is no numeral, and behind chromosomes.
constexpr std::string_view kFirstPerson =
    " am have will would can could should must may might like liked love loved think thought know "
    "knew need needed want wanted saw see read wrote write mean did do use used chose watched play "
    "played said say got get made make mentioned ";
constexpr std::string_view kLettersBefore =
    " drip fluid fluids bag bags line lines therapy access antibiotics needle pole infusion "
    "catheter push medication treatment chromosome chromosomes rated ";

const RomanManner* manner_of(std::string_view base) {
  for (const RomanManner& one : kManners) {
    if (one.base == base) return &one;
  }
  return nullptr;
}

std::u32string in_spoken_words(int value, const std::string& language, NumberForm form) {
  std::u32string out;
  for (const char32_t c : code_points(spell_number(std::to_string(value), language, form))) {
    if (c != 0xAD) out += c;  // where a word may be parted
  }
  return out;
}

class Roman {
 public:
  Roman(std::u32string_view text, std::size_t at, std::size_t end, const RomanManner& manner,
        const std::string& language)
      : text_(text), at_(at), end_(end), manner_(manner), language_(language) {
    name_ = word_before(text, at);
    if (name_.last == at) name_ = {};  // touches it
    before_ = name_.empty() ? std::string() : lower_word(text, name_);
    value_ = roman_value(text.substr(at, end - at));
  }

  Amount read() const {
    const bool lone = end_ - at_ == 1;
    const bool named = !name_.empty() && is_upper(text_[name_.first]);
    const bool section = has_word(manner_.sections, before_);
    if (named && !section && is_ruler(lone)) return ruler();
    // "im II. Weltkrieg"
    const WordPlace next = word_behind(text_, end_ + 1);
    if (manner_.base == "de" && !lone && sign() == U'.' && !next.empty() && next.first > end_ + 1 &&
        !starter_follows(text_, end_ + 1, manner_.base)) {
      return {end_ + 1, german_ordinal(value_, before_)};
    }
    if (lone) return section && clearly_section() ? cardinal() : Amount{};
    if (manner_.base == "en" && !section && is_letters(named)) return letters();
    if (!manner_.cardinals) return {};
    if (manner_.base == "nl" && !named && !section) return {};
    return cardinal();
  }

 private:
  bool lower_follows() const {
    const WordPlace next = word_behind(text_, end_);
    return !next.empty() && next.first > end_ && !is_upper(text_[next.first]);
  }
  char32_t sign() const { return end_ < text_.size() ? text_[end_] : U' '; }

  // "I" is a word of English: "the chapter I read", "Part I of the book".
  bool clearly_section() const {
    if (manner_.base != "en" || text_[at_] != U'I') return true;
    const WordPlace next = word_behind(text_, end_);
    if (!is_upper(text_[name_.first])) return !lower_follows();
    return !has_word(kFirstPerson, lower_word(text_, next));
  }

  bool has_title() const {
    std::size_t at = name_.first;
    for (std::size_t k = 0; k < kTitleWords; ++k) {
      const WordPlace word = word_before(text_, at);
      if (word.empty() || word.last == at) return false;
      if (has_word(manner_.titles, lower_word(text_, word))) return true;
      if (!is_upper(text_[word.first])) return false;
      at = word.first;
    }
    return false;
  }

  std::string bare_name() const {
    const bool genitive = manner_.base == "de" && before_.ends_with("s");
    return genitive && !known(before_) ? before_.substr(0, before_.size() - 1) : before_;
  }
  static bool known(std::string_view name) {
    return has_word(kRulers, name) || has_word(kQueens, name);
  }

  bool is_ruler(bool lone) const {
    if (has_word(manner_.titles, before_)) return false;  // "King IV"
    const bool titled = has_title();
    // "Louis I. Kahn": in German it is the full stop of an ordinal.
    if (lone && manner_.base != "de" && sign() == U'.' && upper_follows(text_, end_ + 1) &&
        !starter_follows(text_, end_ + 1, manner_.base)) {
      return false;
    }
    if (!lone) return titled || known(bare_name());
    // "Elizabeth I saw": in English the letter is a word.
    if (text_[at_] == U'I' && manner_.base == "en" && lower_follows() && !titled) {
      return known(before_) && has_word(" of ", lower_word(text_, word_behind(text_, end_)));
    }
    return titled || known(bare_name());
  }

  bool feminine() const {
    return has_word(kQueens, bare_name()) ||
           (!known(bare_name()) && (before_.ends_with("a") && manner_.base != "en"));
  }

  Amount ruler() const {
    if (value_ > manner_.ordinals) return manner_.cardinals ? cardinal() : Amount{};
    const bool woman = feminine();
    // The voices of Italian read the masculine forms by themselves, but for single letters.
    if (manner_.base == "it" && !woman && end_ - at_ > 1) return {};
    std::u32string words = in_spoken_words(
        value_, language_, woman ? NumberForm::ordinal_feminine : NumberForm::ordinal);
    if (words.empty()) return {};
    std::string article(woman ? manner_.feminine : manner_.masculine);
    if (manner_.base == "de") article = german_article(woman, words);
    std::size_t end = end_;
    // German writes the full stop of an ordinal.
    if (manner_.base == "de" && sign() == U'.') {
      ++end;
      if (ends_text(text_, end) || starter_follows(text_, end, manner_.base)) words += U'.';
    }
    return {end, code_points(article) + words};
  }

  std::string german_article(bool woman, std::u32string& words) const {
    // Before the name and its titles.
    std::size_t at = name_.first;
    std::string word;
    for (std::size_t k = 0; k < kTitleWords; ++k) {
      const WordPlace one = word_before(text_, at);
      if (one.empty() || one.last == at) break;
      word = lower_word(text_, one);
      if (!is_upper(text_[one.first])) break;
      if (has_word(kDative, word) || has_word(kAccusative, word)) break;
      at = one.first;
    }
    const bool genitive = bare_name() != before_ || word == "des" || (word == "der" && woman);
    if (genitive) {
      words += U'n';
      return woman ? "der " : "des ";
    }
    if (has_word(kDative, word)) {
      words += U'n';
      return woman ? "der " : "dem ";
    }
    if (has_word(kAccusative, word)) {
      if (!woman) words += U'n';
      return woman ? "die " : "den ";
    }
    return woman ? "die " : "der ";
  }

  // "an IV drip", "the XX chromosome".
  bool is_letters(bool named) const {
    const std::u32string_view token = text_.substr(at_, end_ - at_);
    if (token != U"IV" && token != U"VI" && token != U"XX" && token != U"XXX" && token != U"XI") {
      return false;
    }
    if (has_word(kLettersBefore, lower_word(text_, word_behind(text_, end_)))) return true;
    if (before_ == "a" || before_ == "an" || before_ == "the" || before_ == "by") return true;
    return token != U"VI" && token != U"XI" && !named && (!name_.empty() || lower_follows());
  }

  Amount letters() const {
    std::u32string words;
    for (std::size_t i = at_; i < end_; ++i) {
      if (i > at_) words += U' ';
      words += text_[i];
    }
    return {end_, words};
  }

  Amount cardinal() const {
    const std::u32string words = in_spoken_words(value_, language_, NumberForm::cardinal);
    return {words.empty() ? 0 : end_, words};
  }

  std::u32string_view text_;
  std::size_t at_, end_;
  const RomanManner& manner_;
  const std::string& language_;
  WordPlace name_;      // the word before
  std::string before_;  // in lower case
  int value_ = 0;
};

// XIXe siècle, François Ier.
Amount french_ordinal(std::u32string_view text, std::size_t end, int value,
                      const std::string& language) {
  constexpr std::u32string_view kEndings[] = {U"ième", U"ème", U"ère", U"ers", U"res",
                                              U"es",   U"er",  U"re",  U"e"};
  for (const std::u32string_view ending : kEndings) {
    const std::size_t last = end + ending.size();
    if (text.substr(end, ending.size()) != ending) continue;
    if (last < text.size() && is_letter_or_digit(text[last])) continue;
    const bool woman = value == 1 && (ending == U"re" || ending == U"ère" || ending == U"res");
    return {last, in_spoken_words(value, language,
                                  woman ? NumberForm::ordinal_feminine : NumberForm::ordinal)};
  }
  return {};
}

}  // namespace

int roman_value(std::u32string_view token) {
  constexpr std::u32string_view kOnes[] = {U"",  U"I",  U"II",  U"III",  U"IV",
                                           U"V", U"VI", U"VII", U"VIII", U"IX"};
  constexpr std::u32string_view kTens[] = {U"",  U"X",  U"XX",  U"XXX", U"XL",
                                           U"L", U"LX", U"LXX", U"LXXX"};
  if (token.empty() || token.size() > kLongestNumeral) return 0;
  if (token.find(U'L') != std::u32string_view::npos && token.size() < 3) return 0;
  for (int tens = 8; tens >= 0; --tens) {
    if (!token.starts_with(kTens[tens])) continue;
    const std::u32string_view rest = token.substr(kTens[tens].size());
    const auto one = std::find(std::begin(kOnes), std::end(kOnes), rest);
    if (one != std::end(kOnes)) return 10 * tens + int(one - std::begin(kOnes));
  }
  return 0;
}

Amount roman_at(std::u32string_view text, std::size_t at, const std::string& language,
                std::string_view base) {
  const auto numeral = [](char32_t c) { return c == U'I' || c == U'V' || c == U'X' || c == U'L'; };
  if (at >= text.size() || !numeral(text[at])) return {};
  const RomanManner* manner = manner_of(base);
  if (manner == nullptr) return {};
  std::size_t end = at;
  while (end < text.size() && numeral(text[end]) && end - at <= kLongestNumeral) ++end;
  const int value = roman_value(text.substr(at, end - at));
  if (value == 0) return {};
  if (base == "fr") {
    if (Amount ordinal = french_ordinal(text, end, value, language);
        ordinal.end > 0 && !ordinal.words.empty()) {
      return ordinal;
    }
  }
  const auto in_a_word = [](char32_t c) {
    return is_letter_or_digit(c) || kind_of(c) == Kind::mark || c == U'&' || c == U'+' || c == U'_';
  };
  const char32_t next = end < text.size() ? text[end] : U' ';
  const char32_t behind = end + 1 < text.size() ? text[end + 1] : U' ';
  const char32_t before = at > 0 ? text[at - 1] : U' ';
  if (in_a_word(next) || ((next == U'.' || next == U'-' || next == U'/') && in_a_word(behind))) {
    return {};
  }
  const bool apostrophe = next == U'\'' || next == U'’';
  if (apostrophe && (end - at == 1 || behind != U's')) return {};  // I'm, I'd
  if (before == U'.' || before == U'/' || before == U'\'' || before == U'’' || before == U'&' ||
      (before == U'-' && end - at == 1)) {
    return {};
  }
  return Roman(text, at, end, *manner, language).read();
}

}  // namespace animeme::text
