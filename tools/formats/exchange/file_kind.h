/// @file
/// What a file holds, told by its first bytes, whatever its name.
#pragma once

#include <cstdint>
#include <span>

namespace animeme::exchange {

/// What a file is.
enum class FileKind : std::uint8_t {
  fap_text,    ///< fap/text.h
  bap_text,    ///< codec/text/bap_text.h
  fba_stream,  ///< codec/decode/decoder.h
  model,       ///< dam/model/model.h
  script,      ///< dam/script/script.h
  curves,      ///< curves.h
  media,       ///< a container, a playlist of one, or bytes that are nothing of the others
  unknown      ///< text without content
};

/// Never fails. Text is told by its first line with content, and for tables of landmarks, which
/// have long ones, the whole of it is looked at; of anything else the first 4 kB at most.
FileKind kind_of(std::span<const std::uint8_t> bytes);

/// Is it media in segments (HLS, DASH)? Such a file is to be read by its path, never by its bytes:
/// what it names lies beside it.
bool is_playlist(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
