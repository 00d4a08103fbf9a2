#include "tools/speech/text/guess.h"

#include <algorithm>

#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::ptrdiff_t kLettersOfASentence = 12;

bool ends_sentence(char32_t c) {
  return std::u32string_view(U".!?;:\u2026\n").find(c) != std::u32string_view::npos;
}

// One behind the sentence that begins at `first`: an end with a blank behind it, so that 3.5 and
// example.org stay whole.
std::size_t sentence_end(std::u32string_view text, std::size_t first) {
  for (std::size_t i = first; i < text.size(); ++i) {
    if (!ends_sentence(text[i])) continue;
    if (text[i] == U'\n' || i + 1 == text.size() || is_blank(text[i + 1])) return i + 1;
  }
  return text.size();
}

}  // namespace

std::vector<std::string> guess_sentences(std::u32string_view text) {
  std::vector<std::string> out(text.size());
  if (!can_guess()) return out;
  const std::string whole = guess_language(text);
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = sentence_end(text, i);
    const std::u32string_view sentence = text.substr(i, end - i);
    const bool is_long =
        std::count_if(sentence.begin(), sentence.end(), is_letter) >= kLettersOfASentence;
    std::string language = is_long ? guess_language(sentence) : std::string();
    if (language.empty()) language = whole;
    std::fill(out.begin() + std::ptrdiff_t(i), out.begin() + std::ptrdiff_t(end), language);
    i = end;
  }
  return out;
}

}  // namespace animeme::text
