/// @file
/// Repairs damaged streams: what can be decoded stays, bit for bit and at its time, and what cannot
/// is left out.
///
///     Result<Repaired> repaired = fba::repair_stream(bytes);
///     for (const Damage& damage : repaired->damage) warn(damage.describe());
///     use(decode(repaired->stream));             // always succeeds
///
/// A plane that cannot be decoded is lost, and so are the predictive planes behind it, up to the
/// next intra plane. The plane before them then skips as many frames as are lost
/// (number_of_frames_to_skip), so that players hold it and everything behind keeps its time.
/// Source: codec/bitstream.md, sections 1 and 2.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "fap/result.h"

namespace animeme::fba {

/// Planes that are lost together.
struct Damage {
  std::int64_t bit = 0;     ///< of the failure, from the start of the stream or of the joined units
  double seconds = 0;       ///< time of the first lost plane, from the start of the stream
  std::int64_t frames = 0;  ///< how many are held in place of them; 0 at the end of a stream
  bool estimated = false;   ///< the number follows from sizes: the planes have no start codes
  std::string reason;       ///< why decoding failed, one sentence without a full stop

  /// "at 1.20 s (bit 3410): REASON; 12 frames are lost".
  std::string describe() const;
  friend bool operator==(const Damage&, const Damage&) = default;
};

/// A stream that decodes without errors.
struct Repaired {
  std::vector<std::uint8_t> stream;  ///< raw, as join_access_units() makes it
  std::vector<Damage> damage;        ///< empty: the stream is the input, unchanged
};

/// Repairs a raw stream. A stream that begins with damage begins with its first intact plane, held.
/// Errors: truncated or syntax (there is no intact intra plane; that of the first failure).
Result<Repaired> repair_stream(std::span<const std::uint8_t> stream);

/// Repairs the units of a container in place: damaged ones leave, the one before lasts until the
/// next intact one. `gaps`: indices of units with lost ones before them, in ascending order. Times
/// of units are known, so nothing is estimated. Units stay as they are if nothing is damaged.
/// Errors: as repair_stream().
Result<std::vector<Damage>> repair_units(AccessUnits& units,
                                         std::span<const std::size_t> gaps = {});

}  // namespace animeme::fba
