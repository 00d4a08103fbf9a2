#include "dam/script/turns.h"

#include <algorithm>
#include <limits>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"
#include "dam/script/words.h"

namespace animeme::dam {
namespace {

// Fields of a line: type, recording, channel, start, duration, text, kind, speaker.
constexpr std::size_t kStartField = 3, kLengthField = 4, kSpeakerField = 7, kLeastFields = 8;

// How far a moment is from a turn, seconds; 0: in it.
double seconds_from(const SpokenTurn& turn, double time) {
  return std::max({0.0, turn.start - time, time - turn.end});
}

}  // namespace

Result<std::vector<SpokenTurn>> read_rttm(std::string_view text) {
  const std::string utf8 = to_utf8(text);
  LabelRows reader(utf8, ";;");
  LabelRow row;
  std::vector<SpokenTurn> turns;
  std::string first;  // recording
  while (reader.next(row)) {
    if (row.fields.front() != "SPEAKER") continue;
    if (row.fields.size() < kLeastFields) {
      return row.error(Code::syntax,
                       "a SPEAKER line of RTTM holds recording, channel, start, duration, text, "
                       "kind and speaker",
                       row.fields.size());
    }
    const std::string_view name = row.fields[1];
    if (first.empty()) first = name;
    if (name != first) {
      return row.error(Code::unsupported,
                       "the file holds several recordings, " + in_quotes(first) + " and " +
                           in_quotes(name) + "; keep the lines of one",
                       1);
    }
    const auto start = row.seconds(kStartField, "start");
    if (!start) return start.error();
    const auto length = row.seconds(kLengthField, "duration");
    if (!length) return length.error();
    if (!(*start >= 0) || !(*length >= 0)) {
      return row.error(Code::syntax, "a turn begins at 0 or later and lasts some time",
                       kStartField);
    }
    if (!(*start + *length <= kMaxScriptSeconds)) {
      return row.error(Code::out_of_range, "a turn ends after one day", kLengthField);
    }
    if (*length > 0) {
      turns.push_back({*start, *start + *length, std::string(row.fields[kSpeakerField])});
    }
  }
  if (turns.empty()) {
    return make_error(Code::truncated,
                      "nobody speaks in it; lines of RTTM look so: SPEAKER talk 1 0.50 2.25 <NA> "
                      "<NA> Ann <NA> <NA>");
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [](const SpokenTurn& a, const SpokenTurn& b) { return a.start < b.start; });
  return turns;
}

std::vector<std::string> speakers_of(std::span<const SpokenTurn> turns) {
  std::vector<std::string> names;
  for (const SpokenTurn& turn : turns) {
    if (std::find(names.begin(), names.end(), turn.speaker) == names.end()) {
      names.push_back(turn.speaker);
    }
  }
  return names;
}

bool speaks_at(std::span<const SpokenTurn> turns, double seconds, std::string_view speaker) {
  double own = std::numeric_limits<double>::infinity(), other = own;
  for (const SpokenTurn& turn : turns) {
    double& nearest = turn.speaker == speaker ? own : other;
    nearest = std::min(nearest, seconds_from(turn, seconds));
  }
  if (own == other) {  // in both, or as far: then who speaks first
    return own == 0 || (!turns.empty() && turns.front().speaker == speaker);
  }
  return own < other;
}

Script said_by(const Script& script, std::span<const SpokenTurn> turns, std::string_view speaker) {
  std::vector<bool> own(script.phones.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Phone& phone = script.phones[i];
    own[i] = speaks_at(turns, (phone.start + phone.end) / 2, speaker);
  }
  for (const ScriptWord& word : words_of(script)) {
    const bool theirs = speaks_at(turns, (word.start + word.end) / 2, speaker);
    for (std::size_t i = word.first; i < word.last; ++i) own[i] = theirs;
  }
  Script said;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Phone& phone = script.phones[i];
    const bool silent = !own[i] || phone.label == kSilence;
    if (!silent) {
      said.phones.push_back(phone);
    } else if (!said.phones.empty() && said.phones.back().label == kSilence) {
      said.phones.back().end = phone.end;
    } else {
      said.phones.push_back({phone.start, phone.end, std::string(kSilence), {}});
    }
  }
  return said;
}

Script said_together(std::span<const Script> people) {
  std::vector<Phone> phones;
  double end = 0;
  for (const Script& script : people) {
    end = std::max(end, script.duration());
    for (const Phone& phone : script.phones)
      if (phone.label != kSilence) phones.push_back(phone);
  }
  std::stable_sort(phones.begin(), phones.end(),
                   [](const Phone& a, const Phone& b) { return a.start < b.start; });
  Script all;
  const auto pause = [&all](double until) {
    if (until > all.duration() + kTimeTolerance)
      all.phones.push_back({all.duration(), until, std::string(kSilence), {}});
  };
  for (std::size_t i = 0; i < phones.size(); ++i) {
    Phone& phone = phones[i];
    if (i + 1 < phones.size()) phone.end = std::min(phone.end, phones[i + 1].start);
    if (!(phone.end > phone.start)) continue;
    pause(phone.start);
    all.phones.push_back(std::move(phone));
  }
  pause(end);
  return all;
}

}  // namespace animeme::dam
