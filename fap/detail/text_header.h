// The first line of a FAP text. Internal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
};

/// Reads the header, or finds out that there is none, and leaves the scanner behind it.
/// `text` is the whole text without a byte order mark.
Result<TextHeader> read_header(std::string_view text, TextScanner& scanner,
                               const ReadTextOptions& options, TextNotes& notes);

}  // namespace animeme::fap::detail
