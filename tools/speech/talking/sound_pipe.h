/// @file
/// Sources of live audio samples.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/sound_bytes.h"

namespace animeme::speech {

/// A feed of samples. Use from one thread.
class SoundFeed {
 public:
  virtual ~SoundFeed() = default;
  /// Up to `most` available samples, full scale +-1. Does not wait.
  virtual std::vector<float> take(std::size_t most) = 0;
  /// Nothing more will come.
  virtual bool over() = 0;
  /// Samples that are there and were not taken.
  virtual std::size_t waiting() { return 0; }
  /// Drops what has come so far, also what has been sent and not been read.
  virtual void discard() {}
  /// An error, returned once.
  virtual std::optional<Error> take_error() { return std::nullopt; }
};

/// Samples from a descriptor, read in a separate thread. Buffers half a second; the rest waits in
/// the pipe.
class SoundPipe : public SoundFeed {
 public:
  /// The descriptor is borrowed. `bare`: as SoundBytes.
  SoundPipe(int descriptor, std::optional<BareSound> bare);
  ~SoundPipe() override;
  /// Waits for the sample rate; 0: there are no samples. Errors: those of SoundBytes.
  Result<int> wait_for_rate();
  /// The sample rate if it is known by now; 0: not yet. Does not wait.
  int rate_so_far();

  std::vector<float> take(std::size_t most) override;
  bool over() override;
  std::size_t waiting() override;
  void discard() override;
  std::optional<Error> take_error() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
