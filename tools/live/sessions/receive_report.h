/// @file
/// Report on a reception: received and lost data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/formats/media/live/recorder.h"

namespace animeme::live {

/// Share of usable planes of the intra intervals, one interval at least.
struct IntervalShares {
  double mean = 1,         ///< over all intervals
      least = 1;           ///< of the worst
  std::size_t spoilt = 0;  ///< intervals with a missing plane
};
/// nullopt: there are no intervals.
std::optional<IntervalShares> shares_of(const std::vector<media::IntraInterval>& intervals);

/// "5 s: 125 planes, 0 lost, ..." for --stats.
std::string receive_line(double seconds, const media::Recorder& recorder,
                         const media::ReceiveStats& stats);

/// Anomalies, one sentence per line: restarted senders, foreign datagrams, packets so late that an
/// option helps. Usually empty.
std::string receive_advice(const media::ReceiveStats& stats);

/// The summary, one sentence per line, without figures for what was not received. Empty: nothing
/// was received.
std::string receive_summary(const media::Recorder& recorder, const media::ReceiveStats& stats,
                            const std::vector<media::IntraInterval>& intervals);
/// The same as JSON text, with a row for every interval. Shares without a plane or an interval are
/// null.
std::string receive_json(const media::Recorder& recorder, const media::ReceiveStats& stats,
                         const std::vector<media::IntraInterval>& intervals);

}  // namespace animeme::live
