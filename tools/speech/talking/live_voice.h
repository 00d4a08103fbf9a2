/// @file
/// A live voice with a face that follows it by its sound alone: what `animeme stream --say-audio -`
/// sends.
///
/// Sound and face are presented together, LiveVoiceOptions::delay seconds after the sound arrives.
/// If sound is late, the voice fades out and the mouth rests, and both continue when 60 ms have
/// arrived; sound that arrives early waits in the pipe. Nothing is dropped but by a command, so
/// each pause of the sender that is longer than 60 ms delays what follows.
///
/// Commands (line_command.h) come by a LineSource: "stop" drops all sound that was sent before it,
/// also what waits in the pipe, and closes the mouth; "drop" leaves what was about to be heard;
/// "pause" closes the mouth and lets everything wait that is not on its way to be heard, "resume"
/// goes on there, LiveVoiceOptions::delay later; "mark" is reached when all that had come before it
/// is heard; mood, look, listen, think, idle and end are as for lines. Text is not spoken: the line
/// is cancelled.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dam/model/model.h"
#include "dam/performance/over_speech.h"
#include "dam/script/mood.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/speech/talking/line_events.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/speech/talking/sound_pipe.h"

namespace animeme::speech {

/// All settings of LiveVoice.
struct LiveVoiceOptions {
  dam::SynthesisOptions synthesis;  ///< `frames` and `tail` are not used
  std::string language = "en";      ///< of the voice, see voice::ListenOptions
  std::optional<BareSound> bare;    ///< format of raw samples; nullopt: WAV
  double delay = 0.3;               ///< seconds from arrival of sound to its face, 0.25..2
  int fap_quant = 1;                ///< 0..31
  double intra_seconds = 1;         ///< seconds between intra planes
  double coding_delay = 0;          ///< as SpeakerOptions::coding_delay, besides `delay`
  /// Audio encoder settings; nullopt: face only.
  std::optional<media::AudioSettings> audio = media::AudioSettings{};
  double audio_ahead = 0.02;  ///< seconds by which sound is sent early, 0..0.1
  double duration = std::numeric_limits<double>::infinity();  ///< seconds until the end
  bool idle_motion = false;     ///< gaze, blinks, brows and head, see FaceOptions
  dam::IdleMotionOptions idle;  ///< of these; `prosody` is not used
  dam::Mood mood;               ///< at the beginning
  /// A performance under the speech, which repeats; null: none.
  std::shared_ptr<const dam::Performance> over = nullptr;
  dam::KeptShares keep = {};  ///< what is kept of it
  /// Where commands come from; must outlive the voice; null: there are none.
  LineSource* commands = nullptr;
};

/// Reads sound in a separate thread. Not thread safe.
class LiveVoice : public media::LiveInput {
 public:
  /// Waits for the header of the sound, which has its rate. `descriptor` is borrowed; the model
  /// must outlive the voice. Errors: those of SoundBytes, VoiceDrivenFace::open(),
  /// TalkingFace::open(), fba::LiveEncoder and media::AudioEncoder::open(); truncated (no sound),
  /// invalid_argument (options out of range).
  static Result<std::unique_ptr<LiveVoice>> open(const dam::Model& model, int descriptor,
                                                 const LiveVoiceOptions& options);
  /// The same with samples of `rate` from any feed.
  static Result<std::unique_ptr<LiveVoice>> open(const dam::Model& model,
                                                 std::unique_ptr<SoundFeed> feed, int rate,
                                                 const LiveVoiceOptions& options);
  ~LiveVoice() override;

  const media::LiveInfo& info() const override;
  double audio_ahead() const override;
  double delay() const override;
  /// Ends when the sound has ended and been presented, or at the duration.
  std::optional<double> next_due() override;
  Result<std::vector<media::LiveUnit>> take(double now) override;
  void sent(const media::LiveUnit& unit, double instant) override;
  void expect_loss(int percent) override;
  /// Events up to the last sent frame, in order, since the last call: of commands.
  std::vector<LineEvent> take_events();
  /// Ends: what the commands wait for is cancelled, with events from take_events().
  void end(const std::string& why);
  /// Warnings since the last call, such as sound that was interrupted.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  explicit LiveVoice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
