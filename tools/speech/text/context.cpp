#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kMostLettersBeside = 24;
constexpr std::size_t kMostClosers = 8;

bool word_sign(char32_t c) {
  return is_letter(c) || kind_of(c) == Kind::mark || c == U'\'' || c == U'’';
}

bool closes(char32_t c) {
  return std::u32string_view(U"\"')]}»”’›").find(c) != std::u32string_view::npos;
}

struct Starters {
  std::string_view base, words;
};
constexpr Starters kStarters[] = {
    {"en",
     " the a an he she it they we i you his her its their our my your in on at but and so then "
     "this that these those there here when what who why how if as after before today now later "
     "no yes is are was were do did does for from with not "},
    {"de",
     " der die das den dem des ein eine er sie es wir ihr ich du sein seine ihre im in an am auf "
     "aber und dann da dort dies diese dieser heute jetzt wenn was wer wie warum als nach vor ist "
     "sind war waren hat haben mit für zu "},
    {"fr",
     " le la les un une il elle ils elles on nous vous je tu ce cette ces son sa ses leur et mais "
     "puis alors dans en à au aux quand qui que si ici c'est "},
    {"es",
     " el la los las un una él ella ellos nosotros yo tú su sus este esta esto ese y pero luego "
     "después en de cuando quien qué si aquí hoy es no "},
    {"it",
     " il lo la i gli le un una lui lei loro noi io tu suo sua questo questa e ma poi dopo in di "
     "quando chi che se qui oggi è non "},
    {"pt",
     " o a os as um uma ele ela eles nós eu tu seu sua este esta isto e mas depois em no na de "
     "quando quem que se aqui hoje é não "},
    {"nl",
     " de het een hij zij ze wij we ik jij je zijn haar hun dit dat deze die en maar dan toen in "
     "op aan als wie wat hoe hier daar nu vandaag is was niet "},
};

}  // namespace

std::string language_base(std::string_view language) {
  return dam::lower_case(language.substr(0, language.find_first_of("-_+")));
}

bool is_space(char32_t c) { return c == U' ' || c == U'\t' || c == 0xA0 || c == 0x202F; }

bool is_upper(char32_t c) { return is_letter(c) && lower(c) != c; }

std::size_t spaces_end(std::u32string_view text, std::size_t at, std::size_t most) {
  const std::size_t end = at + std::min(most, text.size() - std::min(at, text.size()));
  while (at < end && is_space(text[at])) ++at;
  return at;
}

WordPlace word_before(std::u32string_view text, std::size_t end) {
  for (std::size_t blanks = 0; blanks < 2 && end > 0 && is_space(text[end - 1]); ++blanks) --end;
  std::size_t first = end;
  while (first > 0 && word_sign(text[first - 1]) && end - first <= kMostLettersBeside) --first;
  return end - first > kMostLettersBeside ? WordPlace{} : WordPlace{first, end};
}

WordPlace word_behind(std::u32string_view text, std::size_t at) {
  const std::size_t first = spaces_end(text, at);
  std::size_t last = first;
  while (last < text.size() && word_sign(text[last]) && last - first <= kMostLettersBeside) ++last;
  return last - first > kMostLettersBeside ? WordPlace{} : WordPlace{first, last};
}

std::string lower_word(std::u32string_view text, WordPlace word) {
  std::u32string letters(text.substr(word.first, word.last - word.first));
  for (char32_t& c : letters) c = lower(c);
  return utf8(letters);
}

bool has_word(std::string_view list, std::string_view word) {
  if (word.empty() || word.find(' ') != std::string_view::npos) return false;
  return list.find(" " + std::string(word) + " ") != std::string_view::npos;
}

bool ends_text(std::u32string_view text, std::size_t at) {
  for (std::size_t k = 0; k < kMostClosers && at < text.size(); ++k, ++at) {
    if (text[at] == U'\n' || text[at] == U'\r') return true;
    if (!is_space(text[at]) && !closes(text[at])) return false;
  }
  return at >= text.size();
}

bool upper_follows(std::u32string_view text, std::size_t at) {
  std::size_t next = spaces_end(text, at);
  if (next == at) return false;
  if (next < text.size() &&
      std::u32string_view(U"\"'(«“„‘").find(text[next]) != std::u32string_view::npos) {
    ++next;
  }
  return next < text.size() && is_upper(text[next]);
}

bool starter_follows(std::u32string_view text, std::size_t at, std::string_view base) {
  if (!upper_follows(text, at)) return false;
  const WordPlace word = word_behind(text, at);
  for (const Starters& row : kStarters) {
    if (row.base == base) return has_word(row.words, lower_word(text, word));
  }
  return false;
}

}  // namespace animeme::text
