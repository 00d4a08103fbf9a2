/// @file
/// Checks whether old players read a FAP text correctly.
///
///     for (const std::string& problem : player_problems(text)) puts(problem.c_str());
///
/// read_text() accepts almost anything; existing players do not. Measured with three of them (Greta
/// in C++, Xface 1.0, Greta in Java): fap/text_format.md, section 3.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::fap {

/// What player_problems() tolerates.
struct PlayerOptions {
  bool high_level = false;  ///< the player shows FAP 1 and 2; with others they stay a problem
};

/// Problems for some player, one line per kind in the order of the text: "line 12: the frame has
/// number 14 and is the 6th, Xface takes the number as an index and crashes (and in 3 more
/// places)". Empty: all three read it correctly. Checks for:
///
/// - a header that is not "version name rate frames", with a whole rate, a name below 255 bytes and
///   the true frame count; other kinds of text; comments, blank lines, no newline at the end;
/// - frames that are not two lines: 68 flags, then the number and one whole number per value;
/// - numbers other than 0, 1, 2 ...;
/// - a FAP without its other side, and one that was present before: players then show it at rest or
///   keep it, each in its own way;
/// - FAP 1 and 2 (unless high_level), and these combined with low-level FAPs.
///
/// Linear in the text; safe for untrusted input.
std::vector<std::string> player_problems(std::string_view text, const PlayerOptions& options = {});

}  // namespace animeme::fap
