// Which parameters of a clip are coded, at which quantiser, with which levels. Not installed API.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/encode/clip_internal.h"
#include "codec/encode/encode.h"

namespace animeme::fba::internal {

enum class Role : std::uint8_t {
  coded,
  mirrored,  // the right side of a pair, taken from its left side by the decoder
  left_out,  // stays at 0
};

/// What becomes of one channel.
struct Row {
  Role role = Role::coded;
  bool stilled = false;              // moves in the clip and not here
  std::vector<std::int32_t> levels;  // of the reconstruction: value / step
};

struct Decision {
  int fap_quant = 1;
  int bap_quant = 1;
  std::vector<Row> rows;  // one for each channel of the clip

  int quant(const Channel& channel) const { return channel.body ? bap_quant : fap_quant; }
};

/// The decision that `options` ask for. `bit_budget`: bits for the parameters of the whole clip
/// (without headers), 0: any number.
Decision decide(const ClipData& clip, const EncodeOptions& options, double bit_budget);

}  // namespace animeme::fba::internal
