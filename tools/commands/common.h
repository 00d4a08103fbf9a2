/// @file
/// What the commands of the program share: inputs with motion.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/commands/command.h"
#include "tools/commands/terminal.h"
#include "tools/files/files.h"

namespace animeme::tools {

/// What a file holds, told by its content.
enum class FileKind : std::uint8_t {
  fap_text,
  bap_text,
  fba_stream,
  model,
  script,
  curves,
  media,
  unknown
};
FileKind kind_of(std::span<const std::uint8_t> bytes);  ///< told by content
/// Is it media in segments (HLS, DASH)? Such a file is to be read by its path, never by its bytes:
/// what it names lies beside it.
bool is_playlist(std::span<const std::uint8_t> bytes);

/// Any input with motion: .fap or .bap text, raw .fba, a container, or a table of curves
/// (time_s, fap3_open_jaw ... as in a corpus; ARKit shapes, see arkit_csv.h). For text, warnings
/// about quirks are printed.
struct MotionInput {
  FileKind kind = FileKind::unknown;  ///< how it was read
  fap::Sequence face;                 ///< no frames: there is no face
  fba::BodySequence body;             ///< no frames: there is no body
  std::vector<std::uint8_t> stream;   ///< the raw FBA stream; empty for text
  fba::DecodedStream decoded;         ///< of the stream; no planes for text
  double start = 0;                   ///< of frame 0, seconds on the clock of a container's sound
};
/// Frame numbers of FAP text start at 0 unless they are to be kept.
enum class FrameNumbers : std::uint8_t { from_zero, keep };
/// "-" is standard input; errors name the path.
Result<MotionInput> read_motion(const std::string& path,
                                FrameNumbers numbers = FrameNumbers::from_zero);
/// The same from bytes that were read already; `path` is for names and messages.
Result<MotionInput> parse_motion(std::vector<std::uint8_t> bytes, const std::string& path,
                                 FrameNumbers numbers = FrameNumbers::from_zero);

/// Any input with a face as a clip.
struct FaceInput {
  fap::Sequence clip;                ///< ascending frame numbers
  std::vector<std::uint8_t> stream;  ///< the raw FBA stream; empty for text
  double start = 0;                  ///< as MotionInput::start
};
/// As read_motion(). A stream or text with a body but no face is not_found.
Result<FaceInput> read_face(const std::string& path);
/// Likewise, from bytes that were read already.
Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path);
/// The face of an input that was read already, and the check for there being one.
Result<FaceInput> face_of(MotionInput input, const std::string& path);
/// not_found if it has no face.
Result<void> require_face(const MotionInput& input, const std::string& path);

}  // namespace animeme::tools
