/// @file
/// In-band FEC of Opus by what receivers report: the loss that an encoder of sound should expect.
///
///     ExpectedLoss expected;
///     while (...) expected.follow(sink.stats(), clock.now(), input);
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/formats/media/live/presentation.h"

namespace animeme::media {

/// AudioSettings::expected_loss as users write it: "auto" is AudioSettings::kLossByReports, else
/// percent, 0..50. Errors: invalid_argument.
Result<int> parse_expected_loss(const std::string& text);

/// Follows the reports of one presentation. A report counts about five seconds and its share
/// scatters, so the loss goes in steps; it rises with the first report, and falls when no report
/// has asked for as much for 30 s.
class ExpectedLoss {
 public:
  static constexpr int kMost = 30;  ///< percent; beyond that speech would get too few bits

  /// Percent of the packets, 0 or 2..kMost: SendStats::sound_loss of the newest reports, rounded up
  /// to a step; below 0.5 % it is 0. `now`: monotonic seconds.
  int percent(double loss, double now);
  /// Tells `input` of a change. Takes no time: call it as often as reports may come.
  void follow(const SendStats& stats, double now, LiveInput& input);

 private:
  int percent_ = 0;
  int told_ = 0;
  int below_ = 0;            // the most that was asked for since then
  double asked_for_it_ = 0;  // instant of the last report that asked for percent_
};

}  // namespace animeme::media
