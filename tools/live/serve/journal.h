/// @file
/// What happens in a server of heads: log lines, counts and histograms.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "tools/formats/common/json.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/speech/talking/line_events.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::serve {

/// Receives each log entry: an object with "kind" ("request", "head", "line") and what belongs to
/// it. Called from several threads, one at a time; it must not block.
using Log = std::function<void(const tools::Json&)>;

/// Thread safe. Texts that are spoken and tokens are not logged.
class Journal {
 public:
  /// `log` may be empty.
  explicit Journal(Log log) : log_(std::move(log)) {}

  /// A request was answered.
  void request(const std::string& method, const std::string& path, unsigned status, double seconds);
  /// A head was made or has ended: `what`.
  void head(const std::string& name, const std::string& what);
  /// An event of a line of a head; words and phones are ignored.
  void line(const std::string& head, const speech::LineEvent& event);
  /// Time stamps of a line whose face and sound have been sent.
  void latency(const speech::LineTrace& trace);
  /// Counts and histograms in the text format of Prometheus.
  std::string metrics() const;

 private:
  void write(tools::Json entry);

  const Log log_;
  mutable std::mutex mutex_;                   // for what follows, and for the log
  std::map<unsigned, std::int64_t> requests_;  // by status
  std::int64_t done_ = 0, cancelled_ = 0;      // lines
  media::LatenessMeter face_, sound_;          // of lines that had not to wait
};

}  // namespace animeme::serve
