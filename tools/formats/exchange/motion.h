/// @file
/// Reads motion from bytes: text, streams, tables of curves. Containers are opened by
/// tools/formats/media; pass the stream to decode_motion().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/decode/repair.h"
#include "codec/encode/splice.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/exchange/file_kind.h"

namespace animeme::exchange {

/// Motion read from bytes.
struct Motion {
  FileKind kind = FileKind::unknown;  ///< format it was read from
  fap::Sequence face;                 ///< no frames if there is no face
  fba::BodySequence body;             ///< no frames if there is no body
  std::vector<std::uint8_t> stream;   ///< the raw FBA stream; empty for text
  fba::DecodedStream decoded;         ///< of the stream; no planes for text
  std::vector<std::string> warnings;  ///< sentences for the user: quirks, dropped data
};

/// Whether frame numbers of FAP text are shifted to start at 0, or kept.
enum class FrameNumbers : std::uint8_t { from_zero, keep };

/// Reads FAP text, BAP text, a raw FBA stream or a table of curves (curves.h), detected by
/// kind_of(). `damage` as of decode_motion().
/// Errors: those of the readers; truncated (no bytes), unsupported (a container), syntax (a model,
/// a script, empty text).
Result<Motion> read_motion(std::vector<std::uint8_t> bytes,
                           FrameNumbers numbers = FrameNumbers::from_zero,
                           std::vector<fba::Damage>* damage = nullptr);

/// A sentence about streams that were joined, for the user.
std::string note_of(const fba::JoinedStreams& joined);

/// Decodes a raw FBA stream, or several one behind the other. A damaged one is repaired if `damage`
/// is not null, which receives what is lost; Motion::stream is then the repaired one. Errors: those
/// of fba::decode().
Result<Motion> decode_motion(std::vector<std::uint8_t> stream,
                             std::vector<fba::Damage>* damage = nullptr);

}  // namespace animeme::exchange
