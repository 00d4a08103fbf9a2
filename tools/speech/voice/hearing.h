/// @file
/// What listen() and SoundListener share. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dam/script/phones.h"
#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/speech/voice/cepstra.h"
#include "tools/speech/voice/listen.h"
#include "tools/speech/voice/phone_paths.h"
#include "tools/speech/voice/sound_model.h"

namespace animeme::voice {

inline constexpr std::size_t kFeatureReach = 3;  ///< frames that features look back and ahead

/// When a frame begins, in seconds of the sound.
double time_of(std::size_t frame);

/// All that is read from files.
struct HearingModel {
  SoundModel sound;                      ///< how phones sound
  std::vector<double> pairs;             ///< which follow each other, see read_phone_pairs()
  PathOptions weights;                   ///< how much either is believed
  std::vector<std::string> labels;       ///< of each phone; noises are silence
  std::vector<dam::PhoneClass> classes;  ///< of each phone
};

/// "en", "en-gb" ...
bool speaks_english(const std::string& language);

/// Errors: those of read_sound_model() and read_phone_pairs(), invalid_argument (options).
Result<HearingModel> load_hearing(const ListenOptions& options);

/// The same, one for all that use it at a time: it takes 2 MB. Thread safe. Errors: those of
/// load_hearing().
Result<std::shared_ptr<const HearingModel>> shared_hearing(const ListenOptions& options);

/// A trace of noise that is laid under a sound. Rooms have some, and to a model that has learned
/// from rooms what is cut to zeros is no silence, and weak sounds beside it are none.
struct Trace {
  float loud = 0;  ///< how loud the voice is, full scale +-1; the noise is far below; 0: not known
  std::uint64_t number = 0;  ///< of the sample: the noise belongs to it
};

/// Samples as the model wants them.
void to_whole(std::span<const float> samples, Trace& trace, std::vector<std::int16_t>& whole);

/// Whether a frame is speech by the blocks of a SpeechPart whose sample 0 is that of frame 0.
bool is_speech(std::span<const std::uint8_t> speech, std::size_t frame);

/// The mean of the frames that are speech, as is_speech() has it; of the louder seven tenths if
/// that are hardly any. At least one frame. Silence and noise have another mean than the voice,
/// which they would move by how much there is of them. `share` times as many frames as are speech
/// count, the loudest ones, up to 0.92 of all: above 1, the edges of the pauses are among them.
Cepstrum mean_of_speech(std::span<const Cepstrum> frames, std::span<const std::uint8_t> speech,
                        double share);

/// Features of frame `at`, which has kFeatureReach neighbours on either side or the ends of
/// `frames`.
Features features_of(std::span<const Cepstrum> frames, std::size_t at, const Cepstrum& mean);

/// Of each frame and phone: how many of the paths are there, 0..1.
using Votes = std::vector<std::vector<float>>;
/// Counts them; the paths are equally long.
Votes count_votes(const std::vector<Path>& paths, std::size_t phones);

/// The path that the votes agree on, of phones of three frames and more. Votes for phones of the
/// same shape of the mouth count in part. Lips close only where, on average over the closure, the
/// share `least_closure` of the votes closes them; elsewhere the best other phones are shown.
Path agreed_path(const HearingModel& model, const Votes& votes, float least_closure);

/// The share of votes below which most closures of a recording are in vain, and above which nine
/// tenths of the right ones lie (tools/speech/voice/measured.md, section 5).
inline constexpr float kLeastClosure = 0.4f;
/// Live sound has fewer closures in vain, and loses more of the right ones.
inline constexpr float kLeastClosureLive = 0;

/// The phones of a path whose frame 0 is frame `first` of a sound; times are from `origin`
/// (seconds), from 0 to `end` (seconds). Without gaps, no two silences in a row. `confidences`, if
/// not null, gets for each how often such phones have the right shape of the mouth, 0..1, by their
/// share of the votes.
dam::Script script_of_path(const HearingModel& model, const Path& path, std::size_t first,
                           double origin, double end, const Votes* votes = nullptr,
                           std::vector<double>* confidences = nullptr);

}  // namespace animeme::voice
