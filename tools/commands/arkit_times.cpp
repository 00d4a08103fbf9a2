#include "tools/commands/arkit_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "dam/script/table_text_internal.h"

namespace animeme::tools {

namespace {

constexpr double kDay = 86400;
constexpr double kSlack = 0.75;    // of a frame
constexpr double kSnap = 0.01;     // of a rate
constexpr double kNtscFrom = 2.0;  // seconds: shorter clips cannot tell 29.97 from 30
constexpr int kTimecodeRates[] = {24, 25, 30, 48, 50, 60, 100, 120};
constexpr fap::Rate kRates[] = {{24, 1},       {25, 1}, {30, 1}, {50, 1}, {60, 1},  {30000, 1001},
                                {60000, 1001}, {10, 1}, {12, 1}, {25, 2}, {15, 1},  {20, 1},
                                {24000, 1001}, {48, 1}, {72, 1}, {90, 1}, {100, 1}, {120, 1}};

std::optional<double> plain_number(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789.") != std::string_view::npos) {
    return std::nullopt;
  }
  return dam::parse_number(text);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> steps_of(const std::vector<double>& seconds) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < seconds.size(); ++i) {
    if (seconds[i] > seconds[i - 1]) steps.push_back(seconds[i] - seconds[i - 1]);
  }
  return steps;
}

// The timecode rate above `last_frame` that is next to `about`; the smallest if that is 0.
int timecode_rate(double last_frame, double about = 0) {
  int best = 0;
  for (const int rate : kTimecodeRates) {
    if (last_frame >= rate) continue;
    if (best == 0 || std::abs(rate - about) < std::abs(best - about)) best = rate;
  }
  return best != 0 ? best : int(last_frame) + 1;
}

// The whole number that timecodes of an NTSC rate count to.
double counted_rate(fap::Rate rate) {
  const double exact = rate.frames_per_second();
  const double whole = std::round(exact);
  return rate.den == 1001 && std::abs(exact - whole) < 0.002 * whole ? whole : exact;
}

// Timecode frames between rows, within seconds; 0: none seen.
double timecode_step(const std::vector<TimeField>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = times[i].frames.value_or(0) - times[i - 1].frames.value_or(0);
    if (times[i].seconds == times[i - 1].seconds && step > 0) steps.push_back(step);
  }
  return steps.empty() ? 0 : median(std::move(steps));
}

// True if some second ends within the recording: its last frame number tells the timecode rate.
bool passes_a_second(const std::vector<TimeField>& times) {
  return times.front().seconds != times.back().seconds;
}

int tell_timecode_rate(const std::vector<TimeField>& times, std::optional<fap::Rate> rate,
                       std::vector<std::string>& warnings) {
  double last = 0;
  for (const TimeField& time : times) last = std::max(last, time.frames.value_or(0));
  if (passes_a_second(times)) {
    // Slower than any camera, and no row missing: the second ends where it ends.
    const bool slow = last < kTimecodeRates[0] - 1 && timecode_step(times) == 1;
    return slow ? int(last) + 1 : timecode_rate(last);
  }
  if (rate) return timecode_rate(last, counted_rate(*rate) * std::max(1.0, timecode_step(times)));
  warnings.push_back(
      "the recording is too short to tell how many timecode frames make a second: 60 are assumed; "
      "give the frame rate");
  return timecode_rate(last, 60);
}

std::vector<double> seconds_of(const std::vector<TimeField>& times, int per_second) {
  std::vector<double> seconds;
  double midnight = 0;
  for (const TimeField& time : times) {
    double now = time.seconds + midnight;
    if (time.frames) {
      now += *time.frames / per_second;
      if (!seconds.empty() && seconds.back() - now > kDay / 2) {
        midnight += kDay;
        now += kDay;
      }
    }
    seconds.push_back(now);
  }
  return seconds;
}

bool is_ntsc(fap::Rate rate) { return rate.den == 1001; }

// Frames a second, counted over the whole recording: frames that were left out count.
double measured_rate(const std::vector<double>& seconds, double step) {
  double frames = 0;
  for (const double one : steps_of(seconds)) frames += std::round(one / step);
  return frames / (seconds.back() - seconds.front());
}

fap::Rate snapped(double measured, double duration, bool timecode) {
  fap::Rate best{0, 1};
  double error = kSnap;
  for (const fap::Rate& rate : kRates) {
    if (is_ntsc(rate) && (timecode || duration < kNtscFrom)) continue;
    const double off = std::abs(measured / rate.frames_per_second() - 1);
    if (off < error) {
      error = off;
      best = rate;
    }
  }
  if (best.valid()) return best;
  return fap::make_rate(std::uint32_t(std::lround(measured * 16)), 16);
}

Result<fap::Rate> tell_rate(const std::vector<double>& seconds, bool timecode) {
  const std::vector<double> steps = steps_of(seconds);
  if (steps.empty()) {
    return make_error(Code::invalid_argument,
                      "rows at one time only do not tell the frame rate; give it");
  }
  const double step = median(steps);
  const double duration = seconds.back() - seconds.front();
  const double measured = duration > 0 ? measured_rate(seconds, step) : 1 / step;
  if (!(measured >= 1.0 / 16 && measured <= 255)) {
    return make_error(Code::invalid_argument,
                      "the times are " + std::to_string(step) +
                          " s apart, which is no frame rate; correct them or give the rate");
  }
  return snapped(measured, duration, timecode);
}

}  // namespace

std::optional<TimeField> parse_time(std::string_view field) {
  const auto parts = dam::split_fields(field, ':');
  if (parts.size() == 1) {
    const auto seconds = dam::parse_number(field);
    if (!seconds || !std::isfinite(*seconds)) return std::nullopt;
    return TimeField{*seconds, std::nullopt};
  }
  if (parts.size() != 3 && parts.size() != 4) return std::nullopt;
  std::array<double, 4> value{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = plain_number(parts[i]);
    const bool whole = number && *number == std::floor(*number);
    if (!number || *number >= 1000 || (i + 1 < parts.size() && !whole)) return std::nullopt;
    value[i] = *number;
  }
  TimeField time{value[0] * 3600 + value[1] * 60 + value[2], std::nullopt};
  if (parts.size() == 4) time.frames = value[3];
  return time;
}

Result<Timing> tell_timing(const std::vector<TimeField>& times, std::optional<fap::Rate> rate) {
  Timing timing;
  const bool timecode = times.front().frames.has_value();
  const int per_second = timecode ? tell_timecode_rate(times, rate, timing.warnings) : 1;
  const std::vector<double> seconds = seconds_of(times, per_second);
  if (rate) {
    timing.rate = *rate;
  } else {
    Result<fap::Rate> told = tell_rate(seconds, timecode);
    if (!told) return std::move(told).error();
    timing.rate = *told;
  }
  const double scale = timecode ? counted_rate(timing.rate) : timing.rate.frames_per_second();
  for (const double now : seconds) timing.positions.push_back((now - seconds.front()) * scale);
  return timing;
}

std::int64_t next_number(std::int64_t previous, double position) {
  const double expected = double(previous + 1);
  if (std::abs(position - expected) <= kSlack) return previous + 1;
  const std::int64_t nearest = std::llround(position);
  return std::max(nearest, std::max<std::int64_t>(previous, 0));
}

}  // namespace animeme::tools
