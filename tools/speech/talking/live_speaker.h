/// @file
/// A live talking head: lines of text in, synchronised face and sound out.
///
/// The clock never stops. Between lines the face rests (or moves a little, with idle motion) and
/// the sound is silence; a line begins with the next frame that has not been made, and its sound at
/// the sample of that frame, so they are in sync to the sample. Lines that arrive while another is
/// spoken follow it. Nothing is generated ahead of time except what the audio encoder needs, so a
/// line starts as early as possible.
///
/// Speech can be interrupted (line_command.h): the mouth begins to close with the next frame and is
/// at rest within 0.1 s; the sound fades out in 20 ms, from the first sample not yet passed to its
/// encoder.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/encode/live.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/speech/talking/line_events.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/other_voice.h"
#include "tools/speech/talking/talking_face.h"

/// Live talking heads and their lines.
namespace animeme::speech {

/// All settings of LiveSpeaker.
struct SpeakerOptions {
  FaceOptions face;          ///< motion of the face
  int fap_quant = 1;         ///< 0..31; 0: gaze and head stay still, as angles end at one degree
  double intra_seconds = 1;  ///< seconds between intra planes
  /// Face and sound are sent so many seconds later, 0..60, as of fba::LiveOptions::delay_seconds.
  double coding_delay = 0;
  int voice_rate = 22050;  ///< Hz, of the lines' sound; other rates are converted
  /// Audio encoder settings; nullopt: face only.
  std::optional<media::AudioSettings> audio = media::AudioSettings{};
  double audio_ahead = 0.02;  ///< seconds by which sound is sent early, 0..1
  double duration = std::numeric_limits<double>::infinity();  ///< seconds until the end
  bool events = false;  ///< record events for LiveSpeaker::take_events()
};

/// Timestamps of a line, on the clock of the lines; 0: not (yet) reached.
struct LineTrace {
  bool waited = false;     ///< another line was queued or being spoken when it arrived
  double arrived = 0;      ///< its last character was read
  double spoken = 0;       ///< synthesis of the voice ended
  double begun = 0;        ///< motion synthesis began ...
  double synthesised = 0;  ///< ... and ended
  double face_begun = 0;   ///< coding of the first frame in which the mouth moves ...
  double face_coded = 0;   ///< ... its end
  double face_sent = 0;    ///< that frame has been sent
  double sound_begun = 0;  ///< the first packet with sound of it: coding ...
  double sound_coded = 0;  ///< ... its end
  double sound_sent = 0;   ///< that packet has been sent
};

/// Not thread safe.
class LiveSpeaker : public media::LiveInput {
 public:
  /// Model, lines and clock must outlive the speaker. Errors: those of TalkingFace::open(),
  /// fba::LiveEncoder and media::AudioEncoder::open().
  static Result<std::unique_ptr<LiveSpeaker>> open(const dam::Model& model, LineSource& lines,
                                                   media::Clock& clock,
                                                   const SpeakerOptions& options);
  ~LiveSpeaker() override;

  const media::LiveInfo& info() const override;
  double audio_ahead() const override;
  double delay() const override;
  /// Ends when the lines have ended and the last one is spoken, or at the duration.
  std::optional<double> next_due() override;
  Result<std::vector<media::LiveUnit>> take(double now) override;
  void sent(const media::LiveUnit& unit, double instant) override;
  void expect_loss(int percent) override;

  /// What the other party says is heard from now on: the face listens while it speaks, and nods at
  /// its pauses. Null: nothing is heard.
  void hear(std::unique_ptr<OtherVoice> other);

  /// Events up to the last sent frame, in order, since the last call.
  std::vector<LineEvent> take_events();
  /// Ends: unfinished lines are cancelled, with events from take_events().
  void end(const std::string& why);

  /// Traces of the last 1000 lines that began.
  const std::deque<LineTrace>& traces() const;
  /// No line is spoken or queued.
  bool silent() const;
  /// One sentence for every line that could not be shown, since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  explicit LiveSpeaker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
