#include "tools/speech/text/mood_marks.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "dam/script/words.h"

namespace animeme::text {
namespace {

constexpr double kExclaimed = 1.2, kExclaimedMore = 1.35;  // "!", "!!"
constexpr double kRepeated = 0.15;  // what "😂😂" is stronger than "😂"

struct EmojiMood {
  std::u32string_view emoji;  // characters, each of which has the mood
  std::string_view mood;
  double intensity;
};

constexpr EmojiMood kEmoji[] = {
    {U"😀😃😄😁🤣😂😹", "joy", 1},
    {U"😆😸😺", "joy", 0.9},
    {U"😅😋😛😜🤪😝👏🤠", "joy", 0.6},
    {U"😊☺🤗😇", "friendly", 1},
    {U"🙂👍👋🤝", "friendly", 0.7},
    {U"🥳", "excited", 1},
    {U"🤩🎉🎊", "excited", 0.8},
    {U"🥰😍😘😻", "loving", 1},
    {U"😗😚😙❤💕💖💗💓💞💘🫶", "loving", 0.8},
    {U"😎💪", "proud", 0.9},
    {U"😉😏😼", "ironic", 0.8},
    {U"🙃😈", "ironic", 0.7},
    {U"🤔", "thinking", 1},
    {U"🤨🧐", "doubtful", 0.9},
    {U"😕🤷🥴", "confused", 0.8},
    {U"😐😑", "serious", 0.6},
    {U"😌🧘", "calm", 1},
    {U"🙄", "bored", 0.8},
    {U"😒", "disgruntled", 0.7},
    {U"😬🤭😳🫣", "embarrassed", 0.9},
    {U"😟🥺😓😥", "worried", 0.8},
    {U"🙁☹😔😞😿", "sadness", 0.7},
    {U"😢💔", "sadness", 0.8},
    {U"😭", "sadness", 1},
    {U"😖😣😩😫🤕🤒", "pain", 0.8},
    {U"😠😤😾", "anger", 0.8},
    {U"😡🤬👿", "anger", 1},
    {U"😦😧", "fear", 0.6},
    {U"😨😰", "fear", 0.85},
    {U"😱🙀", "fear", 1},
    {U"🤢", "disgust", 0.9},
    {U"🤮", "disgust", 1},
    {U"😮😯", "surprise", 0.7},
    {U"😲🤯", "surprise", 1},
    {U"😪🥱", "sleepy", 0.8},
    {U"😴💤", "sleepy", 1},
    {U"🤫", "whispering", 1},
};

struct Smiley {
  std::u32string_view text;
  std::string_view mood;
  double intensity;
};

constexpr Smiley kSmileys[] = {
    {U":-)", "friendly", 1},   {U":)", "friendly", 1},    {U"=)", "friendly", 1},
    {U":-D", "joy", 1},        {U":D", "joy", 1},         {U"=D", "joy", 1},
    {U"xD", "joy", 1},         {U"XD", "joy", 1},         {U"^^", "friendly", 0.8},
    {U"^_^", "friendly", 1},   {U":-P", "joy", 0.6},      {U":P", "joy", 0.6},
    {U":-p", "joy", 0.6},      {U":p", "joy", 0.6},       {U";-)", "ironic", 0.8},
    {U";)", "ironic", 0.8},    {U":-(", "sadness", 0.8},  {U":(", "sadness", 0.8},
    {U"=(", "sadness", 0.8},   {U":'(", "sadness", 1},    {U":'-(", "sadness", 1},
    {U":-/", "doubtful", 0.8}, {U":/", "doubtful", 0.8},  {U":-|", "serious", 0.6},
    {U":|", "serious", 0.6},   {U":-O", "surprise", 0.9}, {U":O", "surprise", 0.9},
    {U":-o", "surprise", 0.8}, {U":o", "surprise", 0.8},  {U":-*", "loving", 0.9},
    {U":*", "loving", 0.9},    {U">:(", "anger", 0.9},    {U">:-(", "anger", 0.9},
    {U"D:", "fear", 0.8},      {U"-_-", "bored", 0.8},    {U"o_O", "confused", 0.9},
    {U"O_o", "confused", 0.9},
};

bool is_gap(char32_t c) { return c <= U' ' || c == 0xA0 || c == 0x3000; }
bool breaks_line(char32_t c) { return c == U'\n' || c == U'\r' || c == 0x2028 || c == 0x2029; }
bool is_exclamation(char32_t c) { return c == U'!' || c == 0xFF01 || c == 0x203C || c == 0x2757; }
bool ends_clause(char32_t c) {
  constexpr std::u32string_view kEnds = U".?…。？｡؟।՞";
  return is_exclamation(c) || kEnds.find(c) != kEnds.npos;
}
// Signs that change the emoji in front of them: variants, skin, joiners.
bool modifies_emoji(char32_t c) {
  return c == 0xFE0F || c == 0xFE0E || c == 0x200D || (c >= 0x1F3FB && c <= 0x1F3FF);
}
// Letters and digits of any script, roughly: what is spoken.
bool is_sounded(char32_t c) {
  if (c < 0x80) return (c >= U'0' && c <= U'9') || ((c | 0x20) >= U'a' && (c | 0x20) <= U'z');
  const bool signs = (c >= 0x80 && c < 0xC0 && c != 0xAA && c != 0xB5 && c != 0xBA) || c == 0xD7 ||
                     c == 0xF7 || (c >= 0x2000 && c < 0x2C00) || (c >= 0x3000 && c < 0x3005) ||
                     (c >= 0x3008 && c < 0x3012) || (c >= 0xFE00 && c < 0xFE70) ||
                     (c >= 0xFF00 && c < 0xFF10) || c == 0xFF1F || c == 0xFF61 || c == 0x061F ||
                     c == 0x0964 || c >= 0x1F000;
  return !signs || (c >= 0x20000 && c < 0x40000);
}

struct FoundMark {
  dam::Mood mood;
  std::size_t length = 0;  // characters
};

std::optional<FoundMark> emoji_at(std::u32string_view text, std::size_t at) {
  for (const EmojiMood& row : kEmoji) {
    if (row.emoji.find(text[at]) == row.emoji.npos) continue;
    std::size_t end = at + 1;
    while (end < text.size() && modifies_emoji(text[end])) ++end;
    return FoundMark{{std::string(row.mood), row.intensity}, end - at};
  }
  return std::nullopt;
}

// Between blanks; the end of a sentence may be in front of it.
std::optional<FoundMark> smiley_at(std::u32string_view text, std::size_t at) {
  if (at > 0 && !is_gap(text[at - 1]) && !ends_clause(text[at - 1])) return std::nullopt;
  for (const Smiley& row : kSmileys) {
    if (text.substr(at, row.text.size()) != row.text) continue;
    const std::size_t end = at + row.text.size();
    const bool over = end == text.size() || is_gap(text[end]) || ends_clause(text[end]) ||
                      text[end] == U',' || text[end] == U';';
    if (over) return FoundMark{{std::string(row.mood), row.intensity}, row.text.size()};
  }
  return std::nullopt;
}

std::optional<FoundMark> mark_at(std::u32string_view text, std::size_t at) {
  if (auto emoji = emoji_at(text, at)) return emoji;
  return smiley_at(text, at);
}

// "Mr." and the like, and initials.
bool is_abbreviated(std::u32string_view text, std::size_t stop) {
  constexpr std::u32string_view kTitles[] = {U"Mr", U"Mrs", U"Ms",  U"Dr",  U"Prof", U"St",
                                             U"Jr", U"Sr",  U"Mme", U"Sra", U"Hr",   U"Fr"};
  std::size_t first = stop;
  while (first > 0 && is_sounded(text[first - 1])) --first;
  const std::u32string_view word = text.substr(first, stop - first);
  const bool initial = word.size() == 1 && word[0] >= U'A' && word[0] <= U'Z';
  return text[stop] == U'.' &&
         (initial || std::find(std::begin(kTitles), std::end(kTitles), word) != std::end(kTitles));
}

// No operator: "!=".
bool is_exclamation_mark(std::u32string_view text, std::size_t at) {
  constexpr std::u32string_view kClosing = U"\"')]}»”’*_~";
  if (!is_exclamation(text[at])) return false;
  if (text[at] != U'!' || at + 1 == text.size()) return true;
  const char32_t next = text[at + 1];
  return is_gap(next) || ends_clause(next) || kClosing.find(next) != kClosing.npos || next >= 0x80;
}

// A clause that is being read.
class Clauses {
 public:
  explicit Clauses(std::u32string_view text) : text_(text) {}

  std::vector<MoodPlace> read() {
    for (std::size_t i = 0; i < text_.size();) {
      if (const auto mark = mark_at(text_, i)) {
        if (broken_ && goes_on_behind(i + mark->length)) close(i);
        take(mark->mood);
        i += mark->length;
        continue;
      }
      take(i);
      ++i;
    }
    close(text_.size());
    if (places_.empty() && mood_) add(0, text_.size());  // no words at all
    return std::move(places_);
  }

 private:
  void take(const dam::Mood& mood) {
    if (mood_ && *mood_ == mood) {
      stronger_ += kRepeated;
    } else if (!mood_) {
      mood_ = mood;
    }
    if (words_) marked_ = true;
  }

  void take(std::size_t at) {
    const char32_t c = text_[at];
    if (breaks_line(c)) {
      if (words_) over_ = broken_ = true;
    } else if (is_gap(c)) {
      if (stopped_) over_ = true;
    } else if (ends_clause(c)) {
      if (is_exclamation_mark(text_, at)) ++exclaimed_;
      stopped_ = !is_abbreviated(text_, at) || stopped_;
    } else if (is_sounded(c)) {
      if (over_ || marked_) close(at);
      words_ = true;
      stopped_ = false;
      exclaimed_ = 0;
    }
  }

  // Whether there are words in the rest of the line.
  bool goes_on_behind(std::size_t at) const {
    while (at < text_.size() && !breaks_line(text_[at]) && !is_sounded(text_[at])) ++at;
    return at < text_.size() && is_sounded(text_[at]);
  }

  void add(std::size_t first, std::size_t last) {
    const double gain = exclaimed_ == 0 ? 1 : exclaimed_ == 1 ? kExclaimed : kExclaimedMore;
    MoodPlace place{{std::uint32_t(first), std::uint32_t(last)}, mood_, gain};
    if (place.mood) place.mood->intensity = std::min(place.mood->intensity + stronger_, 1.0);
    if (place.mood || gain != 1) places_.push_back(std::move(place));
  }

  void close(std::size_t end) {
    if (!words_) return;
    add(first_, end);
    first_ = end;
    mood_.reset();
    stronger_ = 0;
    exclaimed_ = 0;
    words_ = stopped_ = over_ = broken_ = marked_ = false;
  }

  std::u32string_view text_;
  std::vector<MoodPlace> places_;
  std::size_t first_ = 0;  // of the clause
  std::optional<dam::Mood> mood_;
  double stronger_ = 0;
  int exclaimed_ = 0;     // marks behind the last word
  bool words_ = false;    // there have been some
  bool stopped_ = false;  // the sentence has ended
  bool over_ = false;     // and there was a blank, or the line has ended
  bool broken_ = false;   // the line has ended
  bool marked_ = false;   // there was an emoji behind words
};

}  // namespace

std::optional<dam::Mood> mood_of_emoji(std::u32string_view emoji) {
  if (emoji.empty()) return std::nullopt;
  const auto found = mark_at(emoji, 0);
  if (!found || found->length != emoji.size()) return std::nullopt;
  return found->mood;
}

std::vector<MoodPlace> find_moods(std::u32string_view text) { return Clauses(text).read(); }

void blank_smileys(SpokenText& said) {
  for (std::size_t i = 0; i < said.text.size();) {
    const auto smiley = smiley_at(said.text, i);
    const std::size_t length = smiley ? smiley->length : 1;
    if (smiley) std::fill_n(said.text.begin() + std::ptrdiff_t(i), length, U' ');
    i += length;
  }
}

std::vector<dam::MoodSpan> mood_spans(const std::vector<MoodPlace>& places,
                                      const std::vector<TimedPlace>& words, double end) {
  std::vector<dam::MoodSpan> spans;
  for (const MoodPlace& place : places) {
    std::size_t first = 0;
    while (first < words.size() &&
           (words[first].place < place.place.first || words[first].place >= place.place.last)) {
      ++first;
    }
    if (first == words.size()) continue;
    std::size_t last = first;
    while (last < words.size() && words[last].place < place.place.last) ++last;
    spans.push_back({words[first].start, last < words.size() ? words[last].start : end, place.mood,
                     place.gain});
  }
  return spans;
}

std::vector<dam::MoodSpan> find_moods(std::string_view text, const dam::Script& script) {
  const std::u32string source = code_points(text);
  const std::vector<MoodPlace> places = find_moods(source);
  if (places.empty()) return {};
  std::vector<TimedPlace> words;
  std::size_t at = 0;
  double end = 0;
  for (const dam::Phone& phone : script.phones)
    if (phone.label != dam::kSilence) end = phone.end;
  for (const dam::ScriptWord& word : dam::words_of(script)) {
    const std::u32string letters = code_points(word.text);
    const std::size_t found = source.find(letters, at);
    if (found == source.npos) continue;
    words.push_back({std::uint32_t(found), word.start});
    at = found + letters.size();
  }
  return mood_spans(places, words, end);
}

}  // namespace animeme::text
