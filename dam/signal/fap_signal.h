/// @file
/// Conversion between control signals and FAP clips.
#pragma once

#include <string>
#include <string_view>

#include "dam/signal/signal.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::dam {

/// "fap3_open_jaw" for 3; `fap` is 1..68.
std::string fap_channel(int fap);

/// FAP number (1..68) of a channel called "fapN" or "fapN_anything", 0 for any other name.
int fap_of_channel(std::string_view name);

/// The FAP channels of a signal (3..68; other names are omitted) as a clip, frame i numbered i. A
/// signal without any, but with ARKit shapes, is converted by fap::arkit_to_fap(). Values are
/// rounded, halves away from zero, and clipped to the range that the standard's default tables can
/// code: default_i_range * quant_step of fap/tables.h. Error: not_found if no channel is a
/// low-level FAP or an ARKit shape; invalid_argument for a value that is not finite or two channels
/// for one FAP.
Result<fap::Sequence> to_sequence(const Signal& signal);

/// All low-level FAPs of the clip, by number. A FAP absent from a frame keeps its last value (0
/// before the first); skipped numbers repeat the previous frame and are marked as not measured.
/// Frames before the first number are filled likewise. Error: out_of_range if the numbers span more
/// than 10 million frames or are negative.
Result<Signal> to_signal(const fap::Sequence& sequence);

}  // namespace animeme::dam
