/// @file
/// What is sent: a clip that is there as a whole, or a head that speaks line by line.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "dam/model/model.h"
#include "fap/rate.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/live/sessions/clip.h"
#include "tools/speech/talking/control_socket.h"
#include "tools/speech/talking/live_speaker.h"
#include "tools/speech/talking/live_voice.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::live {

/// What is said, how it looks and how it is coded.
struct ProgramOptions {
  std::string say;        ///< file of lines to speak as they come, "-": standard input
  std::string say_json;   ///< likewise, of pieces (tools/speech/talking/pieces.h); one of the two
  std::string control;    ///< path of a control socket for lines and commands; empty: none
  std::string say_audio;  ///< sound of a voice as it comes, "-": standard input
  std::optional<speech::BareSound> bare;            ///< how its samples lie; nothing: WAV
  double delay = speech::LiveVoiceOptions().delay;  ///< seconds, of a voice as it comes
  speech::SpokenOptions spoken;                     ///< text, script or voice
  Coding coding;                                    ///< of face and sound
  std::string model;                                ///< as speech::read_model() takes it
  dam::SynthesisOptions motion;                     ///< its rate, frames and tail are not used
  bool idle_motion = false;  ///< blinks, and brows and head that move a little
  std::uint64_t seed = 1;    ///< of the idle motion
  bool loop = false;         ///< clips begin again at their end
  double duration = std::numeric_limits<double>::infinity();  ///< seconds
};

/// What is sent, and all that has to live as long.
struct Program {
  dam::Model model;                                ///< of the speaker
  int descriptor = -1;                             ///< of the lines, if it is ours to close
  std::unique_ptr<speech::ControlSocket> control;  ///< null: there is none
  std::unique_ptr<speech::VoiceLines> lines;       ///< null: a clip plays
  std::unique_ptr<speech::LiveSpeaker> speaker;    ///< null: a clip plays
  std::unique_ptr<speech::LiveVoice> voice;        ///< null: no voice is listened to
  std::unique_ptr<media::ClipInput> clip;          ///< null: lines are spoken, or a voice speaks

  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();
  media::LiveInput& input() const;  ///< the clip, the speaker or the voice
};

/// Text, script or recorded voice as a clip of `rate`, as `animeme speak` makes it. Errors: those
/// of speech::read_model(), speech::get_spoken(), dam::synthesise() and code_live_clip().
Result<Clip> spoken_clip(const ProgramOptions& options, fap::Rate rate, const tools::Log& log = {});

/// Makes `program` play a clip.
void play_clip(Clip clip, const ProgramOptions& options, Program& program);

/// Makes `program` a head that speaks the lines of options.say or say_json, and of options.control.
/// `program` must stay where it is. Errors: those of speech::read_model(), speech::ControlSocket,
/// VoiceLines and LiveSpeaker; not_found (no such file).
Result<void> open_speaker(const ProgramOptions& options, fap::Rate rate, Program& program);

/// Makes `program` a head that follows the voice of options.say_audio; waits for its first bytes.
/// `program` must stay where it is. Errors: those of speech::read_model() and LiveVoice; not_found
/// (no such file).
Result<void> open_voice(const ProgramOptions& options, fap::Rate rate, Program& program);

}  // namespace animeme::live
