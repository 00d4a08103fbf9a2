/// @file
/// The results of evaluate(), as plain data. Errors are "synthesised minus recorded"; controls are
/// in their own units (FAP units for FAPs), times in ms, shares 0..1. Definitions:
/// dam/evaluation/README.md, "Measures". Source: dam/lipsync.md, section 8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace animeme::dam {

/// Errors of one control or derived measure over the frames of a region, in its units.
struct SeriesScore {
  std::string name;        ///< of the control or measure
  bool scored = false;     ///< part of the means; FAP 14, 16, 17 ... are reported only
  double rmse = 0;         ///< root mean square error
  double nrmse = 0;        ///< rmse / standard deviation: of the scale for a control, of the
                           ///< recordings in this region for a measure; 0 if that is 0
  double largest = 0;      ///< largest absolute error
  double correlation = 0;  ///< Pearson; 0 if one of the two does not move
  /// Least squares fit from synthesised to recorded, one for all frames of the region; gain >= 0.
  double gain = 0;
  double offset = 0;        ///< of that fit, in the units of the control
  double fitted_nrmse = 0;  ///< rmse of `offset + gain * synthesised` / deviation of the recordings
                            ///< in this region: 0..1, a still face has 1
};

/// All frames of one kind: speech (within 0.2 s of it) or silence (the rest). Only measured frames.
struct RegionScore {
  std::size_t frames = 0;  ///< scored frames of this kind
  double nrmse = 0;        ///< mean over scored controls
  double still_nrmse = 0;  ///< the same for a face that keeps the mean pose of the scale
  /// Mean of SeriesScore::fitted_nrmse over scored controls: the error without differences in size
  /// and rest between speakers.
  double fitted_nrmse = 0;
  double l2 = 0;  ///< mean over frames of the Euclidean norm of the error in standard deviations
  double correlation = 0;             ///< mean over scored controls
  std::vector<SeriesScore> controls;  ///< in the order of the scale
  /// "inner_gap" -(FAP 4 + 5), "width" FAP 6 + 7, "jaw" FAP 3, "corner_height" (FAP 12 + 13) / 2:
  /// those whose FAPs are present.
  std::vector<SeriesScore> measures;
};

/// Mean and standard deviation of times, ms; positive: synthesised later than recorded.
struct TimeSpread {
  std::size_t count = 0;  ///< phones or frames that count
  double mean = 0;        ///< ms
  double sd = 0;          ///< ms
};

/// How long P, B and M of some length keep the lips closed.
struct ClosureDurationScore {
  double from = 0,         ///< seconds: phones at least so long
      to = 0;              ///< and shorter than this; infinity for the longest
  std::size_t phones = 0;  ///< that count
  double measured = 0;     ///< ms: mean time for which the recorded gap is below the threshold
  double predicted = 0;    ///< the same of the synthesised motion
};

/// P, B and M: whether the lips are closed in a frame from 40 ms before to 40 ms after the phone.
/// All zero without FAP 4 and 5.
struct ClosureScore {
  std::size_t phones = 0;                ///< P, B and M in measured frames
  double measured = 0;                   ///< share of them that close in the recording, 0..1
  double predicted = 0;                  ///< the same share of the synthesised motion
  std::size_t false_closures = 0;        ///< runs of frames in speech away from P, B, M and silence
                                         ///< (60 ms), predicted closed and nowhere measured so
  double false_per_minute = 0;           ///< of scored time, as all "per minute"
  std::size_t stray_measured = 0;        ///< other closures: such runs measured closed
  double stray_measured_per_minute = 0;  ///< per minute of scored time
  std::size_t stray_predicted = 0;       ///< other closures: such runs predicted closed
  double stray_predicted_per_minute = 0;  ///< per minute of scored time
  /// When the gap crosses the threshold, interpolated linearly, at most 0.2 s before (onset) or
  /// after (release) its least frame. Of phones that close in both, if both have such an instant.
  TimeSpread onset,  ///< when the gap closes
      release;       ///< when it opens
  /// Below 60 ms, 60 to 100 ms, and longer. From onset to release, both within the 0.2 s, and 0 for
  /// a phone that does not close. Phones after a silence do not count: lips may rest closed.
  std::vector<ClosureDurationScore> durations;
};

/// F and V: the lower lip has to reach the upper teeth, measured by FAP 5 (inner lower lip,
/// upwards).
struct ContactScore {
  std::size_t phones = 0;  ///< F and V in measured frames
  double level = 0;        ///< FAP 5 that counts as contact: median over F and V of the highest
                           ///< recorded value near the phone, minus ScoreOptions::contact_slack
  double measured = 0;     ///< share of phones that reach it, 0..1
  double predicted = 0;    ///< the same share of the synthesised motion
  double difference = 0;   ///< mean difference of the highest values, FAP units
};

/// Rounded sounds (PhoneInfo::rounded): how much narrower the mouth is than on average.
struct RoundingScore {
  std::size_t phones = 0;  ///< rounded phones that count
  double measured = 0;     ///< mean of: recorded mean width in speech - least width, FAP units
  double predicted = 0;    ///< the same of the synthesised motion
  double rmse = 0;         ///< of the least width, FAP units
  double correlation = 0;  ///< of the least widths, over phones
};

/// Lag of the synthesised velocities behind the recorded ones, from their cross-correlation.
struct LagScore {
  std::string name;           ///< phoneme class, or "all"
  std::size_t frames = 0;     ///< recorded frames that were used
  std::optional<double> lag;  ///< ms; nullopt without a peak within +-300 ms
  double correlation = 0;     ///< at the peak, on the grid of frames
};

/// Detectability of a lag, ITU-R BT.1359: the sound may come 45 ms early or 125 ms late.
enum class Sync : std::uint8_t {
  unknown,     ///< no lag could be measured
  in_sync,     ///< not detectable
  face_late,   ///< beyond +45 ms: the sound comes early
  face_early,  ///< beyond -125 ms: the sound comes late
};

/// Synchronisation of face and sound.
struct TimingScore {
  LagScore all;                   ///< over all scored controls
  Sync sync = Sync::unknown;      ///< detectability for viewers
  std::vector<LagScore> classes;  ///< in the order of PhoneClass; only classes with frames
  std::size_t extremes = 0;       ///< extremes of recorded velocity, all scored controls
  double misalignment = 0;        ///< ms: mean absolute timing error of these extremes
  double offset = 0;              ///< ms: their mean timing error; positive: synthesised later
};

/// Synthesised over recorded; 1 is as lively as the recording. 0 if the recording does not move.
struct DynamicsScore {
  std::string name;                 ///< of the control or measure
  bool scored = false;              ///< part of the mean
  double velocity = 0;              ///< ratio of standard deviations
  double acceleration = 0;          ///< likewise
  double jerk = 0;                  ///< likewise, of the third derivative
  double range = 0;                 ///< ratio of the distances from the 5th to the 95th percentile
  double velocity_correlation = 0;  ///< Pearson
};

/// Sums over frames from which means are computed; those of several sentences can be added.
struct ErrorSums {
  std::size_t frames = 0;       ///< scored
  std::vector<double> squared;  ///< per scored control: squared errors in standard deviations
  double l2 = 0;                ///< norms of the error in standard deviations
  double gap_squared = 0;       ///< squared errors of the inner gap, FAP units

  void add(const ErrorSums& other);  ///< adds those of another sentence
  double nrmse() const;     ///< mean over scored controls; this and the next two are 0 if empty
  double mean_l2() const;   ///< mean norm of the error
  double gap_rmse() const;  ///< FAP units, root mean square
};

/// One sentence.
struct UtteranceScore {
  std::string id;              ///< of the utterance
  std::size_t frames = 0;      ///< scored
  double nrmse = 0;            ///< mean over scored controls
  double l2 = 0;               ///< mean norm of the error
  double gap_rmse = 0;         ///< FAP units; 0 without an inner gap
  double gap_correlation = 0;  ///< Pearson, of the inner gap in this sentence
  ErrorSums sums;              ///< from which the means are computed
};

/// Part of the scored frames.
struct GroupScore {
  std::string name;        ///< phone, viseme, "seen" or "unseen"
  std::size_t phones = 0;  ///< occurrences with a scored frame
  std::size_t frames = 0;  ///< scored frames in it
  double nrmse = 0;        ///< mean over scored controls
  double l2 = 0;           ///< mean norm of the error
  double gap_rmse = 0;     ///< FAP units; 0 without an inner gap
};

/// Errors by context. A frame belongs to the phone that is spoken at its time.
struct Breakdown {
  std::vector<GroupScore> phones;   ///< by label, SIL first
  std::vector<GroupScore> visemes;  ///< MPEG-4 viseme "0".."14"; a phone's halves may differ
  /// "seen" and "unseen": phone with both neighbours, or the phone's word, in the training data.
  /// Empty if that is unknown. Silence does not count.
  std::vector<GroupScore> triphones;
  std::vector<GroupScore> words;  ///< likewise, by word
};

/// "in sync", "face late (sound early)" ...
const char* sync_text(Sync sync);

}  // namespace animeme::dam
