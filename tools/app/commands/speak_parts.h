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
  std::string input;  // a text, or a file
  speech::SpokenOptions spoken;
  std::vector<std::string> outputs;
  std::string output;  // of those, the one that is written
  std::string preview;
  std::string model;
  std::string rate = "25";
  std::string save_script;
  std::string report;  // file of --report
  StreamSettings stream;
  SoundSettings sound;
  dam::SynthesisOptions motion;
  bool no_closure = false;
  IdleOptions idle;  // neither on nor off: where it can be had
  OverChoice over;
  std::string fit;                                      // range of --fit
  std::shared_ptr<const dam::Performance> performance;  // of --over
  dam::KeptShares keep;
  std::optional<dam::Prosody> prosody;  // of the voice, for it
  bool exact = false;
  std::string visemes, expressions;  // where FAP 1 and 2 go
  std::string mood;
  bool tongue = true;
  bool no_words = false;
  bool subtitles = false;
  bool language_told = false;
  std::optional<double> least;  // confidence
  bool json = false;
  std::vector<std::string> cast;                     // --cast: people who talk to each other
  std::string turns;                                 // who of them speaks when
  const dam::Attention* attention = nullptr;         // of one of them
  std::shared_ptr<const media::EncodedAudio> coded;  // of --audio-codec copy
};

/// P, B and M of a part of the speech, and how many of them close the lips.
struct ClosedLips {
  std::size_t phones = 0, closed = 0;
};

/// Of the face as it is shown, with all that lies over the speech.
struct LipClosures {
  std::vector<std::pair<double, bool>> phones;  // middle in seconds, closed

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
  std::size_t frames = 0;
  double seconds = 0;
  std::optional<dam::OverReport> over;
  std::optional<LipClosures> lips;
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
