/// @file
/// Sound files in and out.
///
///     Result<Pcm> voice = read_audio("voice.mp3", {.sample_rate = 16000});
///     if (!voice) return voice.error();
///     Result<void> written = write_wav("voice.wav", *voice);
///
/// Safe for untrusted input: no other file or address than the given one is opened, and memory
/// and time stay bounded. Not for several threads on one object; different calls may run in
/// different threads. Source: tools/formats/media/containers.md, section 5.4.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::media {

/// What read_audio() makes of a file, and where it stops.
struct ReadAudioOptions {
  int sample_rate = 0;  ///< Hz of the result, 1000..384000; 0: the file's own rate
  /// Longer sound is refused. Whatever is set here, 2^29 samples (3.1 hours at 48 kHz, 2 GiB)
  /// are the end of what read_audio() gives.
  double max_seconds = 3 * 3600.0;
  /// Receives one sentence for everything odd (damaged packets, early end); nullptr: not wanted.
  std::vector<std::string>* warnings = nullptr;
};

/// Reads the best audio track of any file that FFmpeg knows, or of a playlist (see container.h),
/// and mixes it down to one channel.
/// Sample 0 is the first sample that a player would play: encoder delay is skipped where the file
/// tells it (mp4, mkv, ogg, mp3; raw ADTS .aac does not: 1024 samples too many). Padding at the
/// end of an mp4 or m4a is cut at the duration that the file states. Gaps between the time stamps
/// inside the sound become silence. A damaged packet is skipped with a warning.
/// Errors: not_found (no file, no audio track), io, syntax (no media file, or nothing in it can be
/// decoded), unsupported (unknown codec), out_of_range (too long, absurd sample rate, memory),
/// invalid_argument (options).
Result<Pcm> read_audio(const std::string& path, const ReadAudioOptions& options = {});

/// The same from memory.
Result<Pcm> read_audio(std::span<const std::uint8_t> file, const ReadAudioOptions& options = {});

/// The same sound block by block, for what is made of it meanwhile: memory does not grow with its
/// length. Movable, not copyable.
class AudioReader {
 public:
  /// Opens the file and decodes the begin of its sound. Errors: those of read_audio().
  static Result<AudioReader> open(const std::string& path, const ReadAudioOptions& options = {});
  /// From memory, which has to outlive the reader.
  static Result<AudioReader> open(std::span<const std::uint8_t> file,
                                  const ReadAudioOptions& options = {});
  AudioReader(AudioReader&&) noexcept;  ///< movable
  AudioReader& operator=(AudioReader&&) noexcept;
  ~AudioReader();

  int sample_rate() const;  ///< Hz, of the samples that come out
  /// Length as the file tells it, seconds, for progress; 0: it does not.
  double told_seconds() const;
  /// The next samples, one or more, valid until the next call; empty: there are no more. Errors:
  /// those of read_audio() that show later than at the begin.
  Result<std::span<const float>> next();

 private:
  struct Impl;
  explicit AudioReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Converts to another rate, sample 0 stays at time 0, the length is rounded to the nearest
/// sample. Errors: invalid_argument (a rate outside 1000..384000), out_of_range (memory).
Result<Pcm> resample(const Pcm& pcm, int sample_rate);

/// Writes a 16-bit WAV file, whole or not at all. Values outside +-1 are clipped, NaN is 0.
/// Errors: invalid_argument (sample rate not positive), out_of_range (over 4 GB), io.
Result<void> write_wav(const std::string& path, const Pcm& pcm);

}  // namespace animeme::media
