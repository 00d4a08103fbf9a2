/// @file
/// Timed speech: from text (a synthetic voice), from an aligned script, from a recording with its
/// transcript, or from a recording alone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dam/behaviour/prosody.h"
#include "dam/model/model.h"
#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/pcm.h"
#include "tools/formats/programs/scratch_folder.h"
#include "tools/speech/talking/cue_voice.h"
#include "tools/speech/talking/timed_sound.h"
#include "tools/speech/talking/voice_command.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/listen.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// The source of speech: one of text, text_file, script, or audio with transcript or with `listen`.
/// A script may also have audio.
struct SpokenOptions {
  std::string text;                    ///< what to say
  bool has_text = false;               ///< text may be empty
  std::string text_file;               ///< "-": standard input
  std::string script;                  ///< a script of any format
  dam::ScriptOptions script_reading;   ///< options for reading it
  std::string audio;                   ///< a recorded voice
  std::string transcript;              ///< what is said in it
  bool has_transcript = false;         ///< transcript may be empty
  double least_confidence = 0.5;       ///< of the transcript, as voice::AlignOptions has it
  bool listen = false;                 ///< audio alone: phones are recognised
  std::function<void(double)> heard;   ///< receives the progress of recognition, 0..1; may be empty
  std::string language = "en";         ///< as voice::VoiceOptions::language
  std::string tts;                     ///< external TTS command; empty: espeak-ng
  int words_per_minute = 175;          ///< of a synthetic voice, 80 to 450
  int pitch = 50;                      ///< of a synthetic voice, 0 to 100
  double most_seconds = kMostSeconds;  ///< longest script
  /// A script of subtitles is spoken by a voice, each cue in its time (cue_voice.h), within this
  /// range of speed. The sound of a TTS command is stretched at its pitch. With `audio` the
  /// subtitles are what it says: it is aligned with them, and put into their times if it is
  /// elsewhere (fit_recording()). nullopt: the script has its sound elsewhere.
  std::optional<FitRange> fit = std::nullopt;
  /// Long sound is in a file (Spoken::recording) and not in memory: that of such a voice, of
  /// espeak-ng beyond a minute, and of a recording that can be read again.
  bool sound_in_file = false;
};

/// Speech as phones, with its sound.
struct Spoken {
  dam::Script script;  ///< timed phones
  std::optional<media::Pcm>
      audio;          ///< nullopt: a script without sound, or SpokenOptions::sound_in_file
  std::string voice;  ///< of synthetic speech
  TimesFrom times = TimesFrom::voice;         ///< source of the timings
  std::optional<voice::Alignment> alignment;  ///< if aligned; without its script
  /// If only the sound was given; `script` is its best hypothesis.
  std::optional<voice::Recognition> heard;
  std::vector<voice::SpokenLanguage> languages;  ///< of synthetic speech by espeak-ng
  std::vector<voice::SpeechMark> marks;          ///< of SSML
  std::vector<dam::MoodSpan> moods;              ///< of SSML, emoji and exclamation marks
  std::vector<std::string> warnings;             ///< about skipped or spelled words
  std::vector<FittedCue> cues;                   ///< with SpokenOptions::fit
  /// The file that `audio` is one channel of; empty: synthetic speech, or the file cannot be read
  /// again (a pipe).
  std::string recording;
  /// @{
  /// With SpokenOptions::sound_in_file: length and prosody of `recording`, and the folder that one
  /// of synthetic speech is in, which lives as long.
  double file_seconds = 0;
  std::optional<dam::Prosody> prosody;
  std::shared_ptr<tools::ScratchFolder> folder;
  /// @}

  bool has_sound() const { return audio || !recording.empty(); }  ///< in memory or in a file
  /// Seconds; 0: no sound.
  double sound_seconds() const { return audio ? audio->duration() : file_seconds; }
};

/// Whether a source is given completely.
bool has_source(const SpokenOptions& options);

/// The TTS command of options.tts, with options for its timings.
VoiceCommand voice_command(const SpokenOptions& options);

/// Synthesises, reads, aligns or recognises speech. Skipped or spelled words are reported to
/// log.warn. Errors: those of reading the files, of voice::speak_text(), run_voice_command(),
/// dam::check_against_audio(), align_file() and listen_to_file().
Result<Spoken> get_spoken(const SpokenOptions& options, const tools::Log& log = {});

/// Aligns a recording with its transcript. Doubtful words are reported to log.warn.
/// Errors: those of read_voice() and voice::align().
Result<voice::Alignment> align_file(const std::string& audio, const std::string& transcript,
                                    const voice::AlignOptions& options, const tools::Log& log = {});

/// Recognises the phones of a recording. Warnings go to log.warn. Errors: those of read_voice() and
/// voice::listen().
Result<voice::Recognition> listen_to_file(const std::string& audio,
                                          const voice::ListenOptions& options,
                                          const tools::Log& log = {});

/// The motion of the script, or the mean over all hypotheses of recognised speech. Errors: those of
/// dam::synthesise() and dam::synthesise_readings().
Result<dam::Signal> move_face(const dam::Model& model, const Spoken& spoken,
                              const dam::SynthesisOptions& options,
                              dam::SynthesisReport* report = nullptr);

/// The words of a script of any format, in order, separated by blanks. Errors: those of reading it,
/// not_found (it has phones only).
Result<std::string> words_of_file(const std::string& path, const dam::ScriptOptions& reading);

/// A model file, or the built-in model for "" and "builtin". Errors: those of dam::load_model().
Result<dam::Model> read_model(const std::string& path);

}  // namespace animeme::speech
