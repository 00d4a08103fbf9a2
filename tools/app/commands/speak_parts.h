/// @file
/// What the parts of `speak` share: its options, a face that is made by them, what is told of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dam/performance/over_speech.h"
#include "dam/speaking/conversation.h"
#include "dam/speaking/synthesise.h"
#include "fap/frame.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/idle_options.h"
#include "tools/app/commands/over_options.h"
#include "tools/formats/common/json.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

struct OptionTable;

/// Options of `speak`.
struct SpeakOptions {
  std::string input;                                    ///< a text, or the name of a file
  speech::SpokenOptions spoken;                         ///< what is said, and by which voice
  std::vector<std::string> outputs;                     ///< -o
  std::string output;                                   ///< of those, the one that is written
  std::string preview;                                  ///< --preview; empty: none
  std::string model;                                    ///< --model; empty: the built-in one
  std::string rate = "25";                              ///< --rate, frames per second
  std::string save_script;                              ///< --save-script; empty: none
  std::string report;                                   ///< file of --report; empty: none
  StreamSettings stream;                                ///< coding of the face
  SoundSettings sound;                                  ///< coding of the sound
  dam::SynthesisOptions motion;                         ///< rate, style, sharpness
  bool no_closure = false;                              ///< --no-closure
  IdleOptions idle;                                     ///< neither on nor off: where it can be had
  OverChoice over;                                      ///< --over
  std::string fit;                                      ///< range of --fit; empty: none
  std::shared_ptr<const dam::Performance> performance;  ///< of --over; null: none
  dam::KeptShares keep;                                 ///< --keep
  std::optional<dam::Prosody> prosody;                  ///< of the voice, for idle motion
  bool exact = false;                                   ///< --exact
  std::string visemes;                                  ///< where FAP 1 goes
  std::string expressions;                              ///< where FAP 2 goes
  std::string mood;                                     ///< --mood
  bool tongue = true;                                   ///< false: --no-tongue
  bool no_words = false;                                ///< --no-words
  bool subtitles = false;                               ///< --subtitles
  bool language_told = false;                           ///< whether --lang was given
  std::optional<double> least;                          ///< --min-confidence, 0..1
  bool json = false;                                    ///< --json
  std::vector<std::string> cast;                        ///< --cast: people who talk to each other
  std::string turns;                          ///< --turns: file that says who of them speaks when
  const dam::Attention* attention = nullptr;  ///< of one of them; borrowed
  std::shared_ptr<const media::EncodedAudio> coded;  ///< of --audio-codec copy; null: coded anew
};

/// P, B and M of a part of the speech.
struct ClosedLips {
  std::size_t phones = 0;  ///< how many there are
  std::size_t closed = 0;  ///< how many of them close the lips
};

/// Of the face as it is shown, with all that lies over the speech.
struct LipClosures {
  std::vector<std::pair<double, bool>> phones;  ///< of each P, B, M: middle in seconds, closed

  /// Those from `start` on, before `end`, in seconds.
  ClosedLips between(double start, double end) const {
    ClosedLips count;
    for (const auto& [time, closed] : phones) {
      if (time < start || time >= end) continue;
      ++count.phones;
      count.closed += closed ? 1 : 0;
    }
    return count;
  }
};

/// What is told of the face that was written first.
struct ShownFace {
  std::size_t frames = 0;               ///< of the face
  double seconds = 0;                   ///< its duration
  std::optional<dam::OverReport> over;  ///< of --over
  std::optional<LipClosures> lips;      ///< nullopt: not measured
};

/// The language of the words. A script may be in any, whatever the default of --lang is; empty:
/// unknown.
std::string language_of(const SpeakOptions& options, const speech::Spoken& spoken);

/// Whether an output holds curves of the model, instead of FAPs or ARKit's shapes.
bool is_model_curves(const std::string& path);

/// Whether an output holds ARKit's shapes.
bool is_arkit_output(const std::string& path);

/// Adds what lies over the speech, for options.output: tongue, life or a performance, moods.
/// `shown` receives what it looks like. Errors: those of dam::speak_over(), add_idle_motion() and
/// add_moods(), of what was asked for.
Result<void> add_life(const SpeakOptions& options, dam::Signal& signal,
                      const speech::Spoken& spoken, ShownFace& shown);

/// The signal as FAPs, with what --visemes and --expressions say. Errors: not_found (a model of
/// another rig).
Result<fap::Sequence> shown_clip(const SpeakOptions& options, const dam::Signal& signal,
                                 const speech::Spoken& spoken);

/// Of a model of another rig, which can only be written as curves.
Error not_faps(const Error& error);

/// For set_up().
void add_options(OptionTable& cli, SpeakOptions& options);
Result<int> run(SpeakOptions& options);  ///< likewise

/// What --json tells of a face.
Json report_json(const SpeakOptions& options, const speech::Spoken& spoken,
                 const dam::SynthesisReport& synthesis, const ShownFace& shown);

/// Prints it and writes the file of --report, if they were asked for.
Result<void> give_report(const SpeakOptions& options, Json json);

}  // namespace animeme::tools
