/// @file
/// What is sent: a complete clip, or a head that speaks line by line.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "dam/model/model.h"
#include "dam/performance/over_speech.h"
#include "dam/speaking/idle_motion.h"
#include "fap/rate.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/live/sessions/clip.h"
#include "tools/speech/talking/control_socket.h"
#include "tools/speech/talking/live_speaker.h"
#include "tools/speech/talking/live_voice.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::live {

/// Options for the content and its encoding.
struct ProgramOptions {
  std::string say;        ///< file of lines to speak as they arrive, "-": standard input
  std::string say_json;   ///< the same for pieces (tools/speech/talking/pieces.h); one of the two
  std::string control;    ///< path of a control socket for lines and commands; empty: none
  std::string say_audio;  ///< sound of a live voice, "-": standard input
  std::optional<speech::BareSound> bare;  ///< format of raw samples; nullopt: WAV
  std::string
      hear;  ///< sound of the other party, as speech::OtherVoice::open() has it; empty: none
  std::optional<speech::BareSound> hear_bare;       ///< format of its raw samples; nullopt: WAV
  double delay = speech::LiveVoiceOptions().delay;  ///< seconds, for a live voice
  double coding_delay = 0;       ///< seconds, as speech::SpeakerOptions::coding_delay
  speech::SpokenOptions spoken;  ///< text, script or voice
  Coding coding;                 ///< of face and sound
  std::string model;             ///< argument of speech::read_model()
  dam::SynthesisOptions motion;  ///< its rate, frames and tail are not used
  bool idle_motion = true;       ///< gaze, blinks, brows and head
  dam::IdleMotionOptions idle;   ///< of the idle motion; without `prosody`
  dam::Mood mood;                ///< of the face
  /// A performance that is kept under the speech; null: none. It repeats below a head that speaks
  /// line by line or follows a live voice; below a clip its time is bent
  /// (dam/performance/over_speech.h).
  std::shared_ptr<const dam::Performance> over = nullptr;
  dam::KeptShares keep = {};                                  ///< what is kept of it
  bool loop = false;                                          ///< repeat clips
  double duration = std::numeric_limits<double>::infinity();  ///< seconds
};

/// The content and everything that must outlive it.
struct Program {
  dam::Model model;                                ///< of the speaker
  int descriptor = -1;                             ///< of the lines, if owned
  std::unique_ptr<speech::ControlSocket> control;  ///< may be null
  std::unique_ptr<speech::VoiceLines> lines;       ///< null: a clip plays
  std::unique_ptr<speech::LiveSpeaker> speaker;    ///< null: a clip plays
  std::unique_ptr<speech::LiveVoice> voice;        ///< null: no live voice
  std::unique_ptr<media::ClipInput> clip;          ///< null: lines or a live voice

  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();
  media::LiveInput& input() const;  ///< the clip, the speaker or the voice
};

/// Makes a clip at `rate` from text, script or recorded voice, like `animeme speak`. Errors: those
/// of speech::read_model(), speech::get_spoken(), dam::synthesise() and code_live_clip().
Result<Clip> spoken_clip(const ProgramOptions& options, fap::Rate rate, const tools::Log& log = {});

/// Makes `program` play a clip.
void play_clip(Clip clip, const ProgramOptions& options, Program& program);

/// Makes `program` a head that speaks the lines of options.say or say_json, and of options.control,
/// and listens to options.hear.
/// `program` must not be moved. Errors: those of speech::read_model(), speech::ControlSocket,
/// VoiceLines, OtherVoice and LiveSpeaker; not_found (no such file).
Result<void> open_speaker(const ProgramOptions& options, fap::Rate rate, Program& program);

/// Makes `program` a head that follows the voice of options.say_audio; waits for its first bytes.
/// `program` must not be moved. Errors: those of speech::read_model() and LiveVoice; not_found (no
/// such file).
Result<void> open_voice(const ProgramOptions& options, fap::Rate rate, Program& program);

}  // namespace animeme::live
