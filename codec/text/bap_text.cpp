#include "codec/text/bap_text.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "fap/detail/text_header.h"
#include "fap/detail/text_order.h"
#include "fap/detail/text_parameters.h"
#include "fap/detail/text_writing.h"
#include "fap/rate_text.h"

namespace animeme::fba {

namespace {

using fap::detail::ParameterReader;
using fap::detail::Quirk;
using fap::detail::TextDialect;
using fap::detail::TextHeader;
using fap::detail::TextNotes;
using fap::detail::TextScanner;

constexpr int kStandardBaps = 186;
constexpr std::size_t kFrameBytes = 2 * kStandardBaps + 2;  // shortest text of a frame

// With the shorter mask, which is enough to detect a text without a header.
constexpr TextDialect kBapDialect = {
    "BAP text",   "BAP", "3.2", fap::detail::kBapVersions, "FAP text", fap::detail::kFapVersions,
    kStandardBaps};

// Number of flags if the line at the scanner holds a mask and nothing else.
std::optional<int> lone_mask(TextScanner ahead) {
  int flags = 0;
  for (std::string_view token = ahead.token(); !token.empty(); token = ahead.token()) {
    if ((token != "0" && token != "1") || ++flags > kBapCount + 1) return std::nullopt;
  }
  // One flag too many is forgiven, as in FAP text.
  if (flags == kStandardBaps || flags == kStandardBaps + 1) return kStandardBaps;
  if (flags == kBapCount || flags == kBapCount + 1) return kBapCount;
  return std::nullopt;
}

int mask_length(const TextHeader& header, TextScanner& scanner, TextNotes& notes) {
  const int by_version = header.version == "3.1" ? kStandardBaps : kBapCount;
  if (!scanner.to_content()) return by_version;
  const std::optional<int> seen = lone_mask(scanner);
  if (!seen) return by_version;
  if (*seen != by_version && !header.version.empty()) {
    notes.add(Quirk::mask_length, scanner.line(), [&] {
      return "a mask has " + std::to_string(*seen) + " values, version " +
             fap::detail::in_quotes(header.version) + " should have " + std::to_string(by_version);
    });
  }
  return *seen;
}

class BodyReader {
 public:
  BodyReader(const TextDialect& dialect, TextScanner& scanner, TextNotes& notes)
      : flags_(std::size_t(dialect.flags)), in_(dialect, scanner, notes) {}

  // The line of the frame number.
  Result<std::int64_t> read(BodyFrame& frame) {
    if (!read_mask(frame) || !in_.find_values(needs_of(frame)) || !read_values(frame)) {
      return std::move(in_).error();
    }
    return in_.number_line();
  }

 private:
  static ParameterReader::Needs needs_of(const BodyFrame& frame) {
    const int tokens = 1 + int(frame.mask.count());
    return {tokens, tokens};
  }

  bool read_mask(BodyFrame& frame) {
    std::array<std::uint8_t, kBapCount> flags{};
    if (!in_.read_mask(std::span(flags).first(flags_))) return false;
    for (std::size_t i = 0; i < flags.size(); ++i) frame.mask[i + 1] = flags[i] != 0;
    return true;
  }

  bool read_values(BodyFrame& frame) {
    if (!in_.frame_number(frame.number)) return false;
    for (std::size_t bap = 1; bap <= kBapCount; ++bap) {
      if (frame.mask[bap] && !in_.value(frame.value[bap])) return false;
    }
    return true;
  }

  std::size_t flags_;
  ParameterReader in_;
};

void merge(BodyFrame& into, const BodyFrame& later) {
  into.mask |= later.mask;
  for (std::size_t bap = 1; bap <= kBapCount; ++bap) {
    if (later.mask[bap]) into.value[bap] = later.value[bap];
  }
}

Result<BodySequence> read(std::string_view text, TextNotes& notes) {
  fap::detail::remove_byte_order_mark(text, notes);
  TextScanner scanner(text);
  Result<TextHeader> header = fap::detail::read_header(text, scanner, kBapDialect, {}, notes);
  if (!header) return std::move(header).error();
  TextDialect dialect = kBapDialect;
  dialect.flags = mask_length(*header, scanner, notes);

  BodySequence sequence{header->rate, {}, header->name};
  std::vector<std::int64_t> lines;
  const std::size_t room = text.size() / kFrameBytes;
  const std::size_t expected = std::size_t(std::max<std::int64_t>(header->count.value_or(0), 0));
  sequence.frames.reserve(std::min(room, expected));
  while (scanner.to_content()) {
    BodyReader reader(dialect, scanner, notes);
    Result<std::int64_t> line = reader.read(sequence.frames.emplace_back());
    if (!line) return std::move(line).error();
    lines.push_back(*line);
  }
  fap::detail::check_count(*header, sequence.frames.size(), notes);
  if (auto error = fap::detail::order_frames(sequence.frames, lines, true, notes, merge)) {
    return std::move(*error);
  }
  return sequence;
}

}  // namespace

Result<BodySequence> read_bap_text(std::string_view text, std::vector<std::string>* warnings) {
  TextNotes notes;
  Result<BodySequence> sequence = read(text, notes);
  if (warnings != nullptr) *warnings = notes.lines();
  return sequence;
}

std::string write_bap_text(const BodySequence& sequence) {
  std::bitset<kBapCount + 1> used;
  for (const BodyFrame& frame : sequence.frames) used |= frame.mask;
  const bool extended = (used >> (kStandardBaps + 1)).any();
  const std::size_t flags = extended ? kBapCount : kStandardBaps;
  std::string text = (extended ? "3.2 " : "3.1 ") + fap::detail::one_word(sequence.name) + " " +
                     fap::format_rate(sequence.rate) + " " +
                     std::to_string(sequence.frames.size()) + "\n";
  for (const BodyFrame& frame : sequence.frames) {
    for (std::size_t bap = 1; bap <= flags; ++bap) {
      text += frame.mask[bap] ? '1' : '0';
      text += bap < flags ? ' ' : '\n';
    }
    fap::detail::append_number(text, frame.number);
    for (std::size_t bap = 1; bap <= flags; ++bap) {
      if (!frame.mask[bap]) continue;
      text += ' ';
      fap::detail::append_number(text, frame.value[bap]);
    }
    text += '\n';
  }
  return text;
}

BodySequence body_sequence(const DecodedStream& stream) {
  BodySequence sequence;
  sequence.rate = stream.rate;
  for (const Plane& plane : stream.planes) {
    if (plane.body) sequence.frames.push_back(*plane.body);
  }
  return sequence;
}

}  // namespace animeme::fba
