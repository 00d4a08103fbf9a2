/// @file
/// The voice of the other party of a conversation: when it speaks and when it pauses, by the level
/// of its sound alone. What `animeme stream --hear` listens with.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "fap/result.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/speech/talking/sound_pipe.h"

namespace animeme::speech {

/// Tells speech from pauses in a sound, sample by sample.
///
/// Speech is what lasts for 50 ms at a level well above the noise, which is followed: steady noise
/// of any level is no speech after some seconds. A pause is 0.2 s without speech; shorter gaps, as
/// of stops between vowels, belong to the speech.
class VoiceActivity {
 public:
  /// Samples a second, > 0.
  explicit VoiceActivity(int sample_rate);
  /// The next samples, full scale +-1.
  void push(std::span<const float> samples);
  /// Whether there was speech at the last sample.
  bool speaking() const { return speaking_; }

 private:
  void add_block(double mean_square);

  double rate_;
  double last_in_ = 0, last_out_ = 0;  // of the filter that takes away hum and offsets
  double sum_ = 0;                     // of squares, in this block
  double left_;                        // samples to the end of this block
  double noise_;                       // dB
  double seconds_ = 0;
  double loud_ = 0, quiet_ = 0;  // seconds, in a row
  bool speaking_ = false;
};

/// Listens to a sound while time passes. Use from one thread.
class OtherVoice {
 public:
  /// Samples of `rate` from any feed. `in_time`: they come as time passes; false: they wait until
  /// it is their time, as those of a file.
  OtherVoice(std::unique_ptr<SoundFeed> feed, int rate, bool in_time);
  /// A file, a named pipe or a device, "-": standard input; WAV, or `bare` samples. Neither waits
  /// for a writer nor for sound. What a pipe has before the first call of at() is not heard, and a
  /// named pipe may have one writer after the other. Errors: not_found, io (it cannot be opened).
  static Result<std::unique_ptr<OtherVoice>> open(const std::string& path,
                                                  std::optional<BareSound> bare);
  ~OtherVoice();
  OtherVoice(const OtherVoice&) = delete;
  OtherVoice& operator=(const OtherVoice&) = delete;

  /// Whether the other one speaks at a time, in seconds from any instant on; times ascend. Does not
  /// wait. Sound that has ended, or that does not come for 0.2 s, is a pause.
  bool at(double seconds);
  /// An error of the sound, once: it is not WAV, cannot be read any more.
  std::optional<Error> take_error();

 private:
  struct Impl;
  explicit OtherVoice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
