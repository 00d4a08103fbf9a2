/// @file
/// A talking head that is live: lines of text in, face and sound on one clock out.
///
/// The clock never stops. Between lines the face rests (or moves a little, with idle motion) and
/// the sound is silence; a line begins with the next frame that has not been made, and its sound at
/// the sample of that frame, so face and sound agree to the sample. Lines that come while another
/// is spoken follow it. Nothing is made ahead of time but what the sound's encoder needs, so a line
/// is seen and heard as soon as it can be.
///
/// What is spoken can be stopped (line_command.h): with the next frame the mouth begins to close
/// and is at rest within 0.1 s; the sound fades in 20 ms, from the first sample on that its encoder
/// has not been given.
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
#include "tools/speech/talking/talking_face.h"

/// A talking head while it is being made.
namespace animeme::speech {

/// All settings of LiveSpeaker.
struct SpeakerOptions {
  FaceOptions face;          ///< how the face moves
  int fap_quant = 1;         ///< 0..31
  double intra_seconds = 1;  ///< seconds between intra planes
  int voice_rate = 22050;    ///< Hz, of the lines' sound; other rates are converted
  /// How the sound is coded; nothing: the face alone.
  std::optional<media::AudioSettings> audio = media::AudioSettings{};
  double audio_ahead = 0.02;  ///< seconds that sound is sent before its time, 0..1
  double duration = std::numeric_limits<double>::infinity();  ///< seconds, then it is over
  bool events = false;  ///< keep them until LiveSpeaker::take_events()
};

/// What happened to a line and when, on the clock of the lines. Instants that did not come (yet)
/// are 0.
struct LineTrace {
  bool waited = false;     ///< another line was waiting or being spoken when it came
  double arrived = 0;      ///< its last character was read
  double spoken = 0;       ///< the voice was done
  double begun = 0;        ///< its face was begun to be made ...
  double synthesised = 0;  ///< ... and all its frames were there
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
  /// Over when the lines have ended and the last one is spoken, or at the duration.
  std::optional<double> next_due() override;
  Result<std::vector<media::LiveUnit>> take(double now) override;
  void sent(const media::LiveUnit& unit, double instant) override;

  /// What happened up to the last frame that was sent, in order, since the last call.
  std::vector<LineEvent> take_events();
  /// It is over: lines that are not done are cancelled. Events of that come from take_events().
  void end(const std::string& why);

  /// Every line that was begun, the last 1000 of them.
  const std::deque<LineTrace>& traces() const;
  /// Nothing is being said and no line waits: what comes next is idling until a line comes.
  bool silent() const;
  /// One sentence for every line that could not be shown, since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  explicit LiveSpeaker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
