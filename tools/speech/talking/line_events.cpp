#include "tools/speech/talking/line_events.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "dam/script/words.h"
#include "tools/formats/common/json.h"

namespace animeme::speech {

namespace {

using What = LineEvent::What;

constexpr const char* kNames[] = {"queued",    "started", "word",    "phone",  "mark",   "done",
                                  "cancelled", "stopped", "dropped", "paused", "resumed"};

// Added to times that are held: later than any time, and subtracted again without a loss that
// shows.
constexpr double kWaits = 1 << 30;

double rounded(double seconds) { return std::round(seconds * 1e6) / 1e6; }

}  // namespace

std::string to_json(const LineEvent& event) {
  tools::Json json = {{"event", kNames[std::size_t(event.what)]}, {"time", rounded(event.time)}};
  if (event.line > 0) {
    json["line"] = event.line;
    json["id"] = event.id;
  }
  switch (event.what) {
    case What::queued:
    case What::started:
      json["text"] = event.text;
      break;
    case What::word:
    case What::phone:
    case What::mark:
      json[kNames[std::size_t(event.what)]] = event.text;
      if (event.what != What::mark) json["duration"] = rounded(event.duration);
      break;
    case What::cancelled:
      if (event.line == 0) {
        json["mark"] = event.id;
      } else {
        json["said"] = event.text;
      }
      json["why"] = event.why;
      break;
    default:
      break;
  }
  return json.dump();
}

void LineEvents::add(LineEvent event) {
  const auto later = [](double time, const LineEvent& other) { return time < other.time; };
  const auto place = std::upper_bound(waiting_.begin(), waiting_.end(), event.time, later);
  waiting_.insert(place, std::move(event));
}

void LineEvents::begin(const SpokenLine& line, double start, double end) {
  const std::uint64_t number = line.whole > 0 ? line.whole : line.line;
  Begun begun{.line = number,
              .id = line.id,
              .start = start,
              .end = end,
              .words = {},
              .part = line.whole > 0};
  const auto event = [&](What what, double time, const std::string& text, double seconds) {
    LineEvent one{.what = what, .time = time, .line = number, .id = line.id, .text = text};
    one.duration = seconds;
    add(std::move(one));
  };
  if (line.first_part) event(What::started, start, line.text, 0);
  const dam::Script& script = line.speech.script;
  const bool own_words = line.words.has_value();
  const std::vector<dam::ScriptWord> words =
      own_words ? std::vector<dam::ScriptWord>{} : dam::words_of(script);
  if (own_words) {
    for (const dam::ScriptWord& one : *line.words) {
      event(What::word, start + one.start, one.text, one.end - one.start);
      begun.words.emplace_back(start + one.start, one.text);
    }
  }
  auto word = words.begin();
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const dam::Phone& phone = script.phones[i];
    const double time = start + phone.start;
    if (word != words.end() && word->first == i) {
      event(What::word, time, word->text, word->end - word->start);
      begun.words.emplace_back(time, word->text);
      ++word;
    }
    if (phone.label == dam::kSilence || (i == 0 && line.goes_on)) continue;
    event(What::phone, time, phone.label, phone.duration());
  }
  for (const voice::SpeechMark& mark : line.speech.marks) {
    event(What::mark, start + mark.time, mark.name, 0);
  }
  if (line.last_part && !(begun.part && ended_parts_.contains(number))) {
    event(What::done, end, {}, 0);
  }
  begun_.push_back(std::move(begun));
}

void LineEvents::cut(double time, std::uint64_t before, const std::string& why) {
  const auto is_cut = [&](std::uint64_t line) {
    return std::any_of(begun_.begin(), begun_.end(), [&](const Begun& begun) {
      return begun.line == line && line < before && begun.end > time;
    });
  };
  std::vector<LineEvent> cancelled;
  std::erase_if(waiting_, [&](const LineEvent& event) {
    if (event.time <= time) return false;
    const bool mark = event.line == 0 && event.what == What::mark;
    if (mark) cancelled.push_back({.what = What::cancelled, .time = time, .id = event.text});
    return mark || is_cut(event.line);
  });
  for (const Begun& begun : begun_) {
    if (!is_cut(begun.line)) continue;
    LineEvent event{.what = What::cancelled, .time = time, .line = begun.line, .id = begun.id};
    for (const auto& [start, word] : begun.words) {
      if (start <= time) event.text += (event.text.empty() ? "" : " ") + word;
    }
    if (begun.part && !ended_parts_.insert(begun.line).second) continue;
    cancelled.push_back(std::move(event));
  }
  std::erase_if(begun_, [&](const Begun& begun) { return begun.line < before; });
  for (LineEvent& event : cancelled) {
    event.why = why;
    add(std::move(event));
  }
}

void LineEvents::cancel_parts(LineEvent event) {
  if (ended_parts_.insert(event.line).second) add(std::move(event));
}

void LineEvents::add_word(std::uint64_t line, double start, const std::string& word,
                          double duration) {
  const auto begun = std::find_if(begun_.begin(), begun_.end(),
                                  [line](const Begun& one) { return one.line == line; });
  if (begun == begun_.end()) return;
  double time = std::max(begun->start + start, time_);
  if (time > held_) time += kWaits;
  if (time >= begun->end) return;  // all of it has been told
  LineEvent event{.what = What::word, .time = time, .line = line, .id = begun->id, .text = word};
  event.duration = duration;
  add(std::move(event));
  begun->words.emplace_back(time, word);
}

void LineEvents::hold(double time) {
  held_ = time;
  for (LineEvent& event : waiting_) {
    if (event.time > time) event.time += kWaits;
  }
  for (Begun& begun : begun_) {
    if (begun.end > time) begun.end += kWaits;
    for (auto& [start, word] : begun.words) {
      if (start > time) start += kWaits;
    }
  }
}

void LineEvents::go_on(double later) {
  const double shift = later - kWaits;
  std::vector<LineEvent> held;
  std::erase_if(waiting_, [&](const LineEvent& event) {
    if (event.time < kWaits) return false;
    held.push_back(event);
    return true;
  });
  for (Begun& begun : begun_) {
    if (begun.end < kWaits) continue;
    begun.end += shift;
    begun.start += later;  // for words that become known later
    for (auto& [start, word] : begun.words) {
      if (start >= kWaits) start += shift;
    }
  }
  held_ = std::numeric_limits<double>::infinity();
  for (LineEvent& event : held) {
    event.time += shift;
    add(std::move(event));
  }
}

void LineEvents::tell(double time) {
  time_ = std::max(time_, time);
  while (!waiting_.empty() && waiting_.front().time <= time) {
    told_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  std::erase_if(begun_, [time](const Begun& begun) { return begun.end <= time; });
}

std::vector<LineEvent> LineEvents::take() { return std::exchange(told_, {}); }

}  // namespace animeme::speech
