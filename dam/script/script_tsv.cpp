// The corpus format: tab separated, columns named by a header line.
#include <algorithm>
#include <optional>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kMaxColumns = 64;
constexpr std::size_t kAbsent = kMaxColumns;

struct TsvColumns {
  std::size_t start = kAbsent, end = kAbsent, duration = kAbsent, phone = kAbsent, word = kAbsent;
  std::size_t link = kAbsent;
};

// Values of the column word_link, which is written only where a script needs it.
constexpr std::string_view kAgain = "again", kContinued = "continued";

std::vector<std::string_view> split_tabs(std::string_view line) {
  std::vector<std::string_view> fields;
  while (fields.size() < kMaxColumns) {
    const std::size_t tab = line.find('\t');
    fields.push_back(trimmed(line.substr(0, tab)));
    if (tab == std::string_view::npos) break;
    line.remove_prefix(tab + 1);
  }
  return fields;
}

TsvColumns name_columns(std::string_view header) {
  TsvColumns columns;
  const auto fields = split_tabs(header);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name = lower_case(fields[i]);
    if (name == "start_s" || name == "start") columns.start = i;
    if (name == "end_s" || name == "end") columns.end = i;
    if (name == "duration_s" || name == "duration") columns.duration = i;
    if (name == "phone" || name == "phoneme" || name == "label") columns.phone = i;
    if (name == "word" || name == "text") columns.word = i;
    if (name == "word_link") columns.link = i;
  }
  return columns;
}

bool next_content_line(LineReader& reader, Line& line) {
  while (reader.next(line)) {
    if (!trimmed(line.text).empty() && line.text[0] != '#') return true;
  }
  return false;
}

// A field that the line is too short to have is empty.
std::string_view field_at(const std::vector<std::string_view>& fields, std::size_t column) {
  return column < fields.size() ? fields[column] : std::string_view();
}

Result<TimedLabel> read_row(const Line& line, const TsvColumns& columns) {
  const auto fields = split_tabs(line.text);
  TimedLabel phone;
  phone.line = line.number;
  const auto column = [&](std::string_view field) {
    return field.empty() ? 0 : field.data() - line.text.data() + 1;
  };
  const std::string_view first = field_at(fields, columns.start);
  const auto start = parse_seconds(first, line.number, "start", column(first));
  if (!start) return start.error();
  phone.start = *start;
  const bool has_end = columns.end != kAbsent;
  const std::string_view other = field_at(fields, has_end ? columns.end : columns.duration);
  const auto second =
      parse_seconds(other, line.number, has_end ? "end" : "duration", column(other));
  if (!second) return second.error();
  phone.end = has_end ? *second : *start + *second;
  // An empty label is silence; one that is not there at all is a damaged line.
  const bool words = columns.phone == kAbsent;
  const std::size_t at = words ? columns.word : columns.phone;
  if (at >= fields.size()) {
    return error_at_line(Code::syntax,
                         "the line has " + std::to_string(fields.size()) +
                             " fields and lacks the " + (words ? "word" : "phone") +
                             "; fields are separated by tabs",
                         line.number);
  }
  phone.label = fields[at];
  phone.column = column(fields[at]);
  phone.is_word = words && !phone.label.empty();
  if (!words) phone.word = field_at(fields, columns.word);
  const std::string_view link = field_at(fields, columns.link);
  if (link == kAgain) phone.link = WordLink::again;
  if (link == kContinued) phone.link = WordLink::continued;
  return phone;
}

std::optional<Error> check_columns(const TsvColumns& columns, std::int64_t line) {
  if (columns.start != kAbsent && (columns.phone != kAbsent || columns.word != kAbsent) &&
      (columns.end != kAbsent || columns.duration != kAbsent)) {
    return std::nullopt;
  }
  return error_at_line(Code::syntax,
                       "the header line must name the columns start_s, end_s (or duration_s) and "
                       "phone (or word), separated by tabs",
                       line);
}

}  // namespace

bool looks_like_tsv(std::string_view text) {
  LineReader reader(text);
  Line line;
  if (!next_content_line(reader, line)) return false;
  const TsvColumns columns = name_columns(line.text);
  return columns.start != kAbsent || columns.phone != kAbsent;
}

Result<Timings> read_tsv(std::string_view text, const ScriptOptions& options) {
  LineReader reader(text);
  Line line;
  if (!next_content_line(reader, line)) return nothing_in("table");
  const TsvColumns columns = name_columns(line.text);
  if (const auto error = check_columns(columns, line.number)) return *error;
  Timings timings;
  while (next_content_line(reader, line)) {
    auto phone = read_row(line, columns);
    if (!phone) return phone.error();
    timings.labels.push_back(*std::move(phone));
  }
  if (options.unit != LabelUnit::automatic) decide_unit(timings.labels, options.unit);
  return timings;
}

std::string write_script_tsv(const Script& script) {
  const bool links = std::any_of(script.phones.begin(), script.phones.end(),
                                 [](const Phone& p) { return p.link != WordLink::automatic; });
  std::string out =
      links ? "start_s\tend_s\tphone\tword\tword_link\n" : "start_s\tend_s\tphone\tword\n";
  for (const Phone& phone : script.phones) {
    out += format_seconds(phone.start) + '\t' + format_seconds(phone.end) + '\t' + phone.label;
    out += '\t';
    for (const char c : phone.word) out += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
    if (links) out += '\t';
    if (phone.link == WordLink::again) out += kAgain;
    if (phone.link == WordLink::continued) out += kContinued;
    out += '\n';
  }
  return out;
}

}  // namespace animeme::dam
