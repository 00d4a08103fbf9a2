/// @file
/// Tables of curves from other programs, and Animeme's own format.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "dam/signal/signal.h"
#include "fap/result.h"
#include "tools/formats/exchange/imported.h"

namespace animeme::exchange {

/// Reads any table with a header line: of ARKit shapes (arkit.h), of landmarks (landmarks.h), or
/// else of FAPs (time_s, fap3_open_jaw ..., see dam/corpus/corpus.h). Errors: those of the three
/// readers, and of dam::to_sequence().
Result<Imported> read_any_table(std::string_view text);

/// The header of a table of controls for dam::read_curves(): "time_s,NAME,NAME ..." and a line end.
std::string write_curve_header(std::span<const std::string> names);

/// A row: time in seconds, all values of a frame of `signal`, and a line end.
std::string write_curve_row(const dam::Signal& signal, std::size_t frame);

/// The complete table, with a last column `measured` (0: filled in) if the signal has it.
std::string write_curves(const dam::Signal& signal);

}  // namespace animeme::exchange
