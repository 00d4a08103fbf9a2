/// @file
/// A live voice and the face that follows it by its sound alone, on one clock:
/// what `animeme stream --say-audio -` sends.
///
/// Sound that comes is heard and its face seen LiveVoiceOptions::delay seconds later, both
/// together. Where none comes in time the voice fades, the mouth rests, and both go on when 60 ms
/// of it have come again; sound that comes faster than it is heard waits in the pipe. Nothing of it
/// is left out, so each pause of the sender that is longer than 60 ms moves what follows back.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dam/model/model.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/speech/talking/sound_pipe.h"

namespace animeme::speech {

/// All settings of LiveVoice.
struct LiveVoiceOptions {
  dam::SynthesisOptions synthesis;  ///< `frames` and `tail` are not used
  std::string language = "en";      ///< of the voice, see voice::ListenOptions
  std::optional<BareSound> bare;    ///< how the samples lie; nothing: WAV
  double delay = 0.3;               ///< seconds from sound that comes to its face, 0.25..2
  int fap_quant = 1;                ///< 0..31
  double intra_seconds = 1;         ///< seconds between intra planes
  /// How the sound is coded; nothing: the face alone.
  std::optional<media::AudioSettings> audio = media::AudioSettings{};
  double audio_ahead = 0.02;  ///< seconds that sound is sent before its time, 0..0.1
  double duration = std::numeric_limits<double>::infinity();  ///< seconds, then it is over
};

/// Sound is read in a thread of its own. Not thread safe.
class LiveVoice : public media::LiveInput {
 public:
  /// Waits for the head of the sound, which tells its rate. `descriptor` is borrowed; the model
  /// must outlive the voice. Errors: those of SoundBytes, HeardFace::open(), TalkingFace::open(),
  /// fba::LiveEncoder and media::AudioEncoder::open(); truncated (no sound at all),
  /// invalid_argument (options out of range).
  static Result<std::unique_ptr<LiveVoice>> open(const dam::Model& model, int descriptor,
                                                 const LiveVoiceOptions& options);
  /// The same with samples of `rate` from wherever they come.
  static Result<std::unique_ptr<LiveVoice>> open(const dam::Model& model,
                                                 std::unique_ptr<SoundFeed> feed, int rate,
                                                 const LiveVoiceOptions& options);
  ~LiveVoice() override;

  const media::LiveInfo& info() const override;
  double audio_ahead() const override;
  /// Over when the sound has ended and been heard, or at the duration.
  std::optional<double> next_due() override;
  Result<std::vector<media::LiveUnit>> take(double now) override;
  /// One sentence for all that went wrong since the last call: a sound that broke off.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  explicit LiveVoice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
