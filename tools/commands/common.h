/// @file
/// What the commands of the program share: inputs with motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/commands/command.h"
#include "tools/commands/terminal.h"
#include "tools/exchange/motion.h"
#include "tools/files/files.h"

/// The commands of the program and what they share.
namespace animeme::tools {

using exchange::FileKind;
using exchange::FrameNumbers;
using exchange::is_playlist;
using exchange::kind_of;

/// Any input with motion: what exchange::read_motion() reads, or a container. Its warnings were
/// printed.
struct MotionInput : exchange::Motion {
  double start = 0;  ///< of frame 0, seconds on the clock of a container's sound
};
/// "-" is standard input; errors name the path.
Result<MotionInput> read_motion(const std::string& path,
                                FrameNumbers numbers = FrameNumbers::from_zero);
/// The same from bytes that were read already; `path` is for names and messages.
Result<MotionInput> parse_motion(std::vector<std::uint8_t> bytes, const std::string& path,
                                 FrameNumbers numbers = FrameNumbers::from_zero);

/// Any input with a face as a clip.
struct FaceInput {
  fap::Sequence clip;                       ///< ascending frame numbers
  std::vector<std::uint8_t> stream;         ///< the raw FBA stream; empty for text
  double start = 0;                         ///< as MotionInput::start
  std::vector<fap::GroupRules> rules = {};  ///< one a frame, for fap::fill(); empty for text
};
/// As read_motion(). A stream or text with a body but no face is not_found.
Result<FaceInput> read_face(const std::string& path);
/// The face as players show it: held and mirrored as the stream means it, FAP 1 and 2 as low-level
/// FAPs unless they are kept. Errors: those of fap::fill(), with `path`.
Result<fap::Sequence> shown_face(const FaceInput& input, const std::string& path,
                                 fap::FillOptions options = {});
/// As read_face(), from bytes that were read already.
Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path);
/// The face of an input that was read already, and the check for there being one.
Result<FaceInput> face_of(MotionInput input, const std::string& path);
/// not_found if it has no face.
Result<void> require_face(const MotionInput& input, const std::string& path);

}  // namespace animeme::tools
