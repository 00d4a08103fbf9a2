#include "fap/text_reader.h"

#include <optional>
#include <utility>

#include "fap/detail/text_frame.h"
#include "fap/detail/text_header.h"
#include "fap/detail/text_notes.h"
#include "fap/detail/text_order.h"
#include "fap/detail/text_window.h"

namespace animeme::fap {

namespace {

using detail::TextNotes;
using detail::TextScanner;
using detail::TextWindow;

constexpr std::size_t kHead = 64;  // bytes that tell what else a text may be

// The frames as the text has them, with its own numbers.
class RawFrames {
 public:
  explicit RawFrames(ReadTextPiece read) : window_(std::move(read)) {}

  Result<detail::TextHeader> header(const ReadTextOptions& options, TextNotes& notes) {
    if (!options.default_rate.valid()) {
      return make_error(Code::invalid_argument, "the default frame rate has to be positive");
    }
    const Result<std::string_view> ahead = window_.ahead(kHead);
    if (!ahead) return ahead.error();
    std::string_view text = *ahead;
    detail::remove_byte_order_mark(text, notes);
    window_.skip(ahead->size() - text.size());
    const std::string head(text.substr(0, kHead));
    return window_.read(notes, [&](TextScanner& scanner, TextNotes& found) {
      return detail::read_header(head, scanner, detail::kFapDialect, options, found);
    });
  }

  // The line of its number; nullopt: there are no more.
  Result<std::optional<std::int64_t>> next(Frame& frame, TextNotes& notes) {
    return window_.read(notes, [&](TextScanner& scanner, TextNotes& found) {
      using Line = std::optional<std::int64_t>;
      if (!scanner.to_content()) return Result<Line>(Line());
      frame = {};
      const Result<std::int64_t> line = detail::read_frame(scanner, found, frame);
      return line ? Result<Line>(Line(*line)) : Result<Line>(line.error());
    });
  }

 private:
  TextWindow window_;
};

}  // namespace

Result<TextSurvey> survey_text(ReadTextPiece read, const ReadTextOptions& options) {
  RawFrames frames(std::move(read));
  TextNotes notes;
  TextNotes order_notes;
  const Result<detail::TextHeader> header = frames.header(options, notes);
  if (!header) return header.error();
  TextSurvey survey{options, header->rate, header->name, 0, -1, {}, false, {}};
  detail::FrameOrder order(options.keep_numbers, false);
  std::optional<Error> disorder;
  std::size_t count = 0;
  std::int64_t first = 0;
  std::int64_t first_line = 0;
  bool equal = true;
  Frame frame;
  for (;;) {
    const auto line = frames.next(frame, notes);
    if (!line) return line.error();
    if (!*line) break;
    if (count++ == 0) {
      first = frame.number;
      first_line = **line;
    }
    equal = equal && frame.number == first;
    survey.mask |= frame.mask;
    if (disorder) continue;
    const auto number = order.take(frame.number, **line, order_notes);
    if (!number) {
      disorder = number.error();
    } else if (*number) {
      survey.last = **number;
      ++survey.frames;
    }
  }
  detail::check_count(*header, count, notes);
  survey.constant_number = equal && count > 1;
  if (survey.constant_number) {
    survey.frames = std::int64_t(count);
    survey.last = survey.frames - 1;
    order_notes = {};
    const auto noted = detail::FrameOrder(false, true).take(first, first_line, order_notes);
    if (!noted) return noted.error();
  } else if (disorder) {
    return *disorder;
  }
  notes.add(order_notes);
  survey.warnings = notes.lines();
  return survey;
}

struct TextReader::Impl {
  Impl(ReadTextPiece read, const TextSurvey& survey)
      : frames(std::move(read)),
        options(survey.options),
        order(survey.options.keep_numbers, survey.constant_number) {}

  // Reads a frame and gives it its number; it may belong to the one before.
  Result<void> read_ahead() {
    const auto line = frames.next(ahead, notes);
    if (!line) return line.error();
    over = !*line;
    if (over) return {};
    const auto number = order.take(ahead.number, **line, notes);
    if (!number) return number.error();
    again = !*number;
    if (!again) ahead.number = **number;
    return {};
  }

  Result<const Frame*> next() {
    if (!begun) {
      const auto header = frames.header(options, notes);
      if (!header) return header.error();
      begun = true;
      if (auto read = read_ahead(); !read) return read.error();
    }
    if (over) return nullptr;
    frame = ahead;
    for (;;) {
      if (auto read = read_ahead(); !read) return read.error();
      if (over || !again) return &frame;
      detail::merge_frames(frame, ahead);
    }
  }

  RawFrames frames;
  ReadTextOptions options;
  detail::FrameOrder order;
  TextNotes notes;  // are known from the survey
  bool begun = false;
  bool over = false;
  bool again = false;  // `ahead` belongs to the frame before
  Frame frame;
  Frame ahead;
};

TextReader::TextReader(ReadTextPiece read, const TextSurvey& survey)
    : impl_(std::make_unique<Impl>(std::move(read), survey)) {}
TextReader::TextReader(TextReader&&) noexcept = default;
TextReader& TextReader::operator=(TextReader&&) noexcept = default;
TextReader::~TextReader() = default;

Result<const Frame*> TextReader::next() { return impl_->next(); }

}  // namespace animeme::fap
