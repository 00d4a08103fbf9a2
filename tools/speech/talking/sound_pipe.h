/// @file
/// Where the samples of a live voice come from.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/sound_bytes.h"

namespace animeme::speech {

/// Samples as they come. To be used from one thread.
class SoundFeed {
 public:
  virtual ~SoundFeed() = default;
  /// At most `most` samples, full scale +-1; none if none are there. Does not wait.
  virtual std::vector<float> take(std::size_t most) = 0;
  /// Nothing more will come.
  virtual bool over() = 0;
  /// What went wrong, once.
  virtual std::optional<Error> take_error() { return std::nullopt; }
};

/// Samples from a descriptor, read in a thread of its own. What is not taken waits: half a second
/// of it here, the rest in the pipe.
class SoundPipe : public SoundFeed {
 public:
  /// The descriptor is borrowed. `bare`: as SoundBytes.
  SoundPipe(int descriptor, std::optional<BareSound> bare);
  ~SoundPipe() override;
  /// The rate of the samples, once it is known; 0: there are none. Errors: those of SoundBytes.
  Result<int> wait_for_rate();

  std::vector<float> take(std::size_t most) override;
  bool over() override;
  std::optional<Error> take_error() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::speech
