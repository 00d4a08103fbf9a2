#include "fap/text.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "fap/detail/text_frame.h"
#include "fap/detail/text_header.h"
#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"

namespace animeme::fap {
namespace {

using detail::Quirk;
using detail::TextNotes;
using detail::TextScanner;

constexpr std::size_t kFrameBytes = 2 * kFapCount + 2;  // shortest text of a frame

void merge(Frame& into, const Frame& later) {
  into.mask |= later.mask;
  if (later.mask[1]) into.viseme = later.viseme;
  if (later.mask[2]) into.expression = later.expression;
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (later.mask[fap]) into.value[fap] = later.value[fap];
  }
}

bool all_numbers_equal(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames) {
    if (frame.number != frames.front().number) return false;
  }
  return frames.size() > 1;
}

// Makes the frame numbers ascend strictly by the rules of text.h. `lines` has the line of each
// frame number.
std::optional<Error> order_frames(std::vector<Frame>& frames,
                                  const std::vector<std::int64_t>& lines, bool keep_numbers,
                                  TextNotes& notes) {
  if (frames.empty()) return std::nullopt;
  if (all_numbers_equal(frames)) {
    notes.add(Quirk::constant_number, lines.front(),
              [] { return "all frames have the same number, they are numbered in their order"; });
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].number = std::int64_t(i);
    return std::nullopt;
  }
  std::int64_t shift = 0;
  if (!keep_numbers && frames.front().number != 0) {
    shift = -frames.front().number;
    notes.add(Quirk::first_number, lines.front(), [&] {
      return "the frame numbers start at " + std::to_string(-shift) + ", they are shifted to 0";
    });
  }
  std::size_t kept = 0;
  std::int64_t previous = frames.front().number;
  frames.front().number += shift;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::int64_t number = frames[i].number;
    if (number == previous) {
      notes.add(Quirk::repeated_number, lines[i], [&] {
        return "frame number " + std::to_string(number) + " comes again, the frames are merged";
      });
      merge(frames[kept], frames[i]);
      continue;
    }
    if (number < previous) {
      shift = frames[kept].number + 1 - number;
      notes.add(Quirk::restarted_number, lines[i], [&] {
        return "frame number " + std::to_string(number) + " comes after " +
               std::to_string(previous) + ", the numbering goes on behind it";
      });
    }
    previous = number;
    const std::int64_t shifted = number + shift;
    if (shifted > 4 * detail::kLargestNumber) {
      return error_at_line(Code::out_of_range, "the frame numbers run beyond 10^15", lines[i]);
    }
    frames[++kept] = frames[i];
    frames[kept].number = shifted;
  }
  frames.resize(kept + 1);
  return std::nullopt;
}

void check_count(const detail::TextHeader& header, std::size_t frames, TextNotes& notes) {
  if (!header.count || *header.count == std::int64_t(frames)) return;
  notes.add(Quirk::wrong_count, header.line, [&] {
    const std::string said =
        *header.count < 0 ? "no valid frame count" : std::to_string(*header.count) + " frames";
    return "the header says " + said + ", the text has " + std::to_string(frames);
  });
}

Result<Sequence> read(std::string_view text, const ReadTextOptions& options, TextNotes& notes) {
  if (!options.default_rate.valid()) {
    return make_error(Code::invalid_argument, "the default frame rate has to be positive");
  }
  if (text.substr(0, 3) == "\xef\xbb\xbf") {
    text.remove_prefix(3);
    notes.add(Quirk::byte_order_mark, 1, [] { return "the text has a byte order mark"; });
  }
  TextScanner scanner(text);
  Result<detail::TextHeader> header = detail::read_header(text, scanner, options, notes);
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
  check_count(*header, sequence.frames.size(), notes);
  if (auto error = order_frames(sequence.frames, lines, options.keep_numbers, notes)) {
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
