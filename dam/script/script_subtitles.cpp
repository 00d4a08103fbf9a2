// SubRip, WebVTT and SubViewer (YouTube's .sbv): cues of words, with the time of each word
// (WebVTT), a cue per word, the word that is underlined (WhisperX), or a phrase whose words share
// its time.
#include <algorithm>
#include <optional>
#include <utility>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_finish_internal.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kLongestTag = 1000;
constexpr std::size_t kMostTags = 8;  // times as long as what is said: a time for each syllable
constexpr std::string_view kArrow = "-->", kSubtitlesHeader = "WEBVTT";

// The text of a cue while it is read.
struct CueText {
  Cue cue;
  std::vector<Line> lines;
  std::size_t bytes = 0;
};

Result<double> clock_at(std::string_view text, const Line& line, std::string_view what) {
  const auto time = parse_clock(text);
  if (time) return *time;
  return error_at_line(Code::syntax,
                       "the " + std::string(what) + " time " + in_quotes(trimmed(text)) +
                           " is not a cue time; write hh:mm:ss.mmm",
                       line.number, text.data() - line.text.data() + 1);
}

// "0:00:01.000,0:00:02.200": the comma; npos: the line is no such thing.
std::size_t comma_of_times(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) return comma;
  const bool times = parse_clock(line.substr(0, comma)) && parse_clock(line.substr(comma + 1));
  return times ? comma : std::string_view::npos;
}

// The times that a cue begins with; nothing where another line stands.
std::optional<Result<Cue>> times_of(const Line& line) {
  const std::size_t arrow = line.text.find(kArrow), comma = comma_of_times(line.text);
  if (arrow == std::string_view::npos && comma == std::string_view::npos) return std::nullopt;
  const bool by_arrow = arrow != std::string_view::npos;
  Cue cue;
  cue.line = line.number;
  const auto start = clock_at(line.text.substr(0, by_arrow ? arrow : comma), line, "start");
  if (!start) return start.error();
  // Settings of WebVTT and places of SubRip follow the end.
  std::string_view rest = line.text.substr(by_arrow ? arrow + kArrow.size() : comma + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  const auto end = clock_at(rest.substr(0, rest.find_first_of(" \t")), line, "end");
  if (!end) return end.error();
  cue.start = *start;
  cue.end = *end;
  return cue;
}

bool is_cue_number(std::string_view text) {
  text = trimmed(text);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// The number of the next cue, where the line above it looks empty and is not.
void drop_number(std::vector<Line>& lines) {
  const bool number = lines.size() > 1 && is_cue_number(lines.back().text);
  if (number && trimmed(lines.end()[-2].text).empty()) lines.pop_back();
}

// An empty line ends a cue; one of blanks does not, which is how captions that roll begin. SubRip
// has no empty cues: there the text begins behind the empty line.
Result<std::vector<CueText>> read_cues(std::string_view text) {
  const bool strict = text.starts_with(kSubtitlesHeader);
  std::vector<CueText> cues;
  LineReader reader(text);
  Line line;
  bool inside = false;
  while (reader.next(line)) {
    if (const auto cue = times_of(line)) {
      if (!*cue) return cue->error();
      if (inside) drop_number(cues.back().lines);
      cues.push_back({**cue, {}, 0});
      inside = true;
    } else if (inside && line.text.empty() && (strict || !cues.back().lines.empty())) {
      inside = false;
    } else if (inside) {
      // Before its lines are taken apart, which takes many times as much memory.
      cues.back().bytes += line.text.size() + 1;
      if (auto fits = check_size(cues.back().bytes / kMostTags, cues.back().cue.line); !fits) {
        return fits.error();
      }
      cues.back().lines.push_back(line);
    }
  }
  return cues;
}

bool is_tag(std::string_view inside) {
  if (inside.empty()) return false;
  const char c = inside[0];
  return c == '/' || c == '!' || (c >= '0' && c <= '9') || ((c | 0x20) >= 'a' && (c | 0x20) <= 'z');
}

// Takes "{\\an8}" off, which places a cue on the screen.
std::string without_places(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = text.find("{\\"), close = text.find('}', std::min(open, text.size()));
    if (close == std::string_view::npos) break;
    out += text.substr(0, open);
    text.remove_prefix(close + 1);
  }
  return out + std::string(text);
}

// What goes on from line to line of a cue.
struct Style {
  std::string speaker;
  bool underlined = false;
};

CueLine pieces_of(const Line& line, Style& style) {
  CueLine pieces = {{{}, std::nullopt, line.number, 1, style.underlined, style.speaker}};
  std::string_view rest = line.text;
  const auto add = [&](std::string_view text) {
    pieces.back().text += without_references(without_places(text));
  };
  while (!rest.empty()) {
    const std::size_t open = rest.find('<');
    if (open == std::string_view::npos) break;
    const std::size_t length = rest.substr(open + 1, kLongestTag).find('>');
    const bool closed = length != std::string_view::npos;
    const std::string_view inside = rest.substr(open + 1, closed ? length : 0);
    const std::size_t close = open + 1 + inside.size();
    if (!closed || !is_tag(inside)) {
      add(rest.substr(0, open + 1));
      rest.remove_prefix(open + 1);
      continue;
    }
    add(rest.substr(0, open));
    rest.remove_prefix(close + 1);
    const auto time = parse_clock(inside);
    const Style before = style;
    if (inside == "u" || inside == "/u") style.underlined = inside == "u";
    if (inside == "/v") style.speaker.clear();
    if (inside.starts_with("v ") || inside.starts_with("v.")) {
      const std::size_t blank = inside.find(' ');
      style.speaker = without_references(trimmed(inside.substr(std::min(blank, inside.size()))));
    }
    if (time || style.underlined != before.underlined || style.speaker != before.speaker) {
      pieces.push_back({{},
                        time,
                        line.number,
                        rest.data() - line.text.data() + 1,
                        style.underlined,
                        style.speaker});
    }
  }
  add(rest);
  return pieces;
}

}  // namespace

bool looks_like_subtitles(std::string_view text) {
  if (text.starts_with(kSubtitlesHeader)) return true;
  const auto rows = first_rows(text, 2);
  return std::any_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return (row.fields.size() >= 3 && row.fields[1] == kArrow && parse_clock(row.fields[0])) ||
           comma_of_times(row.text) != std::string_view::npos;
  });
}

Result<Timings> read_subtitles(std::string_view text, const ScriptOptions& options) {
  auto read = read_cues(text);
  if (!read) return read.error();
  std::vector<Cue> cues;
  for (CueText& one : *read) {
    Style style;
    for (const Line& line : one.lines) one.cue.lines.push_back(pieces_of(line, style));
    cues.push_back(std::move(one.cue));
  }
  Timings timings;
  add_words_of_cues(std::move(cues), options, timings);
  // write_webvtt() writes phones where no word is known.
  const bool phones = options.unit == LabelUnit::phones ||
                      (options.unit == LabelUnit::automatic && text.starts_with(kPhonesHeader));
  if (phones) decide_unit(timings.labels, LabelUnit::phones);
  return timings;
}

}  // namespace animeme::dam
