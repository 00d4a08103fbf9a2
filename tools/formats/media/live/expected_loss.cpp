#include "tools/formats/media/live/expected_loss.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace animeme::media {
namespace {

constexpr int kSteps[] = {0, 2, 5, 10, 15, 20, ExpectedLoss::kMost};
constexpr double kNoLoss = 0.5;  // percent: single packets
constexpr double kHold = 30;     // seconds
constexpr int kMostWritten = 50;

int step_of(double percent) {
  if (!(percent >= kNoLoss)) return 0;
  const auto* step = std::lower_bound(std::begin(kSteps), std::end(kSteps), percent);
  return step == std::end(kSteps) ? ExpectedLoss::kMost : *step;
}

}  // namespace

Result<int> parse_expected_loss(const std::string& text) {
  if (text == "auto") return AudioSettings::kLossByReports;
  int percent = -1;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, percent);
  if (read.ec == std::errc() && read.ptr == end && percent >= 0 && percent <= kMostWritten) {
    return percent;
  }
  return make_error(Code::invalid_argument,
                    "'" + text.substr(0, 40) + "' is neither auto nor a percentage from 0 to 50");
}

int ExpectedLoss::percent(double loss, double now) {
  const int wanted = step_of(100 * loss);
  if (wanted >= percent_) {
    percent_ = wanted;
    below_ = 0;
    asked_for_it_ = now;
    return percent_;
  }
  below_ = std::max(below_, wanted);
  if (now - asked_for_it_ > kHold) {
    percent_ = std::exchange(below_, 0);
    asked_for_it_ = now;
  }
  return percent_;
}

void ExpectedLoss::follow(const SendStats& stats, double now, LiveInput& input) {
  const int wanted = percent(stats.sound_loss, now);
  if (wanted != std::exchange(told_, wanted)) input.expect_loss(wanted);
}

}  // namespace animeme::media
