#include "tools/speech/voice/transcript.h"

#include <algorithm>

#include "dam/script/script_text_internal.h"

namespace animeme::voice {
namespace {

bool is_ascii_letter_or_digit(char32_t c) {
  return (c >= U'0' && c <= U'9') || (c >= U'a' && c <= U'z') || (c >= U'A' && c <= U'Z');
}

bool is_punctuation(char32_t c) {
  if (c < 0x80) return !is_ascii_letter_or_digit(c);
  return c < 0xAA || c == 0xAB || c == 0xAD || (c >= 0xB0 && c <= 0xB1) || c == 0xB7 || c == 0xBB ||
         c == 0xBF || c == 0xFFFD || (c >= 0x2000 && c <= 0x206F) || (c >= 0x3000 && c <= 0x3003) ||
         (c >= 0x3008 && c <= 0x3011);
}

bool parts_words(char32_t c) {
  return c <= U' ' || c == U'-' || c == U'/' || c == 0xA0 || (c >= 0x2010 && c <= 0x2015) ||
         c == 0x2026 || c == 0x3000;
}

}  // namespace

std::string_view strip_punctuation(std::string_view word) {
  std::size_t first = word.size(), last = 0;
  for (std::string_view rest = word; !rest.empty();) {
    const std::size_t at = word.size() - rest.size();
    if (is_punctuation(dam::take_code_point(rest))) continue;
    first = std::min(first, at);
    last = word.size() - rest.size();
  }
  return first < last ? word.substr(first, last - first) : std::string_view();
}

std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    const std::string_view bare = strip_punctuation(word);
    if (!bare.empty()) words.emplace_back(bare);
    word.clear();
  };
  while (!text.empty()) {
    const char32_t code = dam::take_code_point(text);
    if (parts_words(code)) {
      finish();
    } else {
      dam::append_utf8(word, code == 0x2019 || code == 0x02BC ? U'\'' : code);
    }
  }
  finish();
  return words;
}

}  // namespace animeme::voice
