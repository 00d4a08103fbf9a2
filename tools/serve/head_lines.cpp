#include "tools/serve/head_lines.h"

#include <exception>
#include <utility>

namespace animeme::serve {

HeadLines::HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
                     std::function<void()> made)
    : maker_(std::move(maker)), voices_(voices), clock_(clock), made_(std::move(made)) {}

Result<void> HeadLines::push(std::vector<std::string> lines) {
  const double now = clock_.now();
  const std::lock_guard lock(mutex_);
  std::size_t bytes = bytes_, count = texts_.size();
  for (const std::string& line : lines) {
    if (line.size() > maker_.most_bytes) {
      return make_error(Code::out_of_range, "a line has more than " +
                                                std::to_string(maker_.most_bytes) +
                                                " bytes; send shorter ones");
    }
    bytes += line.size();
    count += line.empty() ? 0 : 1;
  }
  if (count > kMostLines || bytes > kMostBytes) {
    return make_error(Code::out_of_range,
                      "too many lines wait to be spoken; send them when others have been heard");
  }
  bytes_ = bytes;
  for (std::string& line : lines) {
    if (!line.empty()) texts_.push_back({std::move(line), now});
  }
  order();
  return {};
}

std::size_t HeadLines::drop() {
  const std::lock_guard lock(mutex_);
  bytes_ = 0;
  return std::exchange(texts_, {}).size();
}

bool HeadLines::idle() const {
  const std::lock_guard lock(mutex_);
  return texts_.empty() && done_.empty() && !making_;
}

std::size_t HeadLines::waiting() const {
  const std::lock_guard lock(mutex_);
  return texts_.size() + done_.size() + (making_ ? 1 : 0);
}

std::int64_t HeadLines::given() const {
  const std::lock_guard lock(mutex_);
  return given_;
}

void HeadLines::stop() {
  drop();
  const std::lock_guard lock(telling_);
  made_ = nullptr;
}

std::vector<speech::SpokenLine> HeadLines::take() {
  const std::lock_guard lock(mutex_);
  std::vector<speech::SpokenLine> lines = std::exchange(done_, {});
  given_ += std::int64_t(lines.size());
  order();
  return lines;
}

std::string HeadLines::last_warning() const {
  const std::lock_guard lock(mutex_);
  return warning_;
}

// One line ahead is made, so that sound takes little memory, and one at a time, so that a head with
// a book to read lets others speak.
void HeadLines::order() {
  if (making_ || !done_.empty() || texts_.empty()) return;
  making_ = true;
  voices_.post([self = shared_from_this()] { self->make_one(); });
}

void HeadLines::make_one() {
  Text text;
  {
    const std::lock_guard lock(mutex_);
    if (texts_.empty()) {
      making_ = false;
      return;
    }
    text = std::move(texts_.front());
    texts_.pop_front();
    bytes_ -= text.line.size();
  }
  const std::string begin = "\"" + text.line.substr(0, 60) + "\"";
  std::string warning;
  Result<speech::SpokenLine> line = make_error(Code::internal, "");
  try {
    line = maker_.make(std::move(text.line));
  } catch (const std::exception& problem) {  // memory
    line = make_error(Code::out_of_range, problem.what());
  }
  if (!line) {
    warning = begin + " is left out: " + line.error().describe();
  } else if (!line->doubt.empty()) {
    warning = begin + ": " + line->doubt;
  }
  {
    const std::lock_guard lock(mutex_);
    making_ = false;
    if (!warning.empty()) warning_ = std::move(warning);
    if (line) {
      line->arrived = text.arrived;
      line->spoken = clock_.now();
      done_.push_back(std::move(*line));
    }
    order();
  }
  const std::lock_guard lock(telling_);
  if (made_) made_();
}

}  // namespace animeme::serve
