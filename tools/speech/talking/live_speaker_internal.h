// What a LiveSpeaker is made of.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/speech/talking/face_coding_internal.h"
#include "tools/speech/talking/line_events.h"
#include "tools/speech/talking/line_traces_internal.h"
#include "tools/speech/talking/live_sound.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::speech {

struct LiveSpeaker::Impl {
  SpeakerOptions options;
  LineSource* lines;
  media::Clock* clock;
  TalkingFace face;
  std::optional<LiveSound> sound;
  fba::LiveEncoder encoder;
  media::LiveInfo info;
  std::int64_t frame_ticks = 1;
  WaitingSound waiting_sound;

  struct Waiting {
    SpokenLine line;
    bool waited = false;  // LineTrace::waited
  };
  std::optional<Waiting> waiting;
  std::int64_t sound_end = 0;  // sample after the last line's sound
  double silent_since = -1;    // instant of the clock; -1: nothing was spoken yet
  double face_rests = 0;       // presentation time at which the last line's motion is over
  /// Speech that was halted.
  struct Held {
    dam::Script script;          // what is left to say
    std::vector<float> samples;  // its sound
    double at = 0;               // presentation time of its begin, had it gone on
    std::int64_t length = 0;     // samples up to the end of the line
  };
  bool paused = false;
  std::optional<Held> held;
  std::optional<dam::Mood> mood;  // of the line that began last
  double settled = 0;             // presentation time at which a mouth that was cut off is at rest
  LineEvents events;
  LineTraces traces;
  std::unique_ptr<OtherVoice> other;  // null: nobody is heard
  std::vector<std::string> warnings;

  double frame_due() const { return double(face.number() * frame_ticks) / info.timescale; }
  double sound_due() const {
    if (!sound) return std::numeric_limits<double>::infinity();
    return double(sound->next_time()) / info.audio->sample_rate - options.audio_ahead;
  }
  // Instant before which sound has been made.
  double sound_made() const { return sound ? double(sound->made()) / options.voice_rate : 0; }

  double end_of_speech() const;
  void collect(double now);
  void take_line();
  void follow(const LineNews& news, double time);
  void stop(const LineNews& news, double time);
  void pause();
  void fall_silent(double at);
  bool goes_on();
  Result<void> convert(media::Pcm& audio) const;
  std::int64_t lay(std::int64_t start, SpokenLine& line);
  std::int64_t place_after_the_last() const;
  bool has_to_wait(const SpokenLine& line) const;
  void begin_lines(double now);
  Result<void> begin(SpokenLine& line, LineTrace& trace);
  void listen();
  void cancel(const SpokenLine& line, const std::string& why);
  Result<media::LiveUnit> make_plane();
  Result<media::LiveUnit> make_packet();
};

}  // namespace animeme::speech
