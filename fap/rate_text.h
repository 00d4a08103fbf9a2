/// @file
/// Frame rates as people write them: "25", "12.5", "29.97", "30000/1001".
#pragma once

#include <string>
#include <string_view>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::fap {

/// Reads frames per second as an exact fraction in lowest terms.
///
/// - "25" is 25/1, "12.5" is 25/2, "30000/1001" is 30000/1001.
/// - 14.985, 23.976, 23.98, 29.97, 47.952, 47.95, 59.94 and 119.88 (also with more decimals, as
///   far as they are right) are the NTSC rates 15000/1001, 24000/1001 and so on.
/// - Seven to nine decimals are the simplest fraction that rounds to them, so 0.3333333 is 1/3.
///   Fewer decimals are taken literally: 33.33 is 3333/100.
///
/// No spaces, signs or exponents. Errors: Code::syntax if `text` is not such a number (including
/// more than nine decimals), Code::out_of_range if a part of the fraction does not fit 32 bits. "0"
/// is read and gives the invalid rate 0/1: the caller knows what an absent rate means.
Result<Rate> parse_rate(std::string_view text);

/// The shortest text that parse_rate() reads back as the same rate: an integer or decimal number,
/// or "num/den" for odd fractions with large denominators. An invalid rate gives "0". The rate must
/// be in lowest terms, as from make_rate().
std::string format_rate(Rate rate);

}  // namespace animeme::fap
