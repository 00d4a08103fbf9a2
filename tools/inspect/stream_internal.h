/// @file
/// What motion holds, as JSON and as text: clips, bodies, streams and their planes.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"

namespace animeme::inspect {

/// Frames, rate, and the range of values of each parameter.
nlohmann::ordered_json describe_clip(const fap::Sequence& clip);
nlohmann::ordered_json describe_body(const fba::BodySequence& body);  ///< the same of a body

/// A whole stream of `bytes` bytes, without its planes.
nlohmann::ordered_json describe_stream(const fba::DecodedStream& stream, std::size_t bytes);

/// All that the planes say but their values; an array. Ranges are in levels at quantiser 1, in
/// the order of the parameters named.
nlohmann::ordered_json describe_planes(const fba::DecodedStream& stream);

/// The same as a table, one line a plane. Ranges are the widest of all parameters.
std::string planes_text(const fba::DecodedStream& stream);

}  // namespace animeme::inspect
