#include "dam/script/script_finish_internal.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "dam/script/marks.h"
#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"

namespace animeme::dam {
namespace {

using NoteKind = ScriptNote::Kind;
using TimedLabels = std::vector<TimedLabel>;

constexpr std::size_t kLongestRun = 8;  // words of one mark, "[upbeat", "music", "plays]"
constexpr double kLongestWord = 20;     // seconds; a phone or a word that lasts longer is none
constexpr double kMillisecond = 0.001;

void make_silent(TimedLabel& label) {
  label.label.clear();
  label.word.clear();
  label.is_word = false;
}

bool is_spoken_word(std::string_view word) {
  return std::any_of(word.begin(), word.end(), is_letter_or_digit);
}

// A mark of several words that is a label a word: where its last one is; 0: none begins here.
std::size_t end_of_run(const TimedLabels& labels, std::size_t first) {
  const std::string& begin = labels[first].label;
  const std::size_t open = begin.find_first_of("[({<");
  if (!labels[first].is_word || open == std::string::npos) return 0;
  std::string text = begin.substr(open);
  if (without_marks(text, MarksOf::captions).count > 0) return 0;  // the label has all of it
  const std::size_t last = std::min(labels.size(), first + kLongestRun);
  for (std::size_t i = first + 1; i < last && labels[i].is_word; ++i) {
    text += " " + labels[i].label;
    const auto from = text[0] == '(' ? MarksOf::prose : MarksOf::captions;
    const Unmarked unmarked = without_marks(text, from);
    if (unmarked.count > 0) return unmarked.text.find_first_of("])}>") == std::string::npos ? i : 0;
  }
  return 0;
}

// "EXCUSE(2)" is the second way to say it.
void drop_variant(std::string& word) {
  const std::size_t bracket = word.rfind('(');
  if (bracket == std::string::npos || bracket == 0 || !word.ends_with(')')) return;
  const std::string_view number = std::string_view(word).substr(bracket + 1);
  if (number.find_first_not_of("0123456789") == number.size() - 1) word.resize(bracket);
}

void read_marks(Timings& timings, bool speak) {
  TimedLabels& labels = timings.labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    TimedLabel& label = labels[i];
    if (!label.is_word) {
      drop_variant(label.word);
      if (is_silence_spelling(label.label) || !is_mark_among_phones(label.label)) continue;
      note_mark(timings.notes, label.label, label.line);
      make_silent(label);
      continue;
    }
    drop_variant(label.label);
    if (is_silence_spelling(label.label) && !is_spoken_word(label.label.substr(0, 1))) {
      make_silent(label);  // "<sil>", "#"
      continue;
    }
    if (speak) continue;
    if (const std::size_t end = end_of_run(labels, i); end > 0) {
      note_mark(timings.notes, label.label + " " + labels[end].label, label.line);
      for (; i < end; ++i) make_silent(labels[i]);
      make_silent(labels[i]);
    } else if (is_mark(label.label)) {
      note_mark(timings.notes, label.label, label.line);
      make_silent(label);
    } else if (auto unmarked = without_marks(label.label, MarksOf::captions); unmarked.count > 0) {
      for (std::size_t k = 0; k < unmarked.count; ++k) {
        note_mark(timings.notes, unmarked.mark, label.line);
      }
      label.label = trimmed(unmarked.text);
      if (!is_spoken_word(label.label)) make_silent(label);
    }
  }
}

Result<void> keep_speaker(TimedLabels& labels, const std::string& wanted) {
  if (wanted.empty()) return {};
  std::set<std::string> names;
  for (const TimedLabel& label : labels) {
    if (!label.speaker.empty()) names.insert(label.speaker);
  }
  const auto is_wanted = [&](const std::string& name) {
    return lower_case(name) == lower_case(wanted);
  };
  if (std::none_of(names.begin(), names.end(), is_wanted)) {
    std::string list;
    for (const std::string& name : names) {
      if (list.size() < 300) list += (list.empty() ? "" : ", ") + in_quotes(name);
    }
    return make_error(Code::not_found,
                      names.empty() ? "the script does not say who speaks; leave out --speaker"
                                    : "nobody called " + in_quotes(wanted) +
                                          " speaks in the script; its speakers are " + list);
  }
  std::erase_if(labels, [&](const TimedLabel& label) { return !is_wanted(label.speaker); });
  return {};
}

void drop_timeless(Timings& timings) {
  std::erase_if(timings.labels, [&](const TimedLabel& label) {
    if (label.end != label.start) return false;
    if (!is_silence_spelling(label.label)) {
      add_note(timings.notes, NoteKind::no_time,
               in_quotes(label.label) + " takes no time and is left out", label.line);
    }
    return true;
  });
}

// One face says one word at a time.
void part_words(Timings& timings) {
  TimedLabels& labels = timings.labels;
  const bool finite = std::all_of(labels.begin(), labels.end(), [](const TimedLabel& label) {
    return std::isfinite(label.start) && std::isfinite(label.end);
  });
  if (!finite || !has_words(timings)) return;  // what is not finite is refused later
  std::stable_sort(labels.begin(), labels.end(),
                   [](const TimedLabel& a, const TimedLabel& b) { return a.start < b.start; });
  TimedLabels kept;
  kept.reserve(labels.size());
  for (TimedLabel& label : labels) {
    const bool silent = is_silence_spelling(label.label);
    if (!kept.empty() && label.start < kept.back().end - kTimeTolerance) {
      TimedLabel& before = kept.back();
      if (silent) {  // a pause does not interrupt anybody
        if (label.end <= before.end) continue;
        label.start = before.end;
      } else {
        if (!is_silence_spelling(before.label)) {
          add_note(timings.notes, NoteKind::overlaps,
                   in_quotes(before.label) + " is cut where " + in_quotes(label.label) +
                       " begins, since one face says one at a time" +
                       (label.speaker != before.speaker ? " (--speaker chooses one)" : ""),
                   before.line);
        }
        before.end = label.start;
        if (before.end - before.start <= kTimeTolerance) kept.pop_back();
      }
    }
    kept.push_back(std::move(label));
  }
  labels = std::move(kept);
}

// Words whose end is a slip of the pen, as subtitles have them, last as long as they take to say.
void mend_ends(Timings& timings) {
  constexpr double kSecondsOfByte = 0.07;
  std::vector<double> starts;
  for (TimedLabel& label : timings.labels) {
    if (!label.is_word || !(label.end < label.start) || !std::isfinite(label.start)) continue;
    if (starts.empty()) {
      for (const TimedLabel& each : timings.labels) {
        if (std::isfinite(each.start)) starts.push_back(each.start);
      }
      std::sort(starts.begin(), starts.end());
    }
    label.end = label.start + kSecondsOfByte * double(label.label.size());
    const auto next = std::upper_bound(starts.begin(), starts.end(), label.start);
    if (next != starts.end()) label.end = std::min(label.end, *next);
    add_note(timings.notes, NoteKind::given_times,
             in_quotes(label.label) + " ends before it begins; it gets the time that it takes to " +
                 "say, until the next begins",
             label.line);
  }
}

bool is_whole(double value) { return value == std::floor(value); }

// Nobody says a word for twenty seconds: numbers like that count milliseconds.
void check_unit(Timings& timings, TimeUnit unit) {
  constexpr std::size_t kFewPhones = 3;
  std::vector<double> lengths;
  bool whole = true, words = false;
  for (const TimedLabel& label : timings.labels) {
    whole = whole && is_whole(label.start) && is_whole(label.end);
    if (is_silence_spelling(label.label)) continue;
    words = words || label.is_word;
    const auto more = std::count(label.label.begin(), label.label.end(), ' ');
    lengths.push_back((label.end - label.start) / double(label.is_word ? more + 1 : 1));
  }
  if (lengths.empty() || (!words && lengths.size() < kFewPhones)) return;
  std::nth_element(lengths.begin(), lengths.begin() + std::ptrdiff_t(lengths.size() / 2),
                   lengths.end());
  const double usual = lengths[lengths.size() / 2];
  if (!(usual >= kLongestWord)) return;
  const std::string what = words ? "word" : "phone";
  const std::string format(timings.format);
  if (whole && unit == TimeUnit::assumed) {
    for (TimedLabel& label : timings.labels) {
      label.start *= kMillisecond;
      label.end *= kMillisecond;
    }
    add_note(timings.notes, NoteKind::milliseconds,
             "its times are taken for milliseconds, since a " + what + " would last " +
                 format_seconds(usual) + " s else (--script-format " + format + "@1: seconds)",
             0);
  } else {
    add_note(timings.notes, NoteKind::long_labels,
             "a " + what + " lasts " + format_seconds(usual) +
                 " s; are its times in another unit? " + "--script-format " + format +
                 "@1000 reads milliseconds",
             0);
  }
}

}  // namespace

std::string ScriptNote::describe() const {
  std::string text = line > 0 ? "line " + std::to_string(line) + ": " + message : message;
  if (count > 1) text += " (" + std::to_string(count) + " in all)";
  return text;
}

void add_note(std::vector<ScriptNote>& notes, ScriptNote::Kind kind, std::string_view message,
              std::int64_t line) {
  for (ScriptNote& note : notes) {
    if (note.kind != kind) continue;
    ++note.count;
    return;
  }
  notes.push_back({kind, std::string(message), 1, line});
}

void note_mark(std::vector<ScriptNote>& notes, std::string_view mark, std::int64_t line) {
  add_note(notes, NoteKind::marks,
           "the mark " + in_quotes(mark) + " is silence (--speak-marks says such marks as words)",
           line);
}

void note_odd_bytes(std::vector<ScriptNote>& notes, const OddBytes& odd) {
  if (odd.count > 0) notes.push_back({NoteKind::odd_bytes, odd.describe(), 1, odd.line});
}

Result<void> check_size(std::size_t bytes, std::int64_t line) {
  if (bytes <= kMostOfLabel) return {};
  return error_at_line(Code::out_of_range,
                       "one cue with more than " + std::to_string(kMostOfLabel) +
                           " bytes of text, which nobody says in its time; split it into phrases",
                       line);
}

Result<void> finish_labels(Timings& timings, const ScriptOptions& options, TimeUnit unit) {
  for (const TimedLabel& label : timings.labels) {
    const std::size_t size = std::max(label.label.size(), label.word.size());
    if (auto fits = check_size(size, label.line); !fits) return fits;
  }
  if (auto kept = keep_speaker(timings.labels, options.speaker); !kept) return kept.error();
  if (options.rate > 0 && unit == TimeUnit::assumed) {
    for (TimedLabel& label : timings.labels) {
      label.start /= options.rate;
      label.end /= options.rate;
    }
  }
  read_marks(timings, options.speak_marks);
  drop_timeless(timings);
  if (!options.everyone) part_words(timings);
  if (options.rate == 0) check_unit(timings, unit);
  mend_ends(timings);
  return {};
}

}  // namespace animeme::dam
