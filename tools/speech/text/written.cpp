#include "tools/speech/text/written.h"

#include <algorithm>
#include <cctype>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/abbreviations_internal.h"
#include "tools/speech/text/amounts_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/fractions_internal.h"
#include "tools/speech/text/roman_internal.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/units_internal.h"

namespace animeme::text {
namespace {

bool in_word(char32_t c) { return is_letter(c) || kind_of(c) == Kind::mark; }
bool is_digit(char32_t c) { return digit_value(c) >= 0; }
bool one_of(char32_t c, std::u32string_view all) {
  return all.find(c) != std::u32string_view::npos;
}

// Longer runs of digits are no numbers: a voice says digit by digit, a few in a breath. Of longer
// runs of anything else a voice makes one word, in time and memory that grow with its square, or
// crashes (espeak-ng by 200 times "A."). Scripts without blanks (Thai) have sentences in one run.
constexpr std::size_t kMostDigits = 30, kDigitsInBreath = 10, kLongestRun = 100;
constexpr std::size_t kLongestUnparted = 250;

constexpr std::u32string_view kClauseSigns = U".!?…‼⁇⁈⁉";
// Signs that espeak-ng names, and people do not say; between digits some are sums.
constexpr std::u32string_view kUnsaid = U"*_~|\\^`#<>{}[]=/";
// What only says how the characters beside it are drawn.
constexpr std::u32string_view kInvisible =
    U"\u00AD\u200B\u200E\u200F\u202A\u202B\u202C\u202D\u202E\u2060\u2066\u2067\u2068\u2069\uFE0F"
    U"\uFE0E"
    U"\u20E3\uFEFF";
// Symbols outside of ASCII that are words.
constexpr std::u32string_view kSaidSymbols = U"€£¥￥₽₹₩₺₴₪¢°±×÷№℃℉§";

class WrittenReader {
 public:
  WrittenReader(const SpokenText& said, const Writing& writing)
      : in_(said),
        writing_(writing),
        base_(language_base(writing.language)),
        amounts_(in_.text, writing.language, writing.spell_digits) {}

  SpokenText read() {
    while (at_ < in_.size()) {
      step();
      part_run();
    }
    while (!out_.text.empty() && is_blank(out_.text.back()) && !is_blank(in_.text.back())) drop();
    return std::move(out_);
  }

 private:
  char32_t at(std::size_t i) const { return i < in_.size() ? in_.text[i] : U' '; }
  char32_t before() const { return at_ > 0 ? in_.text[at_ - 1] : U' '; }
  bool starts_word() const { return !in_word(before()) && !is_digit(before()); }
  // Chinese and others put no blank before a number.
  bool starts_amount() const { return starts_word() || is_unparted(before()); }
  void drop() {
    out_.text.pop_back();
    out_.places.pop_back();
  }

  void say(std::u32string_view words, std::size_t end) {
    out_.add(words, in_.place(at_, end));
    at_ = end;
  }
  void keep(std::size_t end) {
    out_.add(in_, at_, end);
    at_ = end;
  }
  void leave_out(std::size_t end) {
    if (!out_.text.empty() && !is_blank(out_.text.back())) {
      out_.add(U" ", in_.place(at_, at_ + 1));
    }
    at_ = end;
  }

  void step() {
    if (address() || digit_run()) return;
    const char32_t c = at(at_);
    if (starts_amount()) {
      if (const Amount amount = number_or_word(c); amount.end > at_) {
        return say(amount.words, amount.end);
      }
    }
    if (punctuation(c)) return;
    if (one_of(c, kInvisible)) {
      ++at_;
    } else if (is_unsaid(c)) {
      leave_out(at_ + 1);
    } else {
      keep(at_ + 1);
    }
  }

  bool digit_run() {
    if (!is_digit(at(at_)) || is_digit(before())) return false;
    std::size_t end = at_;
    while (is_digit(at(end))) ++end;
    if (end - at_ <= kMostDigits) return false;
    const std::size_t first = at_;
    if (!out_.text.empty() && !is_blank(out_.text.back())) out_.add(U" ", in_.place(at_, at_ + 1));
    while (at_ < end) {
      if (at_ > first) {
        const bool breath = (at_ - first) % kDigitsInBreath == 0;
        out_.add(breath ? U", " : U" ", in_.place(at_ - 1, at_));
      }
      keep(at_ + 1);
    }
    if (!is_blank(at(end))) out_.add(U" ", in_.place(end - 1, end));
    return true;
  }

  // A blank in what goes on for too long without one.
  void part_run() {
    run_end_ = std::min(run_end_, out_.size());  // blanks are dropped again
    run_begin_ = std::min(run_begin_, run_end_);
    for (; run_end_ < out_.size(); ++run_end_) {
      if (is_blank(out_.text[run_end_])) run_begin_ = run_end_ + 1;
      const bool unparted = is_unparted(out_.text[run_end_]);
      if (run_end_ < run_begin_ + (unparted ? kLongestUnparted : kLongestRun)) continue;
      out_.text.insert(run_end_, 1, U' ');
      out_.places.insert(out_.places.begin() + std::ptrdiff_t(run_end_), out_.places[run_end_]);
      run_begin_ = run_end_ + 1;
    }
  }

  // What is said in another way than letter by letter and digit by digit.
  Amount number_or_word(char32_t c) {
    const std::u32string_view text = in_.text;
    if (kind_of(c) == Kind::digit) {
      if (Amount part = fraction_at(text, at_, writing_.language, base_); part.end > 0) return part;
      if (Amount rank = ordinal_at(text, at_, writing_.language, base_); rank.end > 0) return rank;
    } else if (is_letter(c) && starts_word()) {
      if (Amount word = abbreviation_at(text, at_, base_); word.end > 0) return word;
      if (Amount note = sharp_at(text, at_, base_); note.end > 0) return note;
      return roman_at(text, at_, writing_.language, base_);
    }
    return amounts_.read(at_);
  }

  bool is_unsaid(char32_t c) const {
    const Kind kind = kind_of(c);
    const bool joiner = c == 0x200D && kind_of(before()) != Kind::emoji;  // of Indian letters
    if (kind == Kind::emoji) return !joiner && !writing_.keep_emoji;
    if (c < 0x80) {
      const bool sum = one_of(c, U"=<>") && (is_digit(at(at_ + 1)) || is_blank(at(at_ + 1))) &&
                       (is_digit(before()) || is_blank(before()));
      return one_of(c, kUnsaid) && !sum;
    }
    return kind == Kind::symbol && !one_of(c, kSaidSymbols);
  }

  // "!!!" and " !" and "..." are one sign at the end of the word before.
  bool punctuation(char32_t c) {
    if (!one_of(c, kClauseSigns)) return false;
    std::size_t end = at_;
    bool question = false, shout = false;
    for (; end < in_.size(); ++end) {
      const char32_t sign = at(end);
      const bool blanks = is_blank(sign) && one_of(at(end + 1), kClauseSigns);
      if (!one_of(sign, kClauseSigns) && !blanks) break;
      question = question || one_of(sign, U"?⁇⁈⁉");
      shout = shout || one_of(sign, U"!‼");
    }
    const bool alone = at_ == 0 || is_blank(before());
    // ".5", ".net": part of a word.
    if (end == at_ + 1 && !(alone && (end >= in_.size() || is_blank(at(end))))) return false;
    const bool dots = !question && !shout;
    const char32_t sign = question ? U'?' : shout ? U'!' : U'.';
    const Place place = in_.place(at_, end);
    while (!out_.text.empty() && is_blank(out_.text.back())) drop();
    const bool word =
        !out_.text.empty() && (in_word(out_.text.back()) || is_digit(out_.text.back()));
    if (word)
      out_.add(dots && end - at_ > 1 ? std::u32string(U"...") : std::u32string(1, sign), place);
    if (word && end < in_.size() && !is_blank(at(end))) out_.add(U" ", place);
    at_ = end;
    return true;
  }

  bool begins_address() const {
    for (const std::u32string_view begin : {U"http://", U"https://", U"ftp://", U"www."}) {
      std::size_t k = 0;
      while (k < begin.size() && lower(at(at_ + k)) == begin[k]) ++k;
      if (k == begin.size()) return true;
    }
    return false;
  }

  // https://www.x.y/z: without what nobody says; its parts with pauses.
  bool address() {
    if (!starts_word() || !begins_address()) return false;
    std::size_t end = at_;
    while (end < in_.size() && !is_blank(at(end)) && at(end) < 0x80 && !one_of(at(end), U"<>\"'()"))
      ++end;
    while (end > at_ && one_of(at(end - 1), U".,;:!?/")) --end;
    const std::string token = dam::lower_case(utf8(in_.text.substr(at_, end - at_)));
    std::size_t skip = 0;
    for (const std::string_view scheme : {"http://", "https://", "ftp://"}) {
      if (token.starts_with(scheme)) skip = scheme.size();
    }
    const bool www = token.substr(skip).starts_with("www.");
    if (skip == 0 && !www) return false;
    if (www) skip += 4;
    const Place place = in_.place(at_, end);
    for (std::size_t i = at_ + skip; i < end; ++i) {
      const char32_t c = at(i);
      if (c == U'/' && i + 1 < end)
        out_.add(U", ", place);
      else if (one_of(c, U"/-_?=&#~:+%"))
        out_.add(U" ", place);
      else
        out_.add({&c, 1}, place);
    }
    at_ = end;
    if (at(at_) == U'/') ++at_;
    return true;
  }

  const SpokenText& in_;
  const Writing& writing_;
  std::string base_;
  AmountReader amounts_;
  SpokenText out_;
  std::size_t at_ = 0;
  std::size_t run_begin_ = 0, run_end_ = 0;  // in out_, of what has no blank
};

}  // namespace

bool has_words(std::u32string_view text) {
  return std::any_of(text.begin(), text.end(), [](char32_t c) {
    const Kind kind = kind_of(c);
    return kind == Kind::letter || kind == Kind::digit;
  });
}

bool is_unit(std::u32string_view text, std::size_t first, std::size_t last) {
  // Of °C and km/h the letters come one by one.
  const auto part = [&](std::size_t at) {
    return text[at] == U'°' || text[at] == U'/' || (text[at] < 0x80 && is_letter(text[at]));
  };
  while (first > 0 && part(first - 1)) --first;
  while (last < text.size() && part(last)) ++last;
  std::size_t number = first;
  while (number > 0 && text[number - 1] == U' ') --number;
  const std::u32string_view sign = text.substr(first, last - first);
  const std::string lower = dam::lower_case(utf8(sign));
  const bool after = number > 0 && digit_value(text[number - 1]) >= 0;
  return after && (!unit_of(sign).empty() || lower == "am" || lower == "pm");
}

SpokenText read_written(const SpokenText& said, const Writing& writing) {
  if (!unicode_here() || said.size() == 0) return said;
  return WrittenReader(said, writing).read();
}

}  // namespace animeme::text
