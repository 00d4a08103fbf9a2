/// @file
/// Tables of curves, whoever wrote them, and the one of Animeme's own.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "dam/signal/signal.h"
#include "fap/result.h"
#include "tools/formats/exchange/imported.h"

namespace animeme::exchange {

/// Any table with a header line: of ARKit's shapes (arkit.h), of landmarks (landmarks.h), else of
/// FAPs (time_s, fap3_open_jaw ..., see dam/corpus/corpus.h). Errors: those of the three readers,
/// and of dam::to_sequence().
Result<Imported> read_any_table(std::string_view text);

/// The header of a table of controls as dam::read_curves() reads it: "time_s,NAME,NAME ..." and a
/// line end.
std::string write_curve_header(std::span<const std::string> names);

/// One of its rows: time in seconds and all values of a frame of `signal`, and a line end.
std::string write_curve_row(const dam::Signal& signal, std::size_t frame);

/// Both, of all frames, with a last column `measured` (0: filled in) if the signal says so.
std::string write_curves(const dam::Signal& signal);

}  // namespace animeme::exchange
