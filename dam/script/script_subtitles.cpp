// SubRip and WebVTT: cues of words, with the time of each word (WebVTT), a cue per word, the word
// that is underlined (WhisperX), or a phrase whose words share its time.
#include <algorithm>
#include <optional>
#include <utility>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

constexpr std::string_view kArrow = "-->";

struct Cue {
  double start = 0, end = 0;
  std::int64_t line = 0;    // of its times
  std::vector<Line> lines;  // of its text
};

// "01:02:03.456", "02:03,456"; nothing if it is no such time.
std::optional<double> parse_clock(std::string_view text) {
  std::string digits(trimmed(text));
  std::replace(digits.begin(), digits.end(), ',', '.');
  std::string_view rest = digits;
  double seconds = 0;
  for (int part = 0; part < 3; ++part) {
    const std::size_t colon = rest.find(':');
    const auto value = parse_number(rest.substr(0, colon));
    if (!value || !(*value >= 0) || !(*value < 1e6)) return std::nullopt;
    seconds = seconds * 60 + *value;
    if (colon == std::string_view::npos) {
      return part > 0 ? std::optional(seconds) : std::nullopt;
    }
    rest.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

Result<double> clock_at(std::string_view text, const Line& line, std::string_view what) {
  const auto time = parse_clock(text);
  if (time) return *time;
  return error_at_line(Code::syntax,
                       "the " + std::string(what) + " time " + in_quotes(trimmed(text)) +
                           " is not a cue time; write hh:mm:ss.mmm",
                       line.number, text.data() - line.text.data() + 1);
}

Result<std::vector<Cue>> read_cues(std::string_view text) {
  std::vector<Cue> cues;
  LineReader reader(text);
  Line line;
  bool inside = false;
  while (reader.next(line)) {
    const std::size_t arrow = line.text.find(kArrow);
    if (arrow != std::string_view::npos) {
      Cue cue;
      cue.line = line.number;
      const auto start = clock_at(line.text.substr(0, arrow), line, "start");
      if (!start) return start.error();
      // WebVTT settings follow the end.
      std::string_view rest = line.text.substr(arrow + kArrow.size());
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      const auto end = clock_at(rest.substr(0, rest.find_first_of(" \t")), line, "end");
      if (!end) return end.error();
      cue.start = *start;
      cue.end = *end;
      cues.push_back(std::move(cue));
      inside = true;
    } else if (trimmed(line.text).empty()) {
      inside = false;
    } else if (inside) {
      cues.back().lines.push_back(line);
    }
  }
  return cues;
}

// What a tag is: a time, the beginning or the end of underlining, or nothing of interest.
struct Tag {
  std::optional<double> time;
  int underline = 0;
};

Tag tag_of(std::string_view inside) {
  if (inside == "u") return {std::nullopt, 1};
  if (inside == "/u") return {std::nullopt, -1};
  return {parse_clock(inside), 0};
}

// A piece of the text of a cue, and when it begins if that is said.
struct Piece {
  std::string text;
  std::optional<double> start;
  std::int64_t line = 0, column = 0;
  bool underlined = false;
};

// Characters in brackets are no speech: "[Music]", "(laughs)", "{\\an8}".
void append_spoken(Piece& piece, std::string_view text, int& brackets) {
  constexpr std::pair<std::string_view, char> kEntities[] = {{"&amp;", '&'}, {"&lt;", '<'},
                                                             {"&gt;", '>'},  {"&nbsp;", ' '},
                                                             {"&lrm;", ' '}, {"&rlm;", ' '}};
  while (!text.empty()) {
    const char c = text[0];
    if (c == '[' || c == '(' || c == '{') ++brackets;
    const auto entity = std::find_if(std::begin(kEntities), std::end(kEntities),
                                     [&](const auto& e) { return text.starts_with(e.first); });
    const bool named = entity != std::end(kEntities);
    if (brackets == 0) piece.text += named ? entity->second : c;
    if ((c == ']' || c == ')' || c == '}') && brackets > 0) --brackets;
    text.remove_prefix(named ? entity->first.size() : 1);
  }
}

std::vector<Piece> pieces_of(const Line& line, int& brackets) {
  std::vector<Piece> pieces = {{{}, std::nullopt, line.number, 1, false}};
  std::string_view rest = line.text;
  while (!rest.empty()) {
    const std::size_t open = rest.find('<'), close = rest.find('>', std::min(open, rest.size()));
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    append_spoken(pieces.back(), rest.substr(0, open), brackets);
    const Tag tag = tag_of(rest.substr(open + 1, close - open - 1));
    rest.remove_prefix(close + 1);
    if (tag.time || tag.underline != 0) {
      const bool under = tag.underline > 0 || (tag.time && pieces.back().underlined);
      pieces.push_back({{}, tag.time, line.number, rest.data() - line.text.data() + 1, under});
    }
  }
  append_spoken(pieces.back(), rest, brackets);
  return pieces;
}

struct Kinds {
  bool timed = false, underlined = false;
};

// How a file marks words.
Kinds kinds_of(const std::vector<Cue>& cues) {
  Kinds kinds;
  for (const Cue& cue : cues) {
    for (const Line& line : cue.lines) {
      int brackets = 0;
      for (const Piece& piece : pieces_of(line, brackets)) {
        kinds.timed = kinds.timed || piece.start;
        kinds.underlined = kinds.underlined || piece.underlined;
      }
    }
  }
  return kinds;
}

TimedLabel label_of(const Piece& piece, double start, double end) {
  return {start, end, std::string(trimmed(piece.text)), {}, piece.line, piece.column, true};
}

// Words with times of their own. Lines without any are repeated ones of captions that roll.
void add_timed(const Cue& cue, std::vector<TimedLabel>& labels) {
  std::vector<Piece> pieces;
  int brackets = 0;
  for (const Line& line : cue.lines) {
    auto more = pieces_of(line, brackets);
    const bool timed =
        std::any_of(more.begin(), more.end(), [](const Piece& p) { return p.start; });
    if (timed) pieces.insert(pieces.end(), more.begin(), more.end());
  }
  std::vector<TimedLabel> found;
  double start = cue.start;
  for (const Piece& piece : pieces) {
    if (piece.start) start = *piece.start;
    if (!found.empty() && found.back().end <= found.back().start) found.back().end = start;
    if (!trimmed(piece.text).empty()) found.push_back(label_of(piece, start, start));
  }
  if (!found.empty() && found.back().end <= found.back().start) found.back().end = cue.end;
  labels.insert(labels.end(), found.begin(), found.end());
}

void add_cue(const Cue& cue, const Kinds& kinds, std::vector<TimedLabel>& labels) {
  TimedLabel whole{cue.start, cue.end, {}, {}, cue.line, 1, true};
  int brackets = 0;
  for (const Line& line : cue.lines) {
    for (const Piece& piece : pieces_of(line, brackets)) {
      if (kinds.underlined && !piece.underlined) continue;
      const std::string_view text = trimmed(piece.text);
      if (!text.empty()) whole.label += (whole.label.empty() ? "" : " ") + std::string(text);
    }
  }
  if (!whole.label.empty()) labels.push_back(std::move(whole));
}

}  // namespace

bool looks_like_subtitles(std::string_view text) {
  if (text.starts_with("WEBVTT")) return true;
  const auto rows = first_rows(text, 2);
  return std::any_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return row.fields.size() >= 3 && row.fields[1] == kArrow && parse_clock(row.fields[0]);
  });
}

Result<Timings> read_subtitles(std::string_view text, const ScriptOptions& options) {
  const auto cues = read_cues(text);
  if (!cues) return cues.error();
  const Kinds kinds = kinds_of(*cues);
  Timings timings;
  for (const Cue& cue : *cues) {
    if (kinds.timed) {
      add_timed(cue, timings.labels);
    } else {
      add_cue(cue, kinds, timings.labels);
    }
  }
  // A file of phones, as write_webvtt() makes where no word is known.
  if (options.unit != LabelUnit::words) {
    std::vector<TimedLabel> as_phones = timings.labels;
    decide_unit(as_phones, options.unit);
    if (!has_words({{}, Alphabet::automatic, as_phones})) timings.labels = std::move(as_phones);
  }
  return timings;
}

}  // namespace animeme::dam
