// Label files: a line per label, its times in front. HTK, TIMIT, Audacity and others differ in the
// unit of their times; Festival has the end alone.
#include <algorithm>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"

namespace animeme::dam {
namespace {

constexpr double kHtkRate = 1e7;      // units of 100 ns
constexpr double kTimitRate = 16000;  // samples
constexpr std::size_t kLooked = 20;   // lines that identify a format

// Audacity writes the tab in front of a label that is empty.
bool has_times(const LabelRow& row) {
  const bool label = row.fields.size() >= 3 ||
                     (row.fields.size() == 2 && row.text.find('\t') != std::string_view::npos);
  return label && row.is_number(0) && row.is_number(1);
}

// Those of the first lines that have a start, an end and a label, if the very first and most have.
std::vector<LabelRow> three_columns(std::string_view text) {
  std::vector<LabelRow> rows = first_rows(text, kLooked, "#");
  // Audacity: the frequencies of the label above.
  std::erase_if(rows, [](const LabelRow& row) { return row.fields[0] == "\\"; });
  if (rows.empty() || !has_times(rows[0])) return {};
  const std::size_t all = rows.size();
  std::erase_if(rows, [](const LabelRow& row) { return !has_times(row); });
  if (2 * rows.size() < all) return {};
  return rows;
}

// The middle one of the durations of rows whose times are all whole numbers; 0: they are not.
double whole_duration(const std::vector<LabelRow>& rows) {
  std::vector<double> durations;
  for (const LabelRow& row : rows) {
    if (!row.is_integer(0) || !row.is_integer(1)) return 0;
    durations.push_back(*row.seconds(1, "end") - *row.seconds(0, "start"));
  }
  if (durations.empty()) return 0;
  std::sort(durations.begin(), durations.end());
  return durations[durations.size() / 2];
}

// A phone lasts 5 ms to 1 s: as samples at 8 to 48 kHz or in units of 100 ns that is 40 to 48,000
// or 50,000 to 10,000,000. Less are seconds without decimals.
constexpr double kLeastSamples = 20, kLeastHtk = 49000;
// So few samples are 20 ms of a phone or 0.1 s of a word: they are milliseconds.
constexpr double kMostMilliseconds = 320, kMostMillisecondsOfWords = 1500;

bool counts_milliseconds(const std::vector<LabelRow>& rows, double duration) {
  if (duration >= kMostMillisecondsOfWords) return false;
  std::vector<TimedLabel> labels;
  for (const LabelRow& row : rows) {
    if (row.fields.size() > 2) labels.push_back(row.label_at(2, 0, 1));
  }
  decide_unit(labels, LabelUnit::automatic);
  const bool words = std::any_of(labels.begin(), labels.end(),
                                 [](const TimedLabel& label) { return label.is_word; });
  return words || duration < kMostMilliseconds;
}

// The middle of a triphone or a full context: "a-b+c", "x^a-b+c=d@...".
std::string_view middle_phone(std::string_view label) {
  const std::size_t plus = label.find('+');
  if (plus == std::string_view::npos || plus == 0) return label;
  const std::size_t minus = label.rfind('-', plus);
  const std::size_t begin = minus == std::string_view::npos ? 0 : minus + 1;
  return begin < plus ? label.substr(begin, plus - begin) : label;
}

// HVite names the word in a fifth column, at its first phone.
void add_htk_word(TimedLabel& label, const LabelRow& row, std::string& word) {
  if (row.fields.size() >= 5) word = row.fields[4];
  label.word = word;
}

Result<TimedLabel> read_htk_row(const LabelRow& row, double rate, std::string& word) {
  const auto start = row.seconds(0, "start", rate);
  if (!start) {
    return row.error(Code::syntax,
                     "no start time in front of " + in_quotes(row.fields[0]) +
                         "; a label file without times is a transcript: align it with its sound",
                     0);
  }
  const bool has_end = row.is_number(1);
  const auto end = has_end ? row.seconds(1, "end", rate) : *start;
  if (!end) return end.error();
  const std::size_t at = has_end ? 2 : 1;
  if (at >= row.fields.size()) return row.error(Code::syntax, "the line lacks its label", at);
  TimedLabel label = row.label_at(at, *start, *end);
  label.label = middle_phone(label.label);
  if (has_end) add_htk_word(label, row, word);
  return label;
}

// Sections of a master label file by their names.
struct Recording {
  std::string name;
  std::vector<LabelRow> rows;
};

// The first of several alternatives ("///") counts.
std::vector<Recording> recordings_of(std::string_view text) {
  std::vector<Recording> recordings;
  const bool master = text.starts_with("#!MLF!#");
  if (!master) recordings.push_back({});
  LabelRows reader(text, "#");
  LabelRow row;
  bool alternative = false;
  while (reader.next(row)) {
    const std::string_view first = row.fields[0];
    if (master && first.starts_with('"')) {
      std::string_view name = row.from(0).substr(1);
      if (name.ends_with('"')) name.remove_suffix(1);
      recordings.push_back({std::string(name), {}});
      alternative = false;
    } else if (first.starts_with("///")) {
      alternative = true;
    } else if (!recordings.empty() && !alternative && !(master && first == ".")) {
      recordings.back().rows.push_back(row);
    }
  }
  return recordings;
}

}  // namespace

bool looks_like_htk(std::string_view text) {
  return text.starts_with("#!MLF!#") || whole_duration(three_columns(text)) >= kLeastHtk;
}

Result<Timings> read_htk(std::string_view text, const ScriptOptions& options) {
  const std::vector<Recording> recordings = recordings_of(text);
  std::vector<std::string> names;
  for (const Recording& recording : recordings) names.push_back(recording.name);
  if (names.empty()) return nothing_in("HTK label file");
  if (!text.starts_with("#!MLF!#") && !options.tier.empty()) {
    return make_error(Code::not_found,
                      "a label file has one tier without a name; leave out --tier");
  }
  const auto name = choose_recording(names, options.tier);
  if (!name) return name.error();
  const auto chosen = std::find_if(recordings.begin(), recordings.end(),
                                   [&](const Recording& r) { return r.name == *name; });
  Timings timings;
  std::string word;
  for (const LabelRow& row : chosen->rows) {
    auto label = read_htk_row(row, rate_or(options, kHtkRate), word);
    if (!label) return label.error();
    timings.labels.push_back(*std::move(label));
  }
  decide_unit(timings.labels, options.unit);
  end_at_next_start(timings.labels, longest_event);
  return timings;
}

bool looks_like_timit(std::string_view text) {
  const auto rows = three_columns(text);
  const double duration = whole_duration(rows);
  return duration >= kLeastSamples && duration < kLeastHtk && !counts_milliseconds(rows, duration);
}

Result<Timings> read_timit(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text, "#");
  LabelRow row;
  const double rate = rate_or(options, kTimitRate);
  while (reader.next(row)) {
    const auto start = row.seconds(0, "start", rate);
    if (!start) return start.error();
    const auto end = row.seconds(1, "end", rate);
    if (!end) return end.error();
    if (row.fields.size() < 3) return row.error(Code::syntax, "the line lacks its label", 2);
    timings.labels.push_back(row.label_at(2, *start, *end));
  }
  decide_unit(timings.labels, options.unit);
  return timings;
}

bool looks_like_plain_labels(std::string_view text) { return !three_columns(text).empty(); }

Result<Timings> read_plain_labels(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text, "#");
  LabelRow row;
  while (reader.next(row)) {
    if (row.fields[0] == "\\") continue;
    const auto start = row.seconds(0, "start");
    if (!start) return start.error();
    const auto end = row.seconds(1, "end");
    if (!end) return end.error();
    const bool empty = row.fields.size() < 3;  // a label of Audacity without text
    TimedLabel label = row.label_at(empty ? 1 : 2, *start, *end);
    label.label = empty ? std::string_view() : row.from(2);
    timings.labels.push_back(std::move(label));
  }
  decide_unit(timings.labels, options.unit);
  return timings;
}

// Where the header of an ESPS label file ends: a line with nothing but #.
bool looks_like_esps(std::string_view text) {
  LabelRows reader(text);
  LabelRow row;
  for (std::size_t i = 0; i < 50 && reader.next(row); ++i) {
    if (row.fields.size() != 1 || row.fields[0] != "#") continue;
    return reader.next(row) && row.fields.size() >= 3 && row.is_number(0) && row.is_integer(1);
  }
  return false;
}

Result<Timings> read_esps(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text);
  LabelRow row;
  bool header = true;
  double reached = 0;
  while (reader.next(row)) {
    if (header) {
      header = row.fields.size() != 1 || row.fields[0] != "#";
      continue;
    }
    const auto end = row.seconds(0, "end", rate_or(options, 1));
    if (!end) return end.error();
    if (row.fields.size() < 3) {
      return row.error(Code::syntax, "a line holds the end of a label, a colour and the label", 2);
    }
    TimedLabel label = row.label_at(2, reached, *end);
    // Further fields of the label follow a semicolon.
    label.label = label.label.substr(0, label.label.find(';'));
    timings.labels.push_back(std::move(label));
    reached = *end;
  }
  if (header) {
    return make_error(Code::syntax,
                      "the header of an ESPS label file ends with a line that holds # alone; this "
                      "file has none");
  }
  decide_unit(timings.labels, options.unit);
  return timings;
}

}  // namespace animeme::dam
