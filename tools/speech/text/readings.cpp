#include "tools/speech/text/readings.h"

#include <algorithm>
#include <map>
#include <utility>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/abbreviations_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/roman_internal.h"
#include "tools/speech/text/spoken_numbers_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/token_readings_internal.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/written.h"

namespace animeme::text {
namespace {

// Longer tokens are read as they are written.
constexpr std::size_t kLongestToken = 60, kLongestReading = 300;

bool among(char32_t c, std::u32string_view all) { return all.find(c) != std::u32string_view::npos; }

constexpr std::u32string_view
    kSignsBefore = U"$€£¥￥₽₹₩₺₴₪#+-−&§½⅓⅔¼¾⅛⅜⅝⅞",
    kSignsBehind = U"%‰$€£¥￥₽₹₩₺₴₪¢°#+♯♭²³&½⅓⅔¼¾⅛⅜⅝⅞";

bool parts_tokens(char32_t c) { return is_blank(c) || c == 0x2014 || c == 0x2015 || c == 0x2026; }

bool is_figure(char32_t c) { return kind_of(c) == Kind::digit; }

class Tokens {
 public:
  Tokens(std::string_view text, const std::string& language)
      : source_(code_points(text)),
        language_(language),
        numbers_(language),
        point_(numbers_.point()),
        said_(read_written(as_written(source_), {language, false, false})) {
    find_joined();
  }

  std::vector<Token> all() {
    std::vector<Token> tokens;
    for (std::size_t at = 0; at < source_.size();) {
      if (parts_tokens(source_[at])) {
        ++at;
        continue;
      }
      const std::size_t end = token_end(at);
      add(at, end, tokens);
      at = end;
    }
    return tokens;
  }

 private:
  // Characters that are said together with the next one.
  void find_joined() {
    joined_.assign(source_.size(), false);
    for (std::size_t i = 0; i < said_.size(); ++i) {
      const Place place = said_.places[i];
      if (i > 0 && said_.places[i - 1] == place) continue;
      if (!is_letter_or_digit(source_[place.first]) && place.last > place.first + 1 &&
          !among(source_[place.first], kSignsBefore) && source_[place.first] != U'(') {
        continue;  // a row of punctuation
      }
      for (std::size_t k = place.first; k + 1 < place.last; ++k) joined_[k] = true;
    }
  }

  // Behind a group of three digits and a blank: 1 234.
  bool thousands(std::size_t blank) const {
    std::size_t first = blank;
    while (first > 0 && is_figure(source_[first - 1]) && blank - first < 4) --first;
    const std::size_t digits = blank - first;
    if (digits < 1 || digits > 3 || source_[first] == U'0') return false;
    const char32_t before = first > 0 ? source_[first - 1] : U' ';
    if (!parts_tokens(before) && !among(before, kSignsBefore)) return false;
    std::size_t end = blank + 1;
    while (end < source_.size() && is_figure(source_[end]) && end - blank < 5) ++end;
    return end == blank + 4 && (end >= source_.size() || !is_letter(source_[end]));
  }

  bool goes_on(std::size_t at) const {
    const char32_t c = source_[at];
    if (at > 0 && joined_[at - 1] && joined_[at]) return true;
    if (!is_space(c) || at == 0 || at + 1 >= source_.size()) return false;
    if (!is_figure(source_[at - 1])) return false;
    const char32_t next = source_[at + 1];
    return next == U'%' || next == U'‰' || thousands(at);
  }

  std::size_t token_end(std::size_t at) const {
    while (at < source_.size() && (!parts_tokens(source_[at]) || goes_on(at))) ++at;
    return at;
  }

  // What the front end says for [first, last).
  std::string front(std::size_t first, std::size_t last) {
    while (said_at_ < said_.size() && said_.places[said_at_].first < first) ++said_at_;
    std::size_t end = said_at_;
    while (end < said_.size() && said_.places[end].first < last) ++end;
    const std::string words =
        utf8(std::u32string_view(said_.text).substr(said_at_, end - said_at_));
    said_at_ = end;
    std::string_view bare = dam::trimmed(words);
    while (!bare.empty() &&
           std::string_view(".,;:!?").find(bare.back()) != std::string_view::npos) {
      bare.remove_suffix(1);
    }
    return std::string(bare);
  }

  void add(std::size_t first, std::size_t last, std::vector<Token>& tokens) {
    const std::size_t whole_first = first, whole_last = last;
    const auto digit = [&](std::size_t i) { return i < source_.size() && is_figure(source_[i]); };
    while (first < last && !is_letter_or_digit(source_[first]) &&
           !(among(source_[first], kSignsBefore) &&
             (first + 1 == last || source_[first] != U'-' || digit(first + 1))) &&
           !(source_[first] == U'.' && digit(first + 1) && char32_t(point_) == U'.')) {
      ++first;
    }
    const std::string base = numbers_.base();
    const auto stops = [&] {
      const auto token = std::u32string_view(source_).substr(first, last - first);
      if (token.size() > kLongestToken) return false;
      if (!meanings_of(token, base).empty() || joined_[last - 2]) return true;
      // A German ordinal, unless it is the end of the text.
      return base == "de" && digit(last - 2) && !ends_text(source_, last);
    };
    while (last > first) {
      const char32_t c = source_[last - 1];
      if (is_letter_or_digit(c) || kind_of(c) == Kind::mark || among(c, kSignsBehind)) break;
      if (c == U'.' && last - first > 1 && stops()) break;
      --last;
    }
    const std::string spoken = front(whole_first, whole_last);
    if (first >= last) return;
    Token token{utf8(std::u32string_view(source_).substr(first, last - first)), {}, 0};
    const bool signs_alone = std::none_of(
        source_.begin() + std::ptrdiff_t(first), source_.begin() + std::ptrdiff_t(last),
        [](char32_t c) { return is_letter_or_digit(c) || c == U'&'; });
    if (signs_alone) return;
    if (last - first <= kLongestToken && unicode_here()) read(token, spoken);
    tokens.push_back(std::move(token));
  }

  std::string in_ascii(std::string_view text) const {
    std::u32string out = code_points(text);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const int digit = digit_value(out[i]);
      if (digit >= 0) out[i] = char32_t(U'0' + digit);
      if (is_space(out[i])) out[i] = U' ';
      if (out[i] == 0x2010 || out[i] == 0x2011 || out[i] == 0x2012 || out[i] == 0x2013 ||
          out[i] == 0x2212) {
        out[i] = U'-';
      }
      if (out[i] == 0x2044 || out[i] == 0x2215) out[i] = U'/';
      if (out[i] == 0x2019) out[i] = U'\'';
    }
    return utf8(out);
  }

  // The same token is often there again.
  void read(Token& token, const std::string& spoken) {
    const auto [known, is_new] = known_.try_emplace({token.text, spoken}, token);
    if (is_new) find_readings(known->second, spoken);
    token = known->second;
  }

  void find_readings(Token& token, const std::string& spoken) const {
    const std::string text = in_ascii(token.text);
    const WaysToSay ways = ways_to_say(text, spoken, language_, numbers_);
    const bool figures =
        std::any_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    const bool other = !spoken.empty() && spoken != token.text && special(token.text, spoken);
    if (ways.complete.empty() && !figures && !other) return;
    add_reading(token, spoken.empty() ? token.text : spoken);
    if (figures || other) {
      add_reading(token, digits_in_words(in_ascii(token.readings[0]), numbers_, point_));
    }
    for (const std::string& way : ways.complete) add_reading(token, way);
    // Room for these; they are few.
    const std::size_t room = kMostReadings - std::min(ways.short_of.size(), kMostReadings / 3);
    if (token.readings.size() > room) token.readings.resize(room);
    token.complete = token.readings.size();
    for (const std::string& way : ways.short_of) add_reading(token, way);
  }

  static void add_reading(Token& token, const std::string& way) {
    auto& all = token.readings;
    if (all.size() >= kMostReadings || way.empty() || way.size() > kLongestReading) return;
    if (std::find(all.begin(), all.end(), way) == all.end()) all.push_back(way);
  }

  // The front end says other words, and not only fewer signs.
  static bool special(const std::string& text, const std::string& spoken) {
    std::u32string left, right;
    for (const char32_t c : code_points(text)) {
      if (is_letter_or_digit(c)) left += lower(c);
    }
    for (const char32_t c : code_points(spoken)) {
      if (is_letter_or_digit(c)) right += lower(c);
    }
    return left != right;
  }

  std::u32string source_;
  const std::string& language_;
  SpokenNumbers numbers_;
  char point_;
  SpokenText said_;
  std::vector<bool> joined_;
  std::size_t said_at_ = 0;
  std::map<std::pair<std::string, std::string>, Token> known_;
};

}  // namespace

std::vector<Token> tokens_with_readings(std::string_view text, const std::string& language) {
  return Tokens(text, language).all();
}

}  // namespace animeme::text
