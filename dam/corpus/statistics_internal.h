// What training data look like: the resting mouth, the spread of every control, closed lips.
// Internal to training and evaluation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/signal/closure.h"

namespace animeme::dam {

/// Seconds around the speech that count as speech in statistics and scores.
inline constexpr double kSpeechMargin = 0.2;

/// False for frames that the signal marks as interpolated.
inline bool is_measured(const Signal& signal, std::size_t frame) {
  return frame >= signal.measured.size() || signal.measured[frame];
}

/// Per frame: within kSpeechMargin of speech and measured.
std::vector<bool> speech_frames(const Utterance& utterance);

/// What a frame shows: the speaking mouth, the resting mouth (further than `pause_edge` from the
/// speech), or neither (also where nothing was measured).
enum class FramePlace : std::uint8_t { neither, speech, rest };
std::vector<FramePlace> frame_places(const Utterance& utterance, double pause_edge);

/// Corrects moments over the speech: a deviation without motion becomes 0, rest gets closed lips
/// (some silences are breaths and smiles, so the mean of all would have the lips a little apart).
void settle_controls(std::vector<Control>& controls);

/// Estimated limits of a control without natural limits: 0..1 if none of its values in
/// the data, which are from `low` to `high`, is out of that, it is no FAP and it moves; else
/// `limit` as it is.
ControlLimit limit_of_data(const ControlLimit& limit, const Control& control, double low,
                           double high);

/// Limits of the controls of sentences: by name, or by limit_of_data(). Pairs undo each other only
/// if they do in the data: some trackers let both of a pair stand above 0 all the time.
std::vector<ControlLimit> control_limits(std::span<const Utterance* const> sentences,
                                         std::span<const Control> controls);

/// Names, mean and deviation over the speech, rest over the silences further than `pause_edge` from
/// it (with closed lips; the mean of the speech if there is no silence). All sentences must have
/// the controls of the first. Interpolated frames do not count.
std::vector<Control> control_statistics(std::span<const Utterance* const> sentences,
                                        double pause_edge);

/// The least measured inner gap near each P, B and M of a sentence, and the least -FAP 5 near each
/// F and V. Nothing without lip FAPs.
void add_closures(const Utterance& utterance, std::vector<double>& gaps);
void add_lip_tooth_contacts(const Utterance& utterance, std::vector<double>& lows);
/// Fewer contacts are not used.
inline constexpr std::size_t kFewContacts = 5;
/// Model::closure_gap for the median gap, none: not known.
double closure_gap_of(std::optional<double> median);

/// Median over all P, B and M of the least measured inner gap near the phone, in FAP units, between
/// 0 and 25; 25 if there are no lip FAPs or fewer than five such phones. Source: dam/lipsync.md,
/// section 6.
double measured_closure_gap(std::span<const Utterance* const> sentences);

/// Sums for ClosureDuration over P, B and M that do not follow a silence and shut the lips: seconds
/// of the phone and of the closure.
struct ShutSums {
  double count = 0, phone = 0, shut = 0, phone_squared = 0, both = 0;

  void add(const Utterance& utterance);
  void add(const ShutSums& other);
  /// The straight line through them; none with fewer than kFewContacts.
  std::optional<ClosureDuration> line() const;
};
std::optional<ClosureDuration> measured_closure_duration(
    std::span<const Utterance* const> sentences);

/// Median over all F and V of the highest measured place of the inner lower lip (FAP 5) near the
/// phone; none with fewer than five such phones or without lip FAPs.
std::optional<double> measured_lip_tooth_raise(std::span<const Utterance* const> sentences);

}  // namespace animeme::dam
