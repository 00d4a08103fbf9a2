/// @file
/// Detects the kind of a file by its first bytes, regardless of its name.
#pragma once

#include <cstdint>
#include <span>

namespace animeme::exchange {

/// Kinds of files.
enum class FileKind : std::uint8_t {
  fap_text,    ///< fap/text.h
  bap_text,    ///< codec/text/bap_text.h
  fba_stream,  ///< codec/decode/decoder.h
  model,       ///< dam/model/model.h
  script,      ///< dam/script/script.h
  curves,      ///< curves.h
  media,       ///< a container, a playlist of one, or unknown bytes
  unknown      ///< text without content
};

/// Never fails. Text is recognised by its first non-empty line, which for tables of landmarks may
/// be long; of anything else at most the first 4 kB are examined.
FileKind kind_of(std::span<const std::uint8_t> bytes);

/// Is it a playlist of segments (HLS, DASH)? Such a file must be read by its path, not from memory,
/// as it refers to other files.
bool is_playlist(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
