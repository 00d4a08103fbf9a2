#include "fap/text.h"

#include <algorithm>
#include <utility>

#include "fap/detail/text_frame.h"
#include "fap/detail/text_header.h"
#include "fap/detail/text_notes.h"
#include "fap/detail/text_order.h"
#include "fap/detail/text_scanner.h"

namespace animeme::fap {
namespace {

using detail::TextNotes;
using detail::TextScanner;

constexpr std::size_t kFrameBytes = 2 * kFapCount + 2;  // shortest text of a frame

Result<Sequence> read(std::string_view text, const ReadTextOptions& options, TextNotes& notes) {
  if (!options.default_rate.valid()) {
    return make_error(Code::invalid_argument, "the default frame rate has to be positive");
  }
  detail::remove_byte_order_mark(text, notes);
  TextScanner scanner(text);
  Result<detail::TextHeader> header =
      detail::read_header(text, scanner, detail::kFapDialect, options, notes);
  if (!header) return std::move(header).error();

  Sequence sequence{header->rate, {}, header->name};
  std::vector<std::int64_t> lines;
  const std::size_t room = text.size() / kFrameBytes;
  const std::size_t expected = std::size_t(std::max<std::int64_t>(header->count.value_or(0), 0));
  sequence.frames.reserve(std::min(room, expected));
  while (scanner.to_content()) {
    Result<std::int64_t> line = detail::read_frame(scanner, notes, sequence.frames.emplace_back());
    if (!line) return std::move(line).error();
    lines.push_back(*line);
  }
  detail::check_count(*header, sequence.frames.size(), notes);
  if (auto error = detail::order_frames(sequence.frames, lines, options.keep_numbers, notes,
                                        detail::merge_frames)) {
    return std::move(*error);
  }
  return sequence;
}

}  // namespace

Result<Sequence> read_text(std::string_view text, const ReadTextOptions& options,
                           std::vector<std::string>* warnings) {
  TextNotes notes;
  Result<Sequence> sequence = read(text, options, notes);
  if (warnings != nullptr) *warnings = notes.lines();
  return sequence;
}

}  // namespace animeme::fap
