/// @file
/// Samples at the rate that the recogniser wants, as they come, by speexdsp. Internal.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::voice {

/// From any rate to kAlignRate, one channel; what the filter delays is taken out at the beginning.
class RateChange {
 public:
  /// 4000 to 384000 Hz. Errors: invalid_argument, unsupported (built without speexdsp).
  static Result<std::unique_ptr<RateChange>> open(int rate);
  virtual ~RateChange() = default;
  /// Appends the samples that are final.
  virtual void push(std::span<const float> samples, std::vector<float>& out) = 0;
};

}  // namespace animeme::voice
