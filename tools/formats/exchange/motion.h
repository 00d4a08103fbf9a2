/// @file
/// Motion out of any bytes: text, streams, tables of curves. No containers: tools/formats/media
/// opens them, and decode_motion() takes the stream that it finds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/exchange/file_kind.h"

namespace animeme::exchange {

/// What some bytes hold.
struct Motion {
  FileKind kind = FileKind::unknown;  ///< what it was read from
  fap::Sequence face;                 ///< no frames: there is no face
  fba::BodySequence body;             ///< no frames: there is no body
  std::vector<std::uint8_t> stream;   ///< the raw FBA stream; empty for text
  fba::DecodedStream decoded;         ///< of the stream; no planes for text
  std::vector<std::string> warnings;  ///< sentences for people: quirks, what was left out
};

/// Frame numbers of FAP text start at 0 unless they are to be kept.
enum class FrameNumbers : std::uint8_t { from_zero, keep };

/// Reads FAP text, BAP text, a raw FBA stream or a table of curves (curves.h), told by kind_of().
/// Errors: those of the readers; truncated (no bytes), unsupported (a container), syntax (a model,
/// a script, nothing at all).
Result<Motion> read_motion(std::vector<std::uint8_t> bytes,
                           FrameNumbers numbers = FrameNumbers::from_zero);

/// A raw FBA stream. Errors: those of fba::decode().
Result<Motion> decode_motion(std::vector<std::uint8_t> stream);

}  // namespace animeme::exchange
