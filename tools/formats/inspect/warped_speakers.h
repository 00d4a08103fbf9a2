/// @file
/// Speakers who do not exist: a corpus of one speaker with another face, other habits and another
/// pace, to measure how a model does with strangers.
///
///     const auto habits = inspect::warped_habits(8);
///     const auto sentences = inspect::warp(corpus.utterances, habits[0]);
///
/// Recordings of one speaker are changed as speakers differ: rest (an open mouth in silence), size
/// and curvature of the motion of each articulator, the targets of the phones and of their contexts
/// (some open IY wider than AA), which side of the mouth moves more, when the lips move relative to
/// the jaw, the durations of the phones, and motion that follows no phone. Lips that meet in the
/// recording meet in the copy. All of it is deterministic: the same habits and sentences give the
/// same copies on any machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "fap/result.h"

namespace animeme::inspect {

/// The articulators that habits distinguish, by FAP: jaw 3; lips 4, 5, 8 to 11, 51, 52, 55 to 58;
/// width 6, 7, 53, 54; corners (their height) 12, 13, 59, 60; forward 14 to 17. All others are
/// copied.
enum class Articulator : std::uint8_t { jaw, lips, width, corners, forward };
inline constexpr std::size_t kArticulators = 5;  ///< values of Articulator

/// How a speaker differs from the recorded one.
struct SpeakerHabits {
  std::string name;      ///< of the speaker; the name also seeds what is random
  double jaw_rest = 0;   ///< FAP 3 in silence, FAP units above the recorded one
  double gap_rest = 0;   ///< inner gap in silence, likewise
  double jaw_level = 0;  ///< FAP 3 in speech and silence, likewise: the tracker's neutral face
  std::array<double, kArticulators> range = {1, 1, 1, 1, 1};  ///< factor of the motion
  double bend = 1;       ///< exponent of the motion in deviations: below 1 small motion is larger
  double habits = 0;     ///< targets of phones: deviation in deviations of the recorded motion
  double contexts = 0;   ///< the same for pairs of neighbouring phones
  bool wide_iy = false;  ///< IY, S and Z open the lips wider than AA does
  double asymmetry = 0;  ///< -1..1: the left side moves by 1 + this, the right side by 1 - this
  double lips_late = 0;  ///< seconds by which the lips follow the jaw; below 0: they lead
  double pace = 1;       ///< factor of all durations
  double vowels = 1;     ///< factor of the durations of vowels
  double uneven = 0;     ///< deviation of the logarithm of the factor of each phone
  double noise = 0;      ///< motion that follows no phone, in deviations of the recorded motion
  double posture = 0;    ///< constant of a sentence, likewise
};

/// `count` speakers. The first have a jaw that rests at 200, a gap that rests at 450 and IY wider
/// than AA; the others are drawn. Always the same for the same count or a larger one.
std::vector<SpeakerHabits> warped_habits(std::size_t count);

/// The sentences as that speaker says them, with the same ids and words and other durations.
/// Deviations are those of the given sentences' speech, so warp all sentences of a speaker in one
/// call. Errors: invalid_argument (no sentence; sentences with different controls; none of the FAPs
/// of Articulator).
Result<std::vector<dam::Utterance>> warp(std::span<const dam::Utterance> sentences,
                                         const SpeakerHabits& habits);

}  // namespace animeme::inspect
