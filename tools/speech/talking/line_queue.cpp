#include "tools/speech/talking/line_queue.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/speech/talking/line_cutter_internal.h"
#include "tools/speech/talking/pieces.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::speech {

namespace {

constexpr std::size_t kMostMade = 4;  // lines that are made and wait: a voice is faster than speech
constexpr double kMostMadeSeconds = 10;  // of speech, which takes memory
constexpr std::size_t kMostKept = 8;     // such lines when others are put before them
constexpr std::size_t kQueueBytes = std::size_t(64) << 20;
constexpr std::size_t kQueueLines = 100000;
constexpr std::size_t kMostGone = 4;  // pieces that were taken and may get words
constexpr double kSameWord = 0.05;    // seconds
constexpr std::size_t kShown = 60;    // bytes of a line that is left out

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
    case LineCommand::Do::hear:
      news.what = LineNews::What::hear;
      news.voice = command.voice;
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
  return push(std::move(line), arrived, json_);
}

Result<void> LineQueue::push_piece(std::string line, double arrived) {
  return push(std::move(line), arrived, true);
}

Result<void> LineQueue::push_sound(const std::string& id, media::Pcm sound, bool last,
                                   double arrived) {
  const std::size_t bytes = sound.samples.size() * sizeof(float);
  const std::lock_guard lock(mutex_);
  const Result<PieceStream::Taken> taken = pieces_->add_sound(id, std::move(sound), last);
  if (!taken) return taken.error();
  Entry entry{.line = number_ + 1, .id = id, .arrived = arrived, .bytes = bytes, .is_piece = true};
  if (!add_piece(entry, taken)) {
    changed_.notify_all();
    return {};
  }
  ++number_;
  tell(LineNews::What::queued, entry, {}, arrived);
  last_id_ = entry.id;
  piece_bytes_ += bytes;
  entries_.push_back(std::move(entry));
  changed_.notify_all();
  return {};
}

Result<void> LineQueue::push(std::string line, double arrived, bool piece) {
  if (line.empty()) return {};
  const std::string shown = beginning(line);
  // Looked at before the lock is taken: a piece of many megabytes takes its time.
  Result<LineCommand> command = read_line(std::move(line), piece);
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
      say(std::move(*command), arrived, piece);
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
      close_input(arrived);
      break;
    case LineCommand::Do::pause:
    case LineCommand::Do::resume:
      hold(command->what == LineCommand::Do::pause, arrived);
      break;
    case LineCommand::Do::look:
    case LineCommand::Do::listen:
    case LineCommand::Do::think:
    case LineCommand::Do::idle:
    case LineCommand::Do::hear:
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

void LineQueue::say(LineCommand command, double arrived, bool piece) {
  if (command.when == LineCommand::When::now) {
    forget_all(LineNews::What::stopped, "stopped", arrived);
  }
  // A text that is too long is spoken in parts: lines of their own, or one line if it has a name.
  std::vector<std::string> parts;
  const std::size_t most = json_ || !piece ? most_bytes_ : kMostPiece;
  if (cut_ && !piece) cut_at_blanks(command.payload, most_bytes_, parts);
  parts.emplace_back(media::trim(command.payload));
  // What is to be next follows the marks of what is spoken now.
  auto place = entries_.end();
  if (command.when == LineCommand::When::next) {
    place = std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return !e.mark; });
  }
  const bool one = one_line_ || !command.id.empty();
  const std::uint64_t whole = parts.size() > 1 && one ? number_ : 0;
  if (whole > 0 && command.id.empty()) command.id = std::to_string(number_);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) ++number_;
    Entry entry{.line = number_, .id = command.id, .arrived = arrived};
    if (entry.id.empty()) entry.id = std::to_string(number_);
    entry.mood = command.mood;
    entry.language = command.language;
    entry.whole = whole;
    entry.first_part = whole == 0 || i == 0;
    entry.last_part = whole == 0 || i + 1 == parts.size();
    // The whole of a text goes with its first part alone: it may have hundreds.
    if (whole == 0) entry.text = parts.size() > 1 ? parts[i] : command.text;
    if (whole > 0 && i == 0) entry.text = command.text;
    entry.payload = std::move(parts[i]);
    entry.bytes = entry.payload.size();
    entry.is_piece = piece;
    const bool fits = entry.payload.size() <= most;
    if (pieces_ && piece && fits && !add_piece(entry, pieces_->add(entry.payload))) continue;
    if (entry.first_part) {
      tell(LineNews::What::queued, entry, {}, arrived);
      last_id_ = entry.id;
    }
    if (!fits) {
      const std::string why =
          "it has more than " + std::to_string(most) + " bytes; send shorter pieces";
      warnings_.push_back(name_of(number_, entry.payload) + ", is left out: " + why);
      tell(LineNews::What::cancelled, entry, why, arrived);
      continue;
    }
    (entry.is_piece ? piece_bytes_ : bytes_) += entry.bytes;
    entries_.insert(place, std::move(entry));
  }
}

// False: nothing of it waits to be spoken.
bool LineQueue::add_piece(Entry& entry, const Result<PieceStream::Taken>& taken) {
  const std::string name = name_of(entry.line, entry.text.empty() ? entry.payload : entry.text);
  if (!taken) {
    const std::string why = taken.error().describe();
    warnings_.push_back(name + ", is left out: " + why);
    tell(LineNews::What::queued, entry, {}, entry.arrived);
    tell(LineNews::What::cancelled, entry, why, entry.arrived);
    return false;
  }
  if (!taken->warning.empty()) warnings_.push_back(name + ": " + taken->warning);
  if (taken->utterance != 0) improve(taken->utterance);
  if (taken->key == 0) return false;
  entry.piece = taken->key;
  entry.utterance = taken->utterance;
  if (entry.text.empty()) entry.text = taken->text;
  entry.payload.clear();
  return true;
}

// More is known about an utterance.
void LineQueue::improve(std::uint64_t utterance) {
  for (Entry& entry : entries_) {
    if (entry.utterance != utterance || !entry.speech || !entry.speech->improvable) continue;
    if (pieces_->may_improve(entry.piece)) entry.stale = true;
  }
  for (Gone& gone : gone_) {
    gone.stale |= gone.utterance == utterance && pieces_->times_came(gone.piece);
  }
}

// Its words may still be told in time.
void LineQueue::keep_in_mind(const Entry& entry, const SpokenLine& line) {
  gone_.push_back({entry.line, entry.piece, entry.utterance, line.id, *line.words, false});
  if (gone_.size() <= kMostGone) return;
  pieces_->forget(gone_.front().piece);
  gone_.pop_front();
}

// Of a piece that was taken.
void LineQueue::tell_words(std::uint64_t line, const Result<SpokenLine>& speech) {
  const auto gone = std::find_if(gone_.begin(), gone_.end(),
                                 [line](const Gone& one) { return one.line == line; });
  if (gone == gone_.end()) return;
  gone->stale = false;
  if (!speech || !speech->words) return;
  for (const dam::ScriptWord& word : *speech->words) {
    const bool known = std::any_of(gone->told.begin(), gone->told.end(), [&](const auto& told) {
      return told.text == word.text && std::abs(told.start - word.start) < kSameWord;
    });
    if (known) continue;
    gone->told.push_back(word);
    LineNews news;
    news.what = LineNews::What::word;
    news.line = line;
    news.id = gone->id;
    news.text = word.text;
    news.start = word.start;
    news.duration = word.end - word.start;
    news_.push_back(std::move(news));
  }
}

void LineQueue::forget(const Entry& entry) {
  (entry.is_piece ? piece_bytes_ : bytes_) -= entry.bytes;
  if (entry.speech) --made_;
  if (entry.piece != 0) pieces_->forget(entry.piece);
}

void LineQueue::forget_all(LineNews::What what, const std::string& why, double at) {
  if (what == LineNews::What::stopped) paused_ = false;
  LineNews news;
  news.what = what;
  news.line = number_;
  news.at = at;
  news_.push_back(std::move(news));
  for (const Entry& entry : entries_) {
    tell(LineNews::What::cancelled, entry, why, at);
    forget(entry);
  }
  entries_.clear();
  for (const Gone& gone : gone_) pieces_->forget(gone.piece);
  gone_.clear();
}

void LineQueue::tell(LineNews::What what, const Entry& entry, const std::string& why, double at) {
  LineNews news;
  news.what = what;
  news.line = entry.whole > 0 ? entry.whole : entry.line;
  news.part = entry.whole > 0;
  news.id = entry.id;
  news.text = entry.text;
  news.mark = entry.mark;
  news.why = why;
  news.at = at;
  news_.push_back(std::move(news));
}

void LineQueue::close(double at) {
  const std::lock_guard lock(mutex_);
  close_input(at);
}

// Who paused can no longer say that it goes on.
void LineQueue::close_input(double at) {
  closed_ = true;
  hold(false, at);
}

void LineQueue::hold(bool pause, double at) {
  if (std::exchange(paused_, pause) == pause) return;
  LineNews news;
  news.what = pause ? LineNews::What::paused : LineNews::What::resumed;
  news.line = number_;
  news.at = at;
  news_.push_back(std::move(news));
}

bool LineQueue::full() {
  const std::lock_guard lock(mutex_);
  return bytes_ + piece_bytes_ >= kQueueBytes || entries_.size() >= kQueueLines;
}

std::string LineQueue::last_id() {
  const std::lock_guard lock(mutex_);
  return last_id_;
}

std::size_t LineQueue::waiting() {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

std::size_t LineQueue::bytes() {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t LineQueue::piece_bytes() {
  const std::lock_guard lock(mutex_);
  return piece_bytes_;
}

std::optional<LineQueue::Job> LineQueue::look_for_job() {
  for (const Gone& gone : gone_) {
    if (gone.stale) return Job{gone.line, {}, gone.piece, {}, true};
  }
  std::size_t ahead = 0;
  double seconds = 0;
  for (const Entry& entry : entries_) {
    if (entry.mark) continue;
    if (!entry.speech || entry.stale) {
      return Job{entry.line, entry.payload, entry.piece, entry.language, false};
    }
    seconds += entry.speech->speech.audio.duration();
    if (++ahead == kMostMade || seconds >= kMostMadeSeconds) break;
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
  if (entry == entries_.end()) {
    tell_words(line, speech);
    return;
  }
  const std::string name = name_of(line, entry->text.empty() ? entry->payload : entry->text);
  if (!speech) {
    const std::string why = speech.error().describe();
    warnings_.push_back(name + ", is left out: " + why);
    tell(LineNews::What::cancelled, *entry, why, spoken);
    forget(*entry);
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
  speech->whole = entry->whole;
  speech->first_part = entry->first_part;
  speech->last_part = entry->last_part;
  const bool again = entry->speech.has_value();
  entry->speech = std::move(*speech);
  entry->stale = false;
  if (again) return;
  // Where many are put before others, the last ones are made again when their turn comes.
  if (++made_ <= kMostKept) return;
  std::size_t count = 0;
  for (Entry& one : entries_) {
    if (!one.speech || ++count <= kMostKept) continue;
    one.speech.reset();
    one.stale = false;
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
    const bool may_get_words = first.speech->words && first.piece != 0;
    if (may_get_words) keep_in_mind(first, *first.speech);
    if (may_get_words) first.piece = 0;  // not forgotten yet
    forget(first);
    line = std::move(*first.speech);
  }
  entries_.pop_front();
  changed_.notify_all();
  return line;
}

std::optional<double> LineQueue::improvable_since() {
  const std::lock_guard lock(mutex_);
  if (closed_ || entries_.empty() || entries_.front().mark) return std::nullopt;
  const Entry& first = entries_.front();
  if (first.stale) return first.arrived;
  if (!first.speech || !first.speech->improvable) return std::nullopt;
  return first.arrived;
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
  for (const Entry& entry : entries_) {
    tell(LineNews::What::cancelled, entry, why, entry.arrived);
    forget(entry);
  }
  entries_.clear();
  closed_ = true;
}

Result<SpokenLine> make_line(const LineMaker& maker, LineQueue::Job job, const Wanted& wanted) {
  if (job.piece != 0) {
    return job.words ? maker.pieces->words(job.piece) : maker.pieces->make(job.piece);
  }
  if (job.language.empty()) return maker.make(std::move(job.payload), wanted);
  if (maker.make_in) return maker.make_in(std::move(job.payload), job.language, wanted);
  Result<SpokenLine> line = maker.make(std::move(job.payload), wanted);
  if (line) {
    line->doubt += (line->doubt.empty() ? "" : "; ") + std::string("its language is not used");
  }
  return line;
}

std::vector<std::string> LineQueue::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

}  // namespace animeme::speech
