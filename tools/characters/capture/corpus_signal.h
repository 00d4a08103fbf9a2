/// @file
/// Curves of a corpus: on the clock of the sound, at one rate, with the same names.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/result.h"
#include "tools/characters/capture/read_capture.h"

namespace animeme::tools {

/// The curves of a face from second 0 of its sound: number 0 of the clip is `start` seconds behind
/// it. `seconds` long; frames before the first and behind the last are held and not measured, 0:
/// as long as the clip. Errors: those of dam::to_signal(); not_found (nothing of it is within).
Result<dam::Signal> curves_of(const CapturedFace& face, double start, double seconds);

/// Straight lines between the frames, at another rate.
dam::Signal at_rate(const dam::Signal& signal, fap::Rate rate);

/// Frames that were measured.
std::size_t measured_frames(const dam::Signal& signal);

/// The controls that all have, in the order of the first; the others are taken out.
std::vector<std::string> keep_common_controls(std::vector<dam::Signal*>& signals);

/// Silence behind a script that ends before `seconds`.
void extend_with_silence(dam::Script& script, double seconds);

}  // namespace animeme::tools
