// Lines with fields, as nearly all formats of labels have them.
#include <algorithm>
#include <cmath>

#include "dam/script/ipa.h"
#include "dam/script/marks.h"
#include "dam/script/phones.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

// Letters of a label without stress, length and tone, as far as that takes no tables.
std::size_t letters_of(std::string_view label) {
  std::size_t count = 0;
  while (!label.empty()) {
    const char32_t code = take_code_point(label);
    const bool digit = code >= U'0' && code <= U'9';
    const bool mark = (code >= 0x2B0 && code <= 0x36F) || code == U':' || code == U'_';
    if (!digit && !mark) ++count;
  }
  return count;
}

bool may_be_phone(std::string_view label) {
  if (is_silence_spelling(label) || !arpabet_label(label).empty()) return true;
  if (is_phone_of_a_set(label)) return true;
  if (label.size() > 16 || letters_of(label) > 2) return false;
  const auto sounds = parse_ipa(label);
  return sounds && is_one_sound(label, *sounds);
}

}  // namespace

void decide_unit(std::vector<TimedLabel>& labels, LabelUnit unit) {
  std::size_t words = 0, all = 0;
  for (const TimedLabel& label : labels) {
    if (is_silence_spelling(label.label) || is_mark(label.label)) continue;
    ++all;
    if (!may_be_phone(label.label)) ++words;
  }
  const bool are_words =
      unit == LabelUnit::words || (unit == LabelUnit::automatic && 2 * words > all);
  for (TimedLabel& label : labels) label.is_word = are_words && !is_silence_spelling(label.label);
}

std::string_view LabelRow::from(std::size_t field) const {
  return trimmed(text.substr(std::size_t(column(field) - 1)));
}

Error LabelRow::error(Code code, std::string message, std::size_t field) const {
  return error_at_line(code, std::move(message), line, field < fields.size() ? column(field) : 0);
}

Result<double> LabelRow::seconds(std::size_t field, std::string_view what, double rate) const {
  if (field >= fields.size()) {
    return error(Code::syntax, "the line lacks the " + std::string(what) + " time", field);
  }
  const auto value = parse_seconds(fields[field], line, what, column(field));
  if (!value) return value.error();
  return *value / rate;
}

bool LabelRow::is_number(std::size_t field) const {
  if (field >= fields.size()) return false;
  const auto value = parse_number(fields[field]);
  return value && std::isfinite(*value);
}

bool LabelRow::is_integer(std::size_t field) const {
  return is_number(field) &&
         fields[field].find_first_not_of("0123456789") == std::string_view::npos;
}

TimedLabel LabelRow::label_at(std::size_t field, double start, double end) const {
  return {start, end, std::string(fields[field]), {}, line, column(field), false};
}

bool LabelRows::next(LabelRow& row) {
  Line line;
  while (reader_.next(line)) {
    row.fields.clear();
    row.line = line.number;
    row.text = line.text;
    for (std::size_t at = 0;;) {
      at = line.text.find_first_not_of(" \t", at);
      if (at == std::string_view::npos) break;
      const std::size_t end = std::min(line.text.find_first_of(" \t", at), line.text.size());
      row.fields.push_back(line.text.substr(at, end - at));
      at = end;
    }
    if (row.fields.empty()) continue;
    if (!comment_.empty() && row.fields[0].starts_with(comment_)) continue;
    return true;
  }
  return false;
}

std::vector<LabelRow> first_rows(std::string_view text, std::size_t most,
                                 std::string_view comment) {
  std::vector<LabelRow> rows;
  LabelRows reader(text, comment);
  LabelRow row;
  while (rows.size() < most && reader.next(row)) rows.push_back(row);
  return rows;
}

Result<std::string> choose_recording(const std::vector<std::string>& names,
                                     const std::string& wanted) {
  if (wanted.empty() && names.size() == 1) return names[0];
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return wanted;
  std::string list;
  for (const std::string& name : names) {
    if (list.size() > 300) {
      list += ", ...";
      break;
    }
    list += (list.empty() ? "" : ", ") + in_quotes(name);
  }
  return make_error(Code::not_found,
                    wanted.empty() ? "the file holds several recordings; name the one to read "
                                     "(--tier): " +
                                         list
                                   : "there is no recording " + in_quotes(wanted) +
                                         "; these are in the file: " + list);
}

Error nothing_in(std::string_view format) {
  return make_error(Code::truncated, "the " + std::string(format) +
                                         " holds no labels; align or type at least one phone");
}

double longest_event(const TimedLabel& label) {
  // A calm speaker takes a tenth of a second a letter; a viseme or a phone about as long.
  return label.is_word ? 0.2 + 0.1 * double(letters_of(label.label)) : 0.15;
}

void end_at_next_start(std::vector<TimedLabel>& labels, double longest(const TimedLabel&)) {
  std::vector<TimedLabel> kept;
  kept.reserve(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    TimedLabel& label = labels[i];
    const bool last = i + 1 == labels.size();
    if (label.end <= label.start) {
      const double until = label.start + longest(label);
      // Phones and visemes follow each other without gaps; words have pauses between them.
      if (last) {
        if (is_silence_spelling(label.label)) continue;
        label.end = until;
      } else {
        label.end = label.is_word ? std::min(labels[i + 1].start, until) : labels[i + 1].start;
      }
    }
    if (!last && labels[i + 1].start == label.start) continue;
    kept.push_back(std::move(label));
  }
  labels = std::move(kept);
}

double usual_duration(std::string_view label) {
  const PhoneInfo* phone = find_phone(label);
  if (phone == nullptr || !phone->vowel) return 1.0;
  return phone->viseme_start != phone->viseme_end ? 1.8 : 1.4;
}

void spread_phones(const TimedLabel& word, std::span<const std::string> labels,
                   std::vector<TimedLabel>& out) {
  const std::size_t first = out.size();
  double total = 0, done = 0;
  for (const std::string& label : labels) total += usual_duration(label);
  double start = word.start;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    done += usual_duration(labels[i]);
    const bool last = i + 1 == labels.size();
    const double end = last ? word.end : word.start + (word.end - word.start) * (done / total);
    if (end > start) {
      out.push_back({start, end, labels[i], word.word.empty() ? word.label : word.word, word.line,
                     word.column, false, Alphabet::arpabet, word.speaker,
                     out.size() == first ? word.link : WordLink::automatic});
      start = end;
    }
  }
}

}  // namespace animeme::dam
