#include "tools/live/serve/head_lines.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "tools/speech/talking/line_command.h"

namespace animeme::serve {
namespace {

bool ends_the_head(const std::string& line) {
  const Result<speech::LineCommand> command = speech::read_line(line, false);
  return command && command->what == speech::LineCommand::Do::end;
}

}  // namespace

HeadLines::HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
                     std::function<void()> changed)
    : maker_(std::move(maker)),
      voices_(voices),
      clock_(clock),
      queue_(maker_.most_bytes, maker_.cut, maker_.json),
      changed_(std::move(changed)) {}

Result<void> HeadLines::push(std::vector<std::string> lines) {
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  std::size_t bytes = queue_.bytes();
  for (const std::string& line : lines) {
    bytes += line.size();
    if (ends_the_head(line)) {
      return make_error(Code::invalid_argument, "\"end\" is not supported for a head; use DELETE");
    }
  }
  if (queue_.waiting() + lines.size() > kMostLines || bytes > kMostBytes) {
    return make_error(Code::out_of_range,
                      "too many lines are queued; send more when some have been spoken");
  }
  Result<void> done;
  for (std::string& line : lines) {
    done = queue_.push(std::move(line), clock_.now());
    if (!done) break;
  }
  {
    const std::lock_guard lock(mutex_);
    news_ = true;
  }
  order();
  tell();
  return done;
}

bool HeadLines::idle() const {
  const std::lock_guard lock(mutex_);
  return !news_ && !making_ && queue_.waiting() == 0;
}

std::size_t HeadLines::waiting() const { return queue_.waiting(); }

std::int64_t HeadLines::given() const {
  const std::lock_guard lock(mutex_);
  return given_;
}

void HeadLines::stop() {
  queue_.abandon("the head has gone");
  queue_.leave();
  const std::lock_guard lock(telling_);
  changed_ = nullptr;
}

std::optional<speech::SpokenLine> HeadLines::take(bool only_joining) {
  std::optional<speech::SpokenLine> line = queue_.take(only_joining);
  if (!line) return line;
  {
    const std::lock_guard lock(mutex_);
    given_ += line->mark ? 0 : 1;
  }
  order();
  return line;
}

std::vector<speech::LineNews> HeadLines::take_news() {
  {
    const std::lock_guard lock(mutex_);
    news_ = false;
  }
  return queue_.take_news();
}

void HeadLines::abandon(const std::string& why) { queue_.abandon(why); }

std::string HeadLines::last_warning() const {
  std::vector<std::string> warnings = queue_.take_warnings();
  const std::lock_guard lock(mutex_);
  if (!warnings.empty()) warning_ = std::move(warnings.back());
  return warning_;
}

// One line at a time, so that a head with a book to read lets others speak.
void HeadLines::order() {
  {
    const std::lock_guard lock(mutex_);
    if (making_ || !queue_.try_job()) return;
    making_ = true;
  }
  voices_.post([self = shared_from_this()] { self->make_one(); });
}

void HeadLines::make_one() {
  if (std::optional<speech::LineQueue::Job> job = queue_.try_job()) {
    const std::uint64_t number = job->line;
    const auto wanted = [this, number] { return queue_.wanted(number); };
    Result<speech::SpokenLine> line = make_error(Code::internal, "");
    try {
      line = speech::make_line(maker_, std::move(*job), wanted);
    } catch (const std::exception& problem) {  // memory
      line = make_error(Code::out_of_range, problem.what());
    }
    queue_.made(number, std::move(line), clock_.now());
  }
  {
    const std::lock_guard lock(mutex_);
    making_ = false;
    news_ = true;  // a line may have been left out
  }
  order();
  tell();
}

void HeadLines::tell() {
  const std::lock_guard lock(telling_);
  if (changed_) changed_();
}

}  // namespace animeme::serve
