#include "tools/live/serve/head_lines.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "tools/speech/talking/line_command.h"
#include "tools/speech/talking/pieces.h"

namespace animeme::serve {
namespace {

constexpr double kBytesPerSecond = 14;          // of a text that is spoken at the usual speed
constexpr double kSoundBytesPerSecond = 80000;  // of pieces of sound, as services send them

double seconds_of(std::size_t bytes) { return double(bytes) / kBytesPerSecond; }

// What a line does to the queue.
enum class What : std::uint8_t { speaks, replaces, marks, empties, moves, ends };

What what_is(const std::string& line, bool piece) {
  const Result<speech::LineCommand> command = speech::read_line(line, piece);
  if (!command) return What::moves;  // it is refused
  switch (command->what) {
    case speech::LineCommand::Do::say:
      return command->when == speech::LineCommand::When::now ? What::replaces : What::speaks;
    case speech::LineCommand::Do::mark:
      return What::marks;
    case speech::LineCommand::Do::stop:
    case speech::LineCommand::Do::drop:
      return What::empties;
    case speech::LineCommand::Do::end:
      return What::ends;
    default:
      return What::moves;
  }
}

}  // namespace

HeadLines::HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
                     std::function<void()> changed, double most_seconds, bool slow)
    : pieces_(maker.pieces),
      sample_rate_(maker.sample_rate),
      most_seconds_(most_seconds),
      voices_(voices),
      clock_(clock),
      queue_(maker.cut ? std::min(maker.most_bytes, kPartBytes) : maker.most_bytes, maker.cut,
             maker.json, maker.pieces, true),
      maker_(std::make_shared<const speech::LineMaker>(std::move(maker))),
      slow_(slow),
      changed_(std::move(changed)) {}

void HeadLines::speak_with(speech::LineMaker maker, bool slow) {
  maker.pieces = pieces_;
  const std::lock_guard lock(mutex_);
  maker_ = std::make_shared<const speech::LineMaker>(std::move(maker));
  slow_ = slow;
}

Result<std::vector<std::string>> HeadLines::push(std::vector<std::string> lines) {
  const std::lock_guard one_at_a_time(pushing_);
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  std::size_t bytes = queue_.bytes(), count = queue_.waiting(), sound = queue_.piece_bytes();
  bool more = false;  // than commands that make room
  std::vector<bool> are_pieces;
  std::vector<What> whats;
  for (const std::string& line : lines) {
    const bool piece = pieces_ && line.starts_with('{') && speech::is_piece(line);
    const What what = what_is(line, piece);
    are_pieces.push_back(piece);
    whats.push_back(what);
    if (what == What::ends) {
      return make_error(Code::invalid_argument, "\"end\" is not supported for a head; use DELETE");
    }
    if (what == What::empties || what == What::replaces) bytes = count = sound = 0;
    if (what == What::empties || what == What::moves) continue;
    (piece ? sound : bytes) += line.size();
    ++count;
    more = true;
  }
  const bool waits = count > 1 && seconds_of(bytes) > most_seconds_;
  if (more && (count > kMostLines || bytes > kMostBytes || sound > kMostSound || waits)) {
    return make_error(Code::out_of_range,
                      "too much is queued; send more when some of it has been spoken");
  }
  Result<void> done;
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const What what = whats[i];
    done = are_pieces[i] ? queue_.push_piece(std::move(lines[i]), clock_.now())
                         : queue_.push(std::move(lines[i]), clock_.now());
    if (!done) break;
    if (what == What::speaks || what == What::replaces) ids.push_back(queue_.last_id());
  }
  changed_by_push();
  if (!done) return done.error();
  return ids;
}

Result<void> HeadLines::push_sound(const std::string& id, media::Pcm sound, bool last) {
  if (!pieces_) return make_error(Code::unsupported, "this head takes no sound");
  const std::lock_guard one_at_a_time(pushing_);
  Result<void> done = queue_.push_sound(id, std::move(sound), last, clock_.now());
  changed_by_push();
  return done;
}

void HeadLines::changed_by_push() {
  {
    const std::lock_guard lock(mutex_);
    news_ = true;
  }
  order();
  tell();
}

bool HeadLines::idle() const {
  const std::lock_guard lock(mutex_);
  return !news_ && !making_ && queue_.waiting() == 0;
}

std::size_t HeadLines::waiting() const { return queue_.waiting(); }

std::size_t HeadLines::bytes() const { return queue_.bytes(); }

std::size_t HeadLines::piece_bytes() const { return queue_.piece_bytes(); }

double HeadLines::seconds() const {
  return seconds_of(queue_.bytes()) + double(queue_.piece_bytes()) / kSoundBytesPerSecond;
}

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
  bool slow = false;
  {
    const std::lock_guard lock(mutex_);
    if (making_) return;
    const std::optional<speech::LineQueue::Job> job = queue_.try_job();
    if (!job) return;
    slow = slow_ || job->piece != 0;
    making_ = true;
  }
  const auto make = [self = shared_from_this()] { self->make_one(); };
  if (slow) {
    voices_.post_slow(make);
  } else {
    voices_.post(make);
  }
}

void HeadLines::make_one() {
  std::shared_ptr<const speech::LineMaker> maker;
  {
    const std::lock_guard lock(mutex_);
    maker = maker_;
  }
  if (std::optional<speech::LineQueue::Job> job = queue_.try_job()) {
    const std::uint64_t number = job->line;
    const auto wanted = [this, number] { return queue_.wanted(number); };
    Result<speech::SpokenLine> line = make_error(Code::internal, "");
    try {
      line = speech::make_line(*maker, std::move(*job), wanted);
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
