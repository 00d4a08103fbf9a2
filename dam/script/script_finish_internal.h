// What is done with the labels of every format: marks, speakers, words that overlap, units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script_text_internal.h"
#include "dam/script/timings.h"

namespace animeme::dam {

/// Counts one more of a kind; the first of it gives message and line.
void add_note(std::vector<ScriptNote>& notes, ScriptNote::Kind kind, std::string_view message,
              std::int64_t line);

/// The note about a mark.
void note_mark(std::vector<ScriptNote>& notes, std::string_view mark, std::int64_t line);

/// The note about bytes that are not UTF-8, if there are any.
void note_odd_bytes(std::vector<ScriptNote>& notes, const OddBytes& odd);

/// What a format says about its times.
enum class TimeUnit : std::uint8_t {
  assumed,  ///< its numbers are seconds if nothing speaks against it
  known,    ///< its header, its syntax or its names say the unit
};

/// Most of one label, in bytes: an hour of speech.
inline constexpr std::size_t kMostOfLabel = 100'000;

/// Error: out_of_range (more than kMostOfLabel), at the line.
Result<void> check_size(std::size_t bytes, std::int64_t line);

/// Keeps the speaker of the options, takes marks for silence, leaves out labels that take no time,
/// sorts words and ends them where the next begin, divides times of an assumed unit by the rate of
/// the options or finds that they are milliseconds.
/// Errors: out_of_range (a label of more than kMostOfLabel), not_found (no such speaker; the
/// message names those of the file).
Result<void> finish_labels(Timings& timings, const ScriptOptions& options, TimeUnit unit);

}  // namespace animeme::dam
