// The first line of a FAP or BAP text. Internal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fap/detail/text_dialect.h"
#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"
#include "fap/rate.h"
#include "fap/result.h"
#include "fap/text.h"

namespace animeme::fap::detail {

struct TextHeader {
  std::string name;
  Rate rate;
  std::optional<std::int64_t> count;  ///< frames announced; none: unknown
  std::int64_t line = 1;
  std::string version;  ///< empty: there is no header
};

/// Reads the header, or finds out that there is none, and leaves the scanner behind it.
/// `text` is the whole text without a byte order mark.
Result<TextHeader> read_header(std::string_view text, TextScanner& scanner,
                               const TextDialect& dialect, const ReadTextOptions& options,
                               TextNotes& notes);

/// Notes it if the header announces another number of frames.
void check_count(const TextHeader& header, std::size_t frames, TextNotes& notes);

/// Takes a byte order mark off the text and notes it.
void remove_byte_order_mark(std::string_view& text, TextNotes& notes);

}  // namespace animeme::fap::detail
