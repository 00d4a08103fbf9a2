// What training data look like: the resting mouth, the spread of every control, closed lips.
// Internal to training and evaluation.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dam/corpus.h"
#include "dam/model.h"

namespace animeme::dam {

/// Seconds around the speech that count as speech in statistics and scores.
inline constexpr double kSpeechMargin = 0.2;

/// False for frames that the signal marks as interpolated.
inline bool is_measured(const Signal& signal, std::size_t frame) {
  return frame >= signal.measured.size() || signal.measured[frame];
}

/// Per frame: within kSpeechMargin of speech and measured.
std::vector<bool> speech_frames(const Utterance& utterance);

/// Names, mean and deviation over the speech, rest over the silences further than `pause_edge` from
/// it (with closed lips; the mean of the speech if there is no silence). All sentences must have
/// the controls of the first. Interpolated frames do not count.
std::vector<Control> control_statistics(std::span<const Utterance* const> sentences,
                                        double pause_edge);

/// Median over all P, B and M of the least measured inner gap near the phone, in FAP units, between
/// 0 and 25; 25 if there are no lip FAPs or fewer than five such phones. Source: lipsync,
/// section 5.6.
double measured_closure_gap(std::span<const Utterance* const> sentences);

/// Median over all F and V of the highest measured place of the inner lower lip (FAP 5) near the
/// phone; none with fewer than five such phones or without lip FAPs.
std::optional<double> measured_lip_tooth_raise(std::span<const Utterance* const> sentences);

}  // namespace animeme::dam
