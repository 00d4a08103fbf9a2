/// @file
/// A stream decoded to the end, errors included: what the codec makes of a case.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/text/bap_text.h"
#include "conformance/case_file.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::conformance {

/// Everything that could be decoded, and all errors on the way.
struct Trial {
  fba::DecodedStream stream;  ///< planes, warnings, headers
  std::vector<Error> errors;  ///< in the order of the stream
};
/// Never fails: what cannot be decoded is an error in the result.
Trial decode_all(std::span<const std::uint8_t> bytes);

/// The name of an error's kind in case.json: "syntax", "truncated", "unsupported", "out_of_range".
std::string kind_of_error(Code code);

/// Sets the switches of the encoder that wrote a stream: which planes have start codes, and which.
void set_switches(std::span<const std::uint8_t> bytes, const fba::DecodedStream& decoded,
                  Case& info);

/// Writes a stream again from the parameters of a case and its sources. Either source may be
/// empty. Errors: those of the readers and the encoder.
Result<std::vector<std::uint8_t>> encode_again(const Case& info, std::string_view parameters,
                                               std::string_view source_face,
                                               std::string_view source_body);

}  // namespace animeme::conformance
