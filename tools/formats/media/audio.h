/// @file
/// Reading and writing sound files.
///
///     Result<Pcm> voice = read_audio("voice.mp3", {.sample_rate = 16000});
///     if (!voice) return voice.error();
///     Result<void> written = write_wav("voice.wav", *voice);
///
/// Safe for untrusted input: no other file or address than the given one is opened, and memory and
/// time stay bounded. Use an object from one thread at a time; separate calls may run in separate
/// threads. Source: tools/formats/media/containers.md, section 5.4.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::media {

/// Output rate and limits of read_audio().
struct ReadAudioOptions {
  int sample_rate = 0;  ///< Hz of the result, 1000..384000; 0: the file's own rate
  /// Longer sound is rejected. Regardless of this, read_audio() returns at most 2^29 samples (3.1
  /// hours at 48 kHz, 2 GiB).
  double max_seconds = 3 * 3600.0;
  /// Receives one sentence for each anomaly (damaged packets, early end); nullptr: none.
  std::vector<std::string>* warnings = nullptr;
  /// AudioReader: 2 leaves sound of two channels as it is, and mixes that of more to two; 1 mixes
  /// all to one, as read_audio() always does.
  int most_channels = 1;
};

/// Reads the best audio track of any file that FFmpeg supports, or of a playlist (see container.h),
/// and mixes it down to one channel (of two opposite ones, whose mean is silence, the left one is
/// taken). Sample 0 is the first sample that a player would play: encoder
/// delay is skipped if the file states it (mp4, mkv, ogg, mp3; raw ADTS .aac does not and gives
/// 1024 samples too many). Padding at the end of an mp4 or m4a is cut at the duration that the file
/// states. Gaps between the timestamps become silence. A damaged packet is skipped with a warning.
/// Errors: not_found (no file, no audio track), io, syntax (not a media file, or nothing in it can
/// be decoded), unsupported (unknown codec), out_of_range (too long, absurd sample rate, memory),
/// invalid_argument (options).
Result<Pcm> read_audio(const std::string& path, const ReadAudioOptions& options = {});

/// The same from memory.
Result<Pcm> read_audio(std::span<const std::uint8_t> file, const ReadAudioOptions& options = {});

/// Reads the same sound block by block, so that memory does not grow with its length. Movable, not
/// copyable.
class AudioReader {
 public:
  /// Opens the file and decodes the beginning of its sound. Errors: those of read_audio().
  static Result<AudioReader> open(const std::string& path, const ReadAudioOptions& options = {});
  /// From memory, which must outlive the reader.
  static Result<AudioReader> open(std::span<const std::uint8_t> file,
                                  const ReadAudioOptions& options = {});
  AudioReader(AudioReader&&) noexcept;  ///< movable
  AudioReader& operator=(AudioReader&&) noexcept;
  ~AudioReader();

  int sample_rate() const;  ///< Hz, of the returned samples
  int channels() const;     ///< of the returned samples: 1 or 2
  /// Length in seconds as stated by the file, for progress; 0: not stated.
  double told_seconds() const;
  /// The next samples, one or more, valid until the next call; empty at the end. Of two channels
  /// they come in pairs, left and right. Errors: those of read_audio() that occur after the
  /// beginning.
  Result<std::span<const float>> next();

 private:
  struct Impl;
  explicit AudioReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Converts to another rate. Sample 0 stays at time 0; the length is rounded to the nearest sample.
/// Errors: invalid_argument (a rate outside 1000..384000), out_of_range (memory).
Result<Pcm> resample(const Pcm& pcm, int sample_rate);

/// Writes a 16-bit WAV file piece by piece, to a place of its own: not whole or not at all.
///
///     auto file = WavWriter::open(path, 22050);
///     file->write(samples);
///     file->finish();
class WavWriter {
 public:
  /// Errors: invalid_argument (sample rate not positive), io.
  static Result<WavWriter> open(const std::string& path, int sample_rate);
  WavWriter(WavWriter&&) noexcept;  ///< movable
  WavWriter& operator=(WavWriter&&) noexcept;
  ~WavWriter();

  /// One channel; values as in write_wav(). Errors: out_of_range (over 4 GB), io.
  Result<void> write(std::span<const float> samples);
  /// Completes the header and closes the file. Errors: io.
  Result<void> finish();

 private:
  struct Impl;
  explicit WavWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Writes a 16-bit WAV file, whole or not at all. Values outside +-1 are clipped, NaN is 0.
/// Errors: invalid_argument (sample rate not positive), out_of_range (over 4 GB), io.
Result<void> write_wav(const std::string& path, const Pcm& pcm);

}  // namespace animeme::media
