/// @file
/// What the commands of the program share: inputs with motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/fill.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/app/commands/command.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/exchange/motion.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/container.h"
#include "tools/speech/talking/voice_file.h"

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
/// The bytes of an input, for kind_of() and what follows. Of a container on disk only its first 4
/// kB: open_container() reads the rest as it needs it. Errors: those of read_file().
Result<std::vector<std::uint8_t>> read_input(const std::string& path);
/// Whether an input is a file that can be read again, and from any place in it.
bool is_on_disk(const std::string& path);
/// The container or playlist that read_input() found; its warnings and damage are printed. Errors:
/// those of media::read_container().
Result<media::Container> open_container(std::span<const std::uint8_t> bytes,
                                        const std::string& path);

/// "-" is standard input; errors name the path.
Result<MotionInput> read_motion(const std::string& path,
                                FrameNumbers numbers = FrameNumbers::from_zero);
/// The same from what read_input() gave.
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
/// How long something may be that a small file asks for: a phone of a day in a script of one line,
/// two frames of a text that are hours apart.
struct LengthLimit {
  double seconds = 0;  ///< --max-seconds; 0: not given
  /// For speech::read_script().
  double of_script() const { return seconds > 0 ? seconds : speech::kMostSeconds; }
  /// For faces: missing frames are filled in up to this length.
  fap::FillOptions filling(fap::FillOptions options, const fap::Rate& rate) const;
};
/// Adds --max-seconds.
void add_length_option(OptionTable& cli, LengthLimit& limit);

/// The face as players show it: held and mirrored as the stream means it, FAP 1 and 2 as low-level
/// FAPs unless they are kept. FillOptions::keep_expressions, for heads with faces of their own, has
/// no effect on clips that move the brows or define expressions: heads would not show theirs there.
/// Errors: those of fap::fill(), with `path` and the option that allows more.
Result<fap::Sequence> shown_face(const FaceInput& input, const std::string& path,
                                 fap::FillOptions options = {}, const LengthLimit& limit = {});
/// As read_face(), from what read_input() gave.
Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path);
/// The face of an input that was read already, and the check for there being one.
Result<FaceInput> face_of(MotionInput input, const std::string& path);
/// not_found if it has no face.
Result<void> require_face(const MotionInput& input, const std::string& path);

}  // namespace animeme::tools
