#include "tools/speech/talking/line_queue.h"

#include <algorithm>
#include <utility>

#include "tools/speech/talking/line_cutter_internal.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::speech {

namespace {

constexpr std::size_t kMostMade = 4;  // lines that are made and wait: a voice is faster than speech
constexpr std::size_t kMostKept = 8;  // such lines when others are put before them
constexpr std::size_t kQueueBytes = std::size_t(64) << 20;
constexpr std::size_t kQueueLines = 100000;
constexpr std::size_t kShown = 60;  // bytes of a line that is left out

// As much of a text as a message shows; no half of a letter.
std::string beginning(const std::string& text) {
  std::size_t end = std::min(kShown, text.size());
  while (end < text.size() && end > 0 && (std::uint8_t(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end);
}

std::string name_of(std::uint64_t line, const std::string& text) {
  return "line " + std::to_string(line) + ", \"" + beginning(text) + "\"";
}

LineNews behaviour_news(const LineCommand& command, double at) {
  LineNews news;
  news.at = at;
  news.what = LineNews::What::activity;
  switch (command.what) {
    case LineCommand::Do::look:
      news.what = LineNews::What::look;
      news.target = command.target;
      break;
    case LineCommand::Do::listen:
      news.activity = dam::Activity::listening;
      break;
    case LineCommand::Do::think:
      news.activity = dam::Activity::thinking;
      break;
    default:
      news.activity = dam::Activity::idle;
  }
  return news;
}

}  // namespace

Result<void> LineQueue::push(std::string line, double arrived) {
  if (line.empty()) return {};
  const std::string shown = beginning(line);
  // Looked at before the lock is taken: a piece of many megabytes takes its time.
  Result<LineCommand> command = read_line(std::move(line), json_);
  const std::lock_guard lock(mutex_);
  ++number_;
  if (!command) {
    Error error = command.error();
    warnings_.push_back(name_of(number_, shown) + ", is left out: " + error.describe());
    error.message = "line " + std::to_string(number_) + ": " + error.message;
    return error;
  }
  switch (command->what) {
    case LineCommand::Do::say:
      say(std::move(*command), arrived);
      break;
    case LineCommand::Do::stop:
      forget_all(LineNews::What::stopped, "stopped", arrived);
      break;
    case LineCommand::Do::drop:
      forget_all(LineNews::What::dropped, "dropped", arrived);
      break;
    case LineCommand::Do::mark: {
      Entry mark{.line = number_, .id = std::move(command->id), .arrived = arrived, .mark = true};
      if (mark.id.empty()) mark.id = std::to_string(number_);
      entries_.push_back(std::move(mark));
      break;
    }
    case LineCommand::Do::end:
      closed_ = true;
      break;
    case LineCommand::Do::look:
    case LineCommand::Do::listen:
    case LineCommand::Do::think:
    case LineCommand::Do::idle:
      news_.push_back(behaviour_news(*command, arrived));
      break;
    case LineCommand::Do::mood: {
      LineNews news;
      news.what = LineNews::What::mood;
      news.mood = *command->mood;
      news.at = arrived;
      news_.push_back(std::move(news));
      break;
    }
  }
  changed_.notify_all();
  return {};
}

void LineQueue::say(LineCommand command, double arrived) {
  if (command.when == LineCommand::When::now) {
    forget_all(LineNews::What::stopped, "stopped", arrived);
  }
  // A text that is too long is spoken in parts, which have names of their own.
  std::vector<std::string> parts;
  if (cut_ && command.id.empty()) cut_at_blanks(command.payload, most_bytes_, parts);
  parts.emplace_back(media::trim(command.payload));
  // What is to be next follows the marks of what is spoken now.
  auto place = entries_.end();
  if (command.when == LineCommand::When::next) {
    place = std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.mark; });
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) ++number_;
    Entry entry{.line = number_, .id = command.id, .arrived = arrived};
    if (entry.id.empty()) entry.id = std::to_string(number_);
    entry.mood = command.mood;
    entry.text = parts.size() > 1 ? parts[i] : command.text;
    entry.payload = std::move(parts[i]);
    tell(LineNews::What::queued, entry, {}, arrived);
    if (entry.payload.size() > most_bytes_) {
      const std::string why =
          "it has more than " + std::to_string(most_bytes_) + " bytes; send shorter pieces";
      warnings_.push_back(name_of(number_, entry.payload) + ", is left out: " + why);
      tell(LineNews::What::cancelled, entry, why, arrived);
      continue;
    }
    bytes_ += entry.payload.size();
    entries_.insert(place, std::move(entry));
  }
}

void LineQueue::forget_all(LineNews::What what, const std::string& why, double at) {
  LineNews news;
  news.what = what;
  news.line = number_;
  news.at = at;
  news_.push_back(std::move(news));
  for (const Entry& entry : entries_) tell(LineNews::What::cancelled, entry, why, at);
  entries_.clear();
  bytes_ = made_ = 0;
}

void LineQueue::tell(LineNews::What what, const Entry& entry, const std::string& why, double at) {
  LineNews news;
  news.what = what;
  news.line = entry.line;
  news.id = entry.id;
  news.text = entry.text;
  news.mark = entry.mark;
  news.why = why;
  news.at = at;
  news_.push_back(std::move(news));
}

void LineQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
}

bool LineQueue::full() {
  const std::lock_guard lock(mutex_);
  return bytes_ >= kQueueBytes || entries_.size() >= kQueueLines;
}

std::size_t LineQueue::waiting() {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

std::size_t LineQueue::bytes() {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::optional<LineQueue::Job> LineQueue::look_for_job() {
  std::size_t ahead = 0;
  for (const Entry& entry : entries_) {
    if (entry.mark) continue;
    if (!entry.speech) return Job{entry.line, entry.payload};
    if (++ahead == kMostMade) break;
  }
  return std::nullopt;
}

std::optional<LineQueue::Job> LineQueue::next_job() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (left_) return std::nullopt;
    if (auto job = look_for_job()) return job;
    changed_.wait(lock);
  }
}

std::optional<LineQueue::Job> LineQueue::try_job() {
  const std::lock_guard lock(mutex_);
  return look_for_job();
}

LineQueue::Entries::iterator LineQueue::find(std::uint64_t line) {
  return std::find_if(entries_.begin(), entries_.end(),
                      [line](const Entry& entry) { return entry.line == line; });
}

bool LineQueue::wanted(std::uint64_t line) {
  const std::lock_guard lock(mutex_);
  return !left_ && find(line) != entries_.end();
}

void LineQueue::made(std::uint64_t line, Result<SpokenLine> speech, double spoken) {
  // By the thread of the voice: the clock of the head does not wait for it.
  if (speech) speech->prosody = voice::measure_prosody(speech->speech.audio);
  const std::lock_guard lock(mutex_);
  const auto entry = find(line);
  if (entry == entries_.end()) return;
  const std::string name = name_of(line, entry->text.empty() ? entry->payload : entry->text);
  if (!speech) {
    const std::string why = speech.error().describe();
    warnings_.push_back(name + ", is left out: " + why);
    tell(LineNews::What::cancelled, *entry, why, spoken);
    bytes_ -= entry->payload.size();
    entries_.erase(entry);
    return;
  }
  if (!speech->doubt.empty()) warnings_.push_back(name + ": " + speech->doubt);
  speech->line = line;
  speech->id = entry->id;
  speech->mood = entry->mood;
  if (!entry->text.empty()) speech->text = entry->text;
  speech->arrived = entry->arrived;
  speech->spoken = spoken;
  entry->speech = std::move(*speech);
  // Where many are put before others, the last ones are made again when their turn comes.
  if (++made_ <= kMostKept) return;
  std::size_t count = 0;
  for (Entry& one : entries_) {
    if (one.speech && ++count > kMostKept) one.speech.reset();
  }
  made_ = std::min(made_, kMostKept);
}

void LineQueue::leave() {
  {
    const std::lock_guard lock(mutex_);
    left_ = true;
  }
  changed_.notify_all();
}

std::optional<SpokenLine> LineQueue::take(bool only_joining) {
  const std::lock_guard lock(mutex_);
  if (entries_.empty()) return std::nullopt;
  Entry& first = entries_.front();
  SpokenLine line;
  if (first.mark) {
    line.line = first.line;
    line.id = std::move(first.id);
    line.mark = true;
    line.arrived = first.arrived;
  } else {
    if (!first.speech || (only_joining && !first.speech->joins)) return std::nullopt;
    line = std::move(*first.speech);
    bytes_ -= first.payload.size();
    --made_;
  }
  entries_.pop_front();
  changed_.notify_all();
  return line;
}

std::vector<LineNews> LineQueue::take_news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

bool LineQueue::ended() {
  const std::lock_guard lock(mutex_);
  return closed_ && entries_.empty() && news_.empty();
}

void LineQueue::abandon(const std::string& why) {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) tell(LineNews::What::cancelled, entry, why, entry.arrived);
  entries_.clear();
  bytes_ = made_ = 0;
  closed_ = true;
}

std::vector<std::string> LineQueue::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

}  // namespace animeme::speech
