// Scripts of mouths: Rhubarb Lip Sync as TSV and XML, and the switch data of Moho.
#include <algorithm>
#include <cmath>

#include "dam/script/marks.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"
#include "dam/script/viseme_phones.h"

namespace animeme::dam {
namespace {

constexpr double kMohoRate = 24;  // frames; the default of Rhubarb and Papagayo

Result<std::string> phone_of(VisemeSet set, std::string_view name, std::int64_t line,
                             std::int64_t column) {
  const auto label = phone_of_viseme(set, name);
  if (label) return std::string(*label);
  if (is_mark(name)) return std::string(name);
  return error_at_line(
      Code::not_found,
      "unknown mouth " + in_quotes(name) +
          (set == VisemeSet::rhubarb ? "; Rhubarb's are A to H and X"
                                     : "; these are AI E O U L WQ MBP FV etc rest"),
      line, column);
}

bool is_shape(std::string_view name) {
  return phone_of_viseme(VisemeSet::rhubarb, name).has_value() || is_mark(name);
}

Result<Timings> read_events(std::string_view text, VisemeSet set, double rate, double first) {
  Timings timings;
  timings.alphabet = Alphabet::arpabet;
  LabelRows reader(text, "MohoSwitch1");
  LabelRow row;
  while (reader.next(row)) {
    const auto time = row.seconds(0, "start");
    if (!time) return time.error();
    if (row.fields.size() < 2) return row.error(Code::syntax, "the line lacks its mouth", 1);
    const auto label = phone_of(set, row.fields[1], row.line, row.column(1));
    if (!label) return label.error();
    const double start = std::max(0.0, (*time - first) / rate);
    timings.labels.push_back({start, start, *label, {}, row.line, row.column(1), false});
  }
  end_at_next_start(timings.labels, longest_event);
  return timings;
}

// Rhubarb writes its letters into switch data, too, if asked. "E" is in both sets.
VisemeSet moho_set(std::string_view text) {
  LabelRows reader(text, "MohoSwitch1");
  LabelRow row;
  while (reader.next(row)) {
    if (row.fields.size() > 1 && !is_shape(row.fields[1])) return VisemeSet::preston_blair;
  }
  return VisemeSet::rhubarb;
}

// The value of an attribute in the text of a tag; nothing if it is not there.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::size_t at = tag.find(std::string(name) + "=\"");
  if (at == std::string_view::npos) return {};
  tag.remove_prefix(at + name.size() + 2);
  return tag.substr(0, tag.find('"'));
}

}  // namespace

bool looks_like_rhubarb_tsv(std::string_view text) {
  const auto rows = first_rows(text, 20);
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return row.fields.size() == 2 && row.is_number(0) && is_shape(row.fields[1]);
  });
}

Result<Timings> read_rhubarb_tsv(std::string_view text, const ScriptOptions& options) {
  return read_events(text, VisemeSet::rhubarb, rate_or(options, 1), 0);
}

bool looks_like_moho(std::string_view text) { return text.starts_with("MohoSwitch1"); }

// Frames count from 1.
Result<Timings> read_moho(std::string_view text, const ScriptOptions& options) {
  return read_events(text, moho_set(text), rate_or(options, kMohoRate), 1);
}

bool looks_like_rhubarb_xml(std::string_view text) {
  return text.starts_with('<') &&
         text.substr(0, 4096).find("<rhubarbResult") != std::string_view::npos;
}

// Its elements have two attributes and a letter, all of them plain: <mouthCue start="0.00"
// end="0.05">X</mouthCue>.
Result<Timings> read_rhubarb_xml(std::string_view text, const ScriptOptions&) {
  constexpr std::string_view kCue = "<mouthCue ";
  Timings timings;
  timings.alphabet = Alphabet::arpabet;
  LineReader reader(text);
  Line line;
  bool closed = false;
  while (reader.next(line)) {
    closed = closed || line.text.find("</rhubarbResult>") != std::string_view::npos;
    for (std::size_t at = line.text.find(kCue); at != std::string_view::npos;
         at = line.text.find(kCue, at + 1)) {
      const std::string_view cue = line.text.substr(at);
      const auto column = std::int64_t(at) + 1;
      const std::size_t close = cue.find('>'), end_tag = cue.find('<', 1);
      if (close == std::string_view::npos || end_tag == std::string_view::npos || end_tag < close) {
        return error_at_line(Code::truncated, "the mouthCue that begins here does not end",
                             line.number, column);
      }
      const std::string_view tag = cue.substr(0, close);
      const auto start = parse_seconds(attribute(tag, "start"), line.number, "start", column);
      if (!start) return start.error();
      const auto end = parse_seconds(attribute(tag, "end"), line.number, "end", column);
      if (!end) return end.error();
      const auto label = phone_of(VisemeSet::rhubarb, cue.substr(close + 1, end_tag - close - 1),
                                  line.number, column + std::int64_t(close) + 1);
      if (!label) return label.error();
      timings.labels.push_back({*start, *end, *label, {}, line.number, column, false});
    }
  }
  if (!closed) return make_error(Code::truncated, "the XML ends before </rhubarbResult>");
  return timings;
}

bool looks_like_papagayo(std::string_view text) { return text.starts_with("lipsync version"); }

// Names and numbers, each on a line of its own: voices, in them phrases, in them words, in them
// mouths. Frames count from 0.
Result<Timings> read_papagayo(std::string_view text, const ScriptOptions& options) {
  LineReader reader(text);
  Line line;
  Timings timings;
  timings.alphabet = Alphabet::arpabet;
  bool whole = true;
  const auto next = [&] {
    whole = whole && reader.next(line);
    return whole ? trimmed(line.text) : std::string_view();
  };
  const auto number = [&](std::string_view field) {
    const auto value = parse_number(field);
    whole = whole && value && std::isfinite(*value);
    return whole ? *value : 0.0;
  };
  next();
  next();  // the sound
  double rate = number(next());
  rate = options.rate > 0 ? options.rate : rate;
  next();
  for (double voices = number(next()); whole && voices >= 1; --voices) {
    const std::string speaker(next());
    next();
    for (double phrases = number(next()); whole && phrases >= 1; --phrases) {
      for (int i = 0; i < 3; ++i) next();
      for (double words = number(next()); whole && words >= 1; --words) {
        LabelRow row{0, next(), {}};
        const auto fields = split_fields(row.text, ' ');
        whole = whole && fields.size() >= 4;
        if (!whole) break;
        const std::string word(
            row.text.substr(0, std::size_t(fields.end()[-3].data() - row.text.data() - 1)));
        const double end = (number(fields.end()[-2]) + 1) / rate;
        double mouths = number(fields.end()[-1]);
        const std::size_t first = timings.labels.size();
        for (; whole && mouths >= 1; --mouths) {
          const auto mouth = split_fields(next(), ' ');
          if (mouth.size() < 2) {
            whole = false;
            break;
          }
          const auto column = mouth[1].data() - line.text.data() + 1;
          const auto label = phone_of(VisemeSet::preston_blair, mouth[1], line.number, column);
          if (!label) return label.error();
          const double start = number(mouth[0]) / rate;
          if (timings.labels.size() > first) timings.labels.back().end = start;
          timings.labels.push_back(
              {start, end, *label, word, line.number, column, false, Alphabet::automatic, speaker});
        }
      }
    }
  }
  if (!whole || !(rate > 0)) {
    return error_at_line(Code::truncated, "the Papagayo file ends early or misses a number",
                         line.number);
  }
  return timings;
}

}  // namespace animeme::dam
