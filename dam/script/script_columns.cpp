// Tables of recognisers and TTS engines: MBROLA, CTM, PocketSphinx.
#include <algorithm>
#include <set>

#include "dam/script/script_readers_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

constexpr double kSphinxRate = 100;  // frames
constexpr double kLeastPhone = 3;    // ms, on average

bool all_numbers(const LabelRow& row, std::size_t from) {
  for (std::size_t i = from; i < row.fields.size(); ++i) {
    if (!row.is_number(i)) return false;
  }
  return row.fields.size() > from;
}

}  // namespace

bool looks_like_pho(std::string_view text) {
  const auto rows = first_rows(text, 20, ";");
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return row.fields[0] == "#" || (all_numbers(row, 1) && !row.is_number(0)) ||
           (row.fields.size() == 2 && row.is_number(1));
  }) && std::any_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return !row.is_number(0) && row.fields.size() > 1;
  });
}

Result<Timings> read_pho(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text, ";");
  LabelRow row;
  double reached = 0;  // milliseconds, so that their sum is exact where they are whole numbers
  while (reader.next(row)) {
    if (row.fields[0] == "#" && row.fields.size() == 1) continue;  // "speak now"
    const auto length = row.seconds(1, "duration");
    if (!length) return length.error();
    const double end = reached + *length;
    const double rate = rate_or(options, 1000);
    TimedLabel label = row.label_at(0, reached / rate, end / rate);
    reached = end;
    if (*length == 0) continue;  // a diphone that is only passed through
    timings.labels.push_back(std::move(label));
  }
  // Others have .pho files, too, which count seconds. Who names the format knows.
  const bool told = !options.format.empty() || options.rate > 0;
  if (!told && reached < kLeastPhone * double(timings.labels.size())) {
    return make_error(Code::syntax,
                      "these phones last less than 3 ms each; MBROLA uses milliseconds; for "
                      "durations in seconds use --script-format pho@1");
  }
  return timings;
}

bool looks_like_ctm(std::string_view text) {
  const auto rows = first_rows(text, 20, ";;");
  const bool shaped = std::all_of(rows.begin(), rows.end(), [](const LabelRow& row) {
    return row.fields.size() >= 5 && row.fields.size() <= 8 && row.is_number(2) && row.is_number(3);
  });
  // A word may be a number; not all of them. MBROLA's pitches are.
  return shaped && std::any_of(rows.begin(), rows.end(),
                               [](const LabelRow& row) { return !row.is_number(4); });
}

Result<Timings> read_ctm(std::string_view text, const ScriptOptions& options) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  std::vector<std::pair<std::string, TimedLabel>> all;  // the channel as the speaker
  LabelRows reader(text, ";;");
  LabelRow row;
  while (reader.next(row)) {
    if (row.fields.size() < 5) {
      return row.error(Code::syntax,
                       "a line of a CTM holds recording, channel, start, duration and label", 5);
    }
    const auto start = row.seconds(2, "start");
    if (!start) return start.error();
    const auto length = row.seconds(3, "duration");
    if (!length) return length.error();
    std::string name(row.fields[0]);
    if (seen.insert(name).second) names.push_back(name);
    all.emplace_back(std::move(name), row.label_at(4, *start, *start + *length));
    all.back().second.speaker = row.fields[1];
  }
  if (names.empty()) return nothing_in("CTM");
  const auto name = choose_recording(names, options.tier);
  if (!name) return name.error();
  Timings timings;
  for (auto& [of, label] : all) {
    if (of == *name) timings.labels.push_back(std::move(label));
  }
  // A channel of its own for each person of a call; one channel tells nothing.
  const auto other = [&](const TimedLabel& label) {
    return label.speaker != timings.labels.front().speaker;
  };
  if (std::none_of(timings.labels.begin(), timings.labels.end(), other)) {
    for (TimedLabel& label : timings.labels) label.speaker.clear();
  }
  decide_unit(timings.labels, options.unit);
  return timings;
}

bool looks_like_phseg(std::string_view text) {
  const auto rows = first_rows(text, 1);
  return !rows.empty() && rows[0].fields[0] == "SFrm";
}

Result<Timings> read_phseg(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text);
  LabelRow row;
  const double rate = rate_or(options, kSphinxRate);
  bool words = false;
  while (reader.next(row)) {
    if (row.fields[0] == "SFrm") {
      words = row.fields.back() == "Word";
      continue;
    }
    if (row.fields[0] == "Total") break;  // "Total score"
    const auto start = row.seconds(0, "start", rate);
    if (!start) return start.error();
    const auto last = row.seconds(1, "end");
    if (!last) return last.error();
    if (row.fields.size() < 4) {
      return row.error(Code::syntax, "a line holds first frame, last frame, score and phone", 4);
    }
    TimedLabel label = row.label_at(3, *start, (*last + 1) / rate);  // the last frame belongs to it
    label.is_word = words && !label.label.empty();
    timings.labels.push_back(std::move(label));
  }
  if (options.unit != LabelUnit::automatic) decide_unit(timings.labels, options.unit);
  return timings;
}

// "pau:0.224 m:0.260": where a label ends and its number begins; npos: no such field.
static std::size_t colon_in(std::string_view field) {
  const std::size_t colon = field.rfind(':');
  if (colon == 0 || colon == std::string_view::npos) return std::string_view::npos;
  return parse_number(field.substr(colon + 1)) ? colon : std::string_view::npos;
}

bool looks_like_flite(std::string_view text) {
  const auto rows = first_rows(text, 1);
  return !rows.empty() &&
         std::all_of(rows[0].fields.begin(), rows[0].fields.end(), [](std::string_view field) {
           return colon_in(field) != std::string_view::npos;
         });
}

Result<Timings> read_flite(std::string_view text, const ScriptOptions& options) {
  Timings timings;
  LabelRows reader(text);
  LabelRow row;
  const double rate = rate_or(options, 1);
  double start = 0;
  while (reader.next(row)) {
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      const std::size_t colon = colon_in(row.fields[i]);
      if (colon == std::string_view::npos) {
        return row.error(Code::syntax, "flite writes phone:end, as m:0.26", i);
      }
      const double end = *parse_number(row.fields[i].substr(colon + 1)) / rate;
      TimedLabel label = row.label_at(i, start, end);
      label.label = std::string(row.fields[i].substr(0, colon));
      timings.labels.push_back(std::move(label));
      start = end;
    }
  }
  return timings;
}

}  // namespace animeme::dam
