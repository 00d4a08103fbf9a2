/// @file
/// How much a clip moves, and where the bits of its stream go: all of it measured and told.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "tools/inspect/activity.h"
#include "tools/inspect/bits.h"

namespace animeme::inspect {

/// What was measured of one input.
struct Statistics {
  std::string kind;                   ///< what the input was
  std::size_t faces = 0;              ///< frames with a face
  std::size_t bodies = 0;             ///< frames with a body
  fap::Rate rate;                     ///< of the face, or of a body alone
  double seconds = 0;                 ///< of the stream, else of the face, else of the body
  std::optional<BitStatistics> bits;  ///< streams only
  std::vector<Activity> faps;         ///< those that occur
  std::vector<Activity> baps;         ///< those that occur
};

/// Measures a face and a body; both may be empty. `stream` is what they were decoded from, `bytes`
/// its size; 0 bytes: there is none.
Statistics measure(std::string kind, const fap::Sequence& face, const fba::BodySequence& body,
                   const fba::DecodedStream& stream, std::size_t bytes);

/// Everything as JSON text.
std::string statistics_json(const Statistics& statistics);
/// The same for people, with a row for each parameter.
std::string statistics_text(const Statistics& statistics);

}  // namespace animeme::inspect
