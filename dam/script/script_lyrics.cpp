// Lyrics and karaoke: LRC, with and without times of words, and the dialogue of ASS.
#include <algorithm>
#include <cmath>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_finish_internal.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kLongestBracket = 1000;
constexpr std::size_t kMostRepeats = 100;  // of a line of the greatest length

// What is between the brackets that a text begins with; nothing if it begins otherwise.
std::optional<std::string_view> take_brackets(std::string_view& text, char open, char close) {
  if (!text.starts_with(open)) return std::nullopt;
  const std::size_t end = text.substr(0, kLongestBracket).find(close);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view inside = text.substr(1, end - 1);
  text.remove_prefix(end + 1);
  return inside;
}

// The words of a line of LRC, with their times.
CueLine lyrics_of(std::string_view text, const Line& line, double offset) {
  CueLine pieces = {{{}, std::nullopt, line.number, text.data() - line.text.data() + 1, false, {}}};
  while (!text.empty()) {
    std::string_view rest = text;
    const auto inside = take_brackets(rest, '<', '>');
    const auto time = inside ? parse_clock(*inside) : std::nullopt;
    if (!time) {
      pieces.back().text += text[0];
      text.remove_prefix(1);
      continue;
    }
    text = rest;
    pieces.push_back({{},
                      std::max(0.0, *time - offset),
                      line.number,
                      text.data() - line.text.data() + 1,
                      false,
                      {}});
  }
  return pieces;
}

// A line that says no end lasts as long as it usually takes.
void end_lyrics(std::vector<Cue>& cues) {
  std::stable_sort(cues.begin(), cues.end(),
                   [](const Cue& a, const Cue& b) { return a.start < b.start; });
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const CuePiece& last = cues[i].lines[0].back();
    const TimedLabel word{0, 0, last.text, {}, 0, 0, true};
    cues[i].end = last.start.value_or(cues[i].start) + longest_event(word);
    if (i + 1 < cues.size()) cues[i].end = std::min(cues[i].end, cues[i + 1].start);
  }
}

// The columns of a dialogue that are wanted.
struct AssColumns {
  std::size_t start = 1, end = 2, name = 4, text = 9;
};

AssColumns ass_columns(std::string_view format) {
  AssColumns columns;
  const auto fields = split_fields(format, ',');
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name = lower_case(trimmed(fields[i]));
    if (name == "start") columns.start = i;
    if (name == "end") columns.end = i;
    if (name == "name" || name == "actor") columns.name = i;
    if (name == "text") columns.text = i;
  }
  return columns;
}

// Hundredths of a second of the syllable that follows: "\k40", "\kf40", "\ko40".
std::optional<double> syllable_of(std::string_view tags) {
  std::optional<double> length;
  for (std::size_t at = tags.find('\\'); at < tags.size(); at = tags.find('\\', at + 1)) {
    std::string_view tag = tags.substr(at + 1, tags.find('\\', at + 1) - at - 1);
    if (!tag.starts_with('k') && !tag.starts_with('K')) continue;
    tag.remove_prefix(std::min(tag.find_first_of("0123456789"), tag.size()));
    if (const auto number = parse_number(tag)) length = *number / 100;
  }
  return length;
}

std::vector<CueLine> dialogue_of(std::string_view text, const Line& line, double start,
                                 const std::string& speaker) {
  std::vector<CueLine> lines(1);
  double reached = start, next = start;
  const auto add = [&](std::optional<double> from) {
    lines.back().push_back(
        {{}, from, line.number, text.data() - line.text.data() + 1, false, speaker});
  };
  add(std::nullopt);
  while (!text.empty()) {
    if (const auto tags = take_brackets(text, '{', '}')) {
      if (const auto length = syllable_of(*tags)) {
        reached = next;
        next += *length;
        add(reached);
      }
    } else if (text.starts_with("\\N")) {
      text.remove_prefix(2);
      lines.emplace_back();
      add(std::nullopt);
    } else if (text.starts_with("\\n") || text.starts_with("\\h")) {
      text.remove_prefix(2);
      lines.back().back().text += ' ';
    } else {
      lines.back().back().text += text[0];
      text.remove_prefix(1);
    }
  }
  return lines;
}

}  // namespace

bool looks_like_lrc(std::string_view text) {
  for (const LabelRow& row : first_rows(text, 30)) {
    std::string_view rest = row.text;
    const auto inside = take_brackets(rest, '[', ']');
    if (!inside || inside->find(':') == std::string_view::npos) return false;
    if (parse_clock(*inside)) return true;
  }
  return false;
}

Result<Timings> read_lrc(std::string_view text, const ScriptOptions& options) {
  std::vector<Cue> cues;
  LineReader reader(text);
  Line line;
  double offset = 0;  // seconds that the words come earlier
  while (reader.next(line)) {
    std::string_view rest = trimmed(line.text);
    std::vector<double> starts;
    while (const auto inside = take_brackets(rest, '[', ']')) {
      if (const auto time = parse_clock(*inside)) starts.push_back(std::max(0.0, *time - offset));
      if (inside->starts_with("offset:")) {
        offset = std::clamp(parse_number(inside->substr(7)).value_or(0) / 1000, -1e6, 1e6);
      }
    }
    if (!std::isfinite(offset)) offset = 0;
    if (auto fits = check_size(starts.size() * rest.size() / kMostRepeats, line.number); !fits) {
      return fits.error();
    }
    for (const double start : starts) {
      // A line that is sung again has its words' times once.
      const bool again = start != starts[0];
      CueLine pieces = lyrics_of(rest, line, offset);
      if (again) {
        for (CuePiece& piece : pieces) piece.start.reset();
      }
      cues.push_back({start, start, line.number, {std::move(pieces)}});
    }
  }
  end_lyrics(cues);
  Timings timings;
  add_words_of_cues(std::move(cues), options, timings);
  return timings;
}

bool looks_like_ass(std::string_view text) {
  return text.substr(0, 64).find("[Script Info]") != std::string_view::npos ||
         text.starts_with("[Events]") || text.starts_with("Dialogue:");
}

Result<Timings> read_ass(std::string_view text, const ScriptOptions& options) {
  constexpr std::string_view kFormat = "Format:", kDialogue = "Dialogue:";
  AssColumns columns;
  std::vector<Cue> cues;
  LineReader reader(text);
  Line line;
  bool events = !text.starts_with("[Script");
  while (reader.next(line)) {
    if (line.text.starts_with('[')) events = line.text.starts_with("[Events]");
    if (events && line.text.starts_with(kFormat)) {
      columns = ass_columns(line.text.substr(kFormat.size()));
    }
    if (!line.text.starts_with(kDialogue)) continue;
    std::string_view rest = line.text.substr(kDialogue.size());
    std::vector<std::string_view> fields = split_fields(rest, ',');
    if (fields.size() <= std::max({columns.start, columns.end, columns.text})) {
      return error_at_line(Code::syntax, "a dialogue has fewer fields than the format names",
                           line.number);
    }
    const auto start = parse_clock(fields[columns.start]), end = parse_clock(fields[columns.end]);
    if (!start || !end) {
      return error_at_line(Code::syntax, "a dialogue begins with its times, h:mm:ss.cc",
                           line.number);
    }
    const std::string speaker(columns.name < fields.size() ? trimmed(fields[columns.name])
                                                           : std::string_view());
    const char* from = fields[columns.text].data();  // with its commas
    cues.push_back({*start, *end, line.number,
                    dialogue_of({from, std::size_t(line.text.data() + line.text.size() - from)},
                                line, *start, speaker)});
  }
  if (cues.empty()) return nothing_in("ASS file");
  Timings timings;
  add_words_of_cues(std::move(cues), options, timings);
  return timings;
}

}  // namespace animeme::dam
