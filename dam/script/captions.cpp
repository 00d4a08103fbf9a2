#include "dam/script/captions.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

// Costs of a caption. They only have an order of magnitude: a cut inside a clause is worse than a
// second line, which is worse than a caption more; what is too short or too long is worst.
constexpr double kCaption = 2, kSecondLine = 5, kLineInClause = 2;
constexpr double kEndOfClause = 2, kEndAtPause = 4, kEndInClause = 8;
constexpr double kSentenceInside = 2, kPauseInside = 20, kTooShort = 30;

constexpr double kPause = 0.15;   // seconds between sentences, even when speech is fast
constexpr double kLongPause = 1;  // seconds: what follows is not expected yet

// How well words can be parted.
enum class Cut : std::uint8_t { clause, pause, inside, sentence };

struct Measured {
  ScriptWord word;
  std::size_t columns = 0;  // of the word
  bool blank = false;       // before it, inside a line
  double pause = 0;         // seconds after it
  Cut cut = Cut::inside;    // after it
};

bool is_between(char32_t c, char32_t first, char32_t last) { return c >= first && c <= last; }

// Scripts whose characters are two columns wide.
bool is_wide(char32_t c) {
  return is_between(c, 0x1100, 0x115F) || is_between(c, 0x2E80, 0xA4CF) ||
         is_between(c, 0xAC00, 0xD7A3) || is_between(c, 0xF900, 0xFAFF) ||
         is_between(c, 0xFE30, 0xFE4F) || is_between(c, 0xFF00, 0xFF60) ||
         is_between(c, 0x1F300, 0x1FAFF) || is_between(c, 0x20000, 0x3FFFD);
}

// Marks above and below a letter take no column of their own.
bool is_combining(char32_t c) {
  return is_between(c, 0x0300, 0x036F) || is_between(c, 0x064B, 0x065F) ||
         is_between(c, 0x200B, 0x200F) || is_between(c, 0xFE00, 0xFE0F);
}

std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  while (!text.empty()) {
    const char32_t c = take_code_point(text);
    columns += is_combining(c) ? 0 : is_wide(c) ? 2 : 1;
  }
  return columns;
}

bool is_closing(char32_t c) {
  return c == U'"' || c == U'\'' || c == U')' || c == U']' || c == 0x2019 || c == 0x201D ||
         c == 0xBB || c == 0x300D || c == 0x300F || c == 0xFF09;
}

std::u32string code_points_of(std::string_view text) {
  std::u32string out;
  while (!text.empty()) out += take_code_point(text);
  return out;
}

Cut cut_after(std::string_view text, double pause) {
  const std::u32string code = code_points_of(text);
  std::size_t size = code.size();
  while (size > 0 && is_closing(code[size - 1])) --size;
  const char32_t last = size > 0 ? code[size - 1] : U' ';
  constexpr std::u32string_view kSentence = U"?!\u3002\uFF01\uFF1F\u061F\u0964\u2026";
  constexpr std::u32string_view kClause = U",;:\u2013\u2014\u3001\uFF0C\uFF1B\uFF1A\u060C\u061B";
  if (kSentence.find(last) != kSentence.npos) return Cut::sentence;
  // After an abbreviation or an initial nobody pauses.
  if (last == U'.' && pause >= kPause) return Cut::sentence;
  if (kClause.find(last) != kClause.npos) return Cut::clause;
  const bool dash = last == U'-' && (size == 1 || code[size - 2] == U'-' || code[size - 2] == U' ');
  return dash ? Cut::clause : pause >= 2 * kPause ? Cut::pause : Cut::inside;
}

// The phones, where no word is known.
std::vector<ScriptWord> phones_as_words(const Script& script) {
  std::vector<ScriptWord> words;
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const Phone& phone = script.phones[i];
    if (phone.label != kSilence) words.push_back({phone.start, phone.end, phone.label, i, i + 1});
  }
  return words;
}

std::vector<Measured> measured(const std::vector<ScriptWord>& words) {
  std::vector<Measured> out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    Measured one;
    const bool last = i + 1 == words.size();
    one.pause = last ? 0 : words[i + 1].start - words[i].end;
    one.cut = cut_after(words[i].text, one.pause);
    one.blank = i > 0 && blank_between(words[i - 1].text, words[i].text);
    one.columns = columns_of(words[i].text);
    one.word = words[i];
    out.push_back(std::move(one));
  }
  return out;
}

// The best caption of words `first` to `last` (one past the last).
struct Shape {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t second = 0;  // first word of the second line; 0: one line
};

class Cutter {
 public:
  Cutter(std::vector<Measured> words, double end, const CaptionLimits& limits)
      : words_(std::move(words)), end_(end), limits_(limits) {
    starts_ = {0};
    for (const Measured& word : words_)
      starts_.push_back(starts_.back() + word.columns + (word.blank ? 1 : 0));
  }

  std::vector<Caption> cut() {
    struct Best {
      double cost = std::numeric_limits<double>::infinity();
      std::size_t first = 0;
      std::size_t second = 0;
    };
    std::vector<Best> best(words_.size() + 1);
    best[0].cost = 0;
    for (std::size_t last = 1; last <= words_.size(); ++last) {
      for (std::size_t first = last; first-- > 0;) {
        if (last - first > 1 && !fits(first, last)) break;
        const Shape shape = shape_of(first, last);
        const double cost = best[first].cost + shape.cost;
        if (cost < best[last].cost) best[last] = {cost, first, shape.second};
      }
    }
    std::vector<Caption> captions;
    for (std::size_t last = words_.size(); last > 0; last = best[last].first)
      captions.push_back(caption(best[last].first, best[last].second, last));
    std::reverse(captions.begin(), captions.end());
    // One that is said just before the next one, or the end, begins earlier.
    for (std::size_t i = 0; i < captions.size(); ++i) {
      const double from = i > 0 ? captions[i - 1].end : 0;
      const double wanted = captions[i].end - limits_.shortest;
      captions[i].start = std::min(captions[i].start, std::max(from, wanted));
    }
    return captions;
  }

 private:
  std::size_t columns(std::size_t first, std::size_t last) const {
    return starts_[last] - starts_[first] - (words_[first].blank ? 1 : 0);
  }
  bool on_a_line(std::size_t first, std::size_t last) const {
    return columns(first, last) <= limits_.columns || last - first == 1;
  }
  // A bound: no caption with more words fits, either.
  bool fits(std::size_t first, std::size_t last) const {
    return columns(first, last) <= limits_.lines * (limits_.columns + 1) &&
           words_[last - 1].word.end - words_[first].word.start <= limits_.longest;
  }
  // The time in which a caption may be seen: from the end of the word before to the next word.
  double seen_from(std::size_t first) const { return first > 0 ? words_[first - 1].word.end : 0; }
  double seen_until(std::size_t last) const {
    return last < words_.size() ? words_[last].word.start
                                : std::max(end_, words_[last - 1].word.end);
  }

  // Where the second line begins: at the best cut, then where the lines are most alike.
  std::size_t second_line(std::size_t first, std::size_t last) const {
    std::size_t best = 0;
    std::pair<double, std::size_t> least{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = first + 1; i < last; ++i) {
      if (!on_a_line(first, i) || !on_a_line(i, last)) continue;
      const std::size_t above = columns(first, i), below = columns(i, last);
      const std::pair<double, std::size_t> cost{
          words_[i - 1].cut == Cut::inside ? kLineInClause : 0,
          above > below ? above - below : below - above};
      if (cost < least) {
        least = cost;
        best = i;
      }
    }
    return best;
  }

  Shape shape_of(std::size_t first, std::size_t last) const {
    Shape shape;
    double cost = kCaption;
    if (!on_a_line(first, last)) {
      shape.second = limits_.lines > 1 ? second_line(first, last) : 0;
      if (shape.second == 0) return shape;
      cost += kSecondLine + (words_[shape.second - 1].cut == Cut::inside ? kLineInClause : 0);
    }
    for (std::size_t i = first; i + 1 < last; ++i) {
      if (words_[i].cut == Cut::sentence) cost += kSentenceInside;
      if (words_[i].pause > kLongPause) cost += kPauseInside;
    }
    if (last < words_.size()) {
      const Cut cut = words_[last - 1].cut;
      if (cut == Cut::clause) cost += kEndOfClause;
      if (cut == Cut::pause) cost += kEndAtPause;
      if (cut == Cut::inside) cost += kEndInClause;
    }
    if (seen_until(last) - seen_from(first) < limits_.shortest) cost += kTooShort;
    shape.cost = cost;
    return shape;
  }

  Caption caption(std::size_t first, std::size_t second, std::size_t last) const {
    Caption out;
    out.start = words_[first].word.start;
    const double said = words_[last - 1].word.end;
    out.end = std::max(said, std::min(out.start + limits_.shortest, seen_until(last)));
    const std::size_t middle = second == 0 ? last : second;
    for (const auto& [from, to] : {std::pair(first, middle), std::pair(middle, last)}) {
      if (from == to) continue;
      out.lines.emplace_back();
      for (std::size_t i = from; i < to; ++i) out.lines.back().push_back(words_[i].word);
    }
    return out;
  }

  std::vector<Measured> words_;
  std::vector<std::size_t> starts_;  // columns before each word if all were on one line
  double end_;                       // of the script
  CaptionLimits limits_;
};

}  // namespace

bool blank_between(std::string_view before, std::string_view after) {
  if (before.empty() || after.empty()) return false;
  std::size_t at = before.size() - 1;
  while (at > 0 && (static_cast<unsigned char>(before[at]) & 0xC0) == 0x80) --at;
  std::string_view last = before.substr(at);
  return !is_unspaced(take_code_point(last)) || !is_unspaced(take_code_point(after));
}

std::vector<Caption> captions_of(const std::vector<ScriptWord>& words, double end,
                                 const CaptionLimits& limits) {
  return Cutter(measured(words), end, limits).cut();
}

std::vector<Caption> captions_of(const Script& script, const CaptionLimits& limits) {
  const std::vector<ScriptWord> words = words_of(script);
  return captions_of(words.empty() ? phones_as_words(script) : words, script.duration(), limits);
}

std::string caption_line(const std::vector<ScriptWord>& line) {
  std::string text;
  for (const ScriptWord& word : line) {
    if (blank_between(text, word.text)) text += ' ';
    text += word.text;
  }
  return text;
}

std::string caption_text(const Caption& caption) {
  std::string text;
  for (const auto& line : caption.lines) text += (text.empty() ? "" : "\n") + caption_line(line);
  return text;
}

}  // namespace animeme::dam
