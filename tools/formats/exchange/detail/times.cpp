#include "tools/formats/exchange/detail/times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "fap/rate_text.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {

namespace {

constexpr double kDay = 86400;
constexpr double kLargestFrame = 10'000'000;
constexpr double kSlack = 0.75;          // of a frame
constexpr double kSnap = 0.01;           // of a rate
constexpr double kLongestStep = 3;       // seconds between frames that are not milliseconds
constexpr double kShortestStep = 0.003;  // seconds between frames, 1/333
constexpr double kUsualStep = 1.0;
constexpr std::size_t kStepsToTell = 4;  // of a unit: two rows may be any time apart
constexpr double kNtscFrom = 2.0;        // seconds: shorter clips cannot tell 29.97 from 30
constexpr double kEven = 0.3;            // of a step: one that differs less from the median is even
constexpr double kMostlyEven = 0.95;     // of all steps
constexpr double kHeard = 0.04;          // seconds: less is not noticed between face and sound
constexpr double kMostTimecodeFrames = 255;    // a second; beyond it, a field counts milliseconds
constexpr double kUsualFrames = 120;           // a second
constexpr double kSlowedDown = 1.001;          // seconds of drop-frame timecodes: 30 are 29.97
constexpr double kMillisecondsASecond = 1000;  // as a timecode rate
constexpr int kTimecodeRates[] = {24, 25, 30, 48, 50, 60, 100, 120};
constexpr fap::Rate kRates[] = {{24, 1},       {25, 1},       {30, 1},       {50, 1},       {60, 1},
                                {30000, 1001}, {60000, 1001}, {10, 1},       {12, 1},       {25, 2},
                                {15, 1},       {20, 1},       {24000, 1001}, {48, 1},       {72, 1},
                                {90, 1},       {100, 1},      {120, 1},      {120000, 1001}};

std::optional<double> plain_number(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789.") != std::string_view::npos) {
    return std::nullopt;
  }
  return dam::parse_number(text);
}

std::string plain(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
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

// Drop-frame timecodes are those of NTSC.
int drop_frame_rate(double last_frame) { return last_frame < 30 ? 30 : last_frame < 60 ? 60 : 120; }

// The whole number that timecodes of an NTSC rate count to.
double counted_rate(fap::Rate rate) {
  const double exact = rate.frames_per_second();
  const double whole = std::round(exact);
  return rate.den == 1001 && std::abs(exact - whole) < 0.002 * whole ? whole : exact;
}

// Timecode frames between rows, within seconds; 0: none seen.
double timecode_step(const std::vector<RowTime>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = times[i].frames.value_or(0) - times[i - 1].frames.value_or(0);
    if (times[i].seconds == times[i - 1].seconds && step > 0) steps.push_back(step);
  }
  return steps.empty() ? 0 : median(std::move(steps));
}

int tell_timecode_rate(const std::vector<RowTime>& times, std::optional<fap::Rate> rate,
                       std::vector<std::string>& warnings) {
  double last = 0;
  for (const RowTime& time : times) last = std::max(last, time.frames.value_or(0));
  if (times.front().drop) return drop_frame_rate(last);
  // The last frame number of a whole second gives the rate.
  if (times.front().seconds != times.back().seconds) {
    // Slower than any camera, and no row missing: the second ends where it ends.
    const bool slow = last < kTimecodeRates[0] - 1 && timecode_step(times) == 1;
    return slow ? int(last) + 1 : timecode_rate(last);
  }
  if (rate) return timecode_rate(last, counted_rate(*rate) * std::max(1.0, timecode_step(times)));
  warnings.push_back(
      "the recording is too short to determine the timecode frames per second: 60 are assumed; "
      "give the frame rate");
  return timecode_rate(last, 60);
}

// What the last field of timecodes means.
enum class Reading : std::uint8_t {
  frames,        // and fractions of a frame
  milliseconds,  // of the second
  fraction       // what is behind the point is a fraction of the second
};

// Labels that a drop-frame timecode has left out since midnight: two a minute at 30 frames a
// second, but not in each tenth minute.
double dropped_labels(double seconds, int per_second) {
  const double minutes = std::floor(seconds / 60);
  return std::round(per_second / 15.0) * (minutes - std::floor(minutes / 10));
}

std::vector<double> seconds_of(const std::vector<RowTime>& times, int per_second, Reading reading) {
  std::vector<double> seconds;
  double midnight = 0;
  for (const RowTime& time : times) {
    double now = time.seconds;
    double day = kDay;
    if (time.frames) {
      const double whole = std::floor(*time.frames);
      now += reading == Reading::frames         ? *time.frames / per_second
             : reading == Reading::milliseconds ? *time.frames / kMillisecondsASecond
                                                : *time.frames - whole;
      if (time.drop) {
        now = (now - dropped_labels(time.seconds, per_second) / per_second) * kSlowedDown;
        day = (day - dropped_labels(day, per_second) / per_second) * kSlowedDown;
      }
      now += midnight;
      if (!seconds.empty() && seconds.back() - now > kDay / 2) {
        midnight += day;
        now += day;
      }
    }
    seconds.push_back(now);
  }
  return seconds;
}

// The share of steps that are not nearly the median; 1 if times go back or none moves on.
double unevenness(const std::vector<double>& seconds) {
  const std::vector<double> steps = steps_of(seconds);
  if (steps.empty()) return 1;
  const double step = median(steps);
  std::size_t uneven = 0;
  for (std::size_t i = 1; i < seconds.size(); ++i) {
    const double one = seconds[i] - seconds[i - 1];
    if (one < 0) return 1;
    uneven += std::abs(one / step - 1) > kEven ? 1 : 0;
  }
  return double(uneven) / double(seconds.size() - 1);
}

Reading tell_reading(const std::vector<RowTime>& times) {
  const auto all = [&](auto holds) { return std::all_of(times.begin(), times.end(), holds); };
  double last = 0;
  for (const RowTime& time : times) last = std::max(last, time.frames.value_or(0));
  if (last >= kMostTimecodeFrames) return Reading::milliseconds;
  const int per_second = times.front().drop ? drop_frame_rate(last) : timecode_rate(last);
  const double by_frames = unevenness(seconds_of(times, per_second, Reading::frames));
  if (last > kUsualFrames || all([](const RowTime& time) { return time.digits >= 3; })) {
    // Milliseconds, or the frames of a camera that is faster than 100 a second.
    const std::vector<double> seconds = seconds_of(times, 1, Reading::milliseconds);
    const std::vector<double> steps = steps_of(seconds);
    const bool too_fast = !steps.empty() && median(steps) < kShortestStep;
    return too_fast || by_frames < unevenness(seconds) ? Reading::frames : Reading::milliseconds;
  }
  if (!all([](const RowTime& time) { return time.fraction; })) return Reading::frames;
  const double by_fraction = unevenness(seconds_of(times, 1, Reading::fraction));
  return by_fraction < by_frames / 2 ? Reading::fraction : Reading::frames;
}

// How many seconds a time counts: trackers write milliseconds (MediaPipe), micro- and nanoseconds.
double tell_unit(const std::vector<double>& seconds, std::vector<std::string>& warnings) {
  const std::vector<double> steps = steps_of(seconds);
  if (steps.size() < kStepsToTell) return 1;
  const double step = median(steps);
  if (!(step > kLongestStep)) return 1;
  constexpr std::pair<double, const char*> kTimeUnits[] = {
      {1e-3, "milliseconds"}, {1e-6, "microseconds"}, {1e-9, "nanoseconds"}};
  for (const auto& [unit, name] : kTimeUnits) {
    if (step * unit < kShortestStep || step * unit > kUsualStep) continue;
    warnings.push_back("the times are " + plain(step) + " apart and taken as " + name);
    return unit;
  }
  return 1;
}

// Frames a second, counted over the whole recording: frames that were left out count.
double measured_rate(const std::vector<double>& seconds, double step) {
  double frames = 0;
  for (const double one : steps_of(seconds)) frames += std::round(one / step);
  return frames / (seconds.back() - seconds.front());
}

// The same by a line through all rows, which jitter of the first and the last one does not turn: a
// tenth of a frame there would make 59.94 of 60 in a take of five seconds.
double rate_of_line(const std::vector<double>& seconds, double step) {
  double frame = 0, frames = 0, times = 0, squares = 0, products = 0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (i > 0) frame += std::round((seconds[i] - seconds[i - 1]) / step);
    const double time = seconds[i] - seconds.front();
    frames += frame;
    times += time;
    squares += time * time;
    products += time * frame;
  }
  const auto count = double(seconds.size());
  return (count * products - times * frames) / (count * squares - times * times);
}

fap::Rate snapped(double measured, double duration, bool timecode) {
  fap::Rate best{0, 1};
  double error = kSnap;
  for (const fap::Rate& rate : kRates) {
    if (rate.den == 1001 && (timecode || duration < kNtscFrom)) continue;
    const double off = std::abs(measured / rate.frames_per_second() - 1);
    if (off < error) {
      error = off;
      best = rate;
    }
  }
  if (best.valid()) return best;
  return fap::make_rate(std::uint32_t(std::lround(measured * 16)), 16);
}

// Of rows in even steps: a usual rate that stays within what is noticed to their end, else the
// next one above theirs that can be coded, so that no row is lost.
fap::Rate rate_of_even(double measured, double duration) {
  fap::Rate best{0, 1};
  double least = std::max(kHeard, kSlack / measured);
  for (const fap::Rate& rate : kRates) {
    if (rate.den == 1001 && duration < kNtscFrom) continue;
    const double drift = std::abs(measured / rate.frames_per_second() - 1) * duration;
    if (std::abs(measured / rate.frames_per_second() - 1) < kSnap && drift < least) {
      least = drift;
      best = rate;
    }
  }
  if (best.valid()) return best;
  return fap::make_rate(std::uint32_t(std::ceil(measured * 16 - 0.01)), 16);
}

Result<fap::Rate> tell_rate(const std::vector<double>& seconds, bool timecode) {
  const std::vector<double> steps = steps_of(seconds);
  if (steps.empty()) {
    return make_error(Code::invalid_argument, "all rows have the same time; give the frame rate");
  }
  const double step = median(steps);
  const double duration = seconds.back() - seconds.front();
  const double measured = duration > 0 ? measured_rate(seconds, step) : 1 / step;
  if (!(measured >= 1.0 / 16 && measured <= 255)) {
    return make_error(
        Code::invalid_argument,
        "the times are " + std::to_string(step) +
            " s apart, which is not a valid frame rate; correct them or give the rate");
  }
  if (duration > 0 && steps.size() >= kStepsToTell && 1 - unevenness(seconds) >= kMostlyEven) {
    return rate_of_even(rate_of_line(seconds, step), duration);
  }
  return snapped(measured, duration, timecode);
}

// What a frame of the clip is in the times: timecodes of an NTSC rate that somebody names mostly
// count to the next whole number, and sometimes not.
double scale_of(const std::vector<double>& seconds, fap::Rate rate, bool timecode, bool given) {
  const double exact = rate.frames_per_second();
  if (!timecode || !given) return exact;
  const std::vector<double> steps = steps_of(seconds);
  const double counted = counted_rate(rate);
  if (steps.size() < kStepsToTell) return counted;
  const double measured = measured_rate(seconds, median(steps));
  return std::abs(measured - exact) < std::abs(measured - counted) ? exact : counted;
}

// The frame number of a row at `position` behind a row with number `previous` (-1: none). Rows
// that are less than 3/4 of a frame off the number that follows take it, so that jitter neither
// skips nor merges; equal to `previous`: both rows fall on one frame.
std::int64_t next_number(std::int64_t previous, double position) {
  const double expected = double(previous + 1);
  if (std::abs(position - expected) <= kSlack) return previous + 1;
  const std::int64_t nearest = std::llround(position);
  return std::max(nearest, std::max<std::int64_t>(previous, 0));
}

// Takes "2026-11-27T" or "2026-11-27 " off the front and a time zone off the end: the seconds of
// the day since 1970.
double take_date(std::string& text) {
  constexpr std::size_t kDate = 10;
  if (text.size() <= kDate || (text[4] != '-' && text[4] != '/') || text[7] != text[4]) return 0;
  if (text[kDate] != 'T' && text[kDate] != ' ') return 0;
  std::array<double, 3> date{};
  for (const auto& [at, size, which] : {std::array{0, 4, 0}, {5, 2, 1}, {8, 2, 2}}) {
    const auto number =
        plain_number(std::string_view(text).substr(std::size_t(at), std::size_t(size)));
    if (!number) return 0;
    date[std::size_t(which)] = *number;
  }
  text.erase(0, kDate + 1);
  if (text.ends_with('Z')) text.pop_back();
  text.resize(std::min(text.size(), text.find_first_of("+-")));
  // Days from the civil date, with years that begin in March.
  const double year = date[0] - (date[1] <= 2 ? 1 : 0);
  const double month = date[1] + (date[1] <= 2 ? 9 : -3);
  const double days = std::floor(365.25 * year) - std::floor(year / 100) + std::floor(year / 400) +
                      std::floor((153 * month + 2) / 5) + date[2] - 719469;
  return days * kDay;
}

// "1.5", "1.5s", "1500 ms".
std::optional<double> seconds_with_unit(std::string_view text) {
  double unit = 1;
  if (text.ends_with("ms")) {
    unit = 0.001;
    text.remove_suffix(2);
  } else if (text.size() > 1 && text.ends_with('s')) {
    text.remove_suffix(1);
  }
  const auto number = dam::parse_number(text);
  return number ? std::optional(*number * unit) : std::nullopt;
}

}  // namespace

std::optional<RowTime> parse_time(std::string_view field, std::size_t line) {
  std::string text(dam::trimmed(field));
  const double date = take_date(text);
  // Drop-frame timecodes have a semicolon before the frames.
  const std::size_t semicolon = text.rfind(';');
  const bool drop = semicolon != std::string::npos && text.find(':') < semicolon;
  if (drop) text[semicolon] = ':';
  const auto parts = dam::split_fields(text, ':');
  if (parts.size() == 1) {
    const auto seconds = seconds_with_unit(text);
    if (!seconds || !std::isfinite(*seconds)) return std::nullopt;
    return RowTime{*seconds, std::nullopt, line};
  }
  if (parts.size() < 2 || parts.size() > 4) return std::nullopt;
  std::array<double, 4> value{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string part(parts[i]);
    // "00:00:01,040" has a decimal comma.
    if (i + 1 == parts.size()) std::replace(part.begin(), part.end(), ',', '.');
    const auto number = plain_number(part);
    const bool whole = number && *number == std::floor(*number);
    if (!number || *number >= 1000 || (i + 1 < parts.size() && !whole)) return std::nullopt;
    value[i] = *number;
  }
  const std::size_t point = parts.back().find_first_of(".,");
  const bool fraction = point != std::string_view::npos && point + 1 < parts.back().size();
  if (parts.size() == 2) {  // mm:ss.fff; without the point, it may be anything
    if (!fraction) return std::nullopt;
    return RowTime{date + value[0] * 60 + value[1], std::nullopt, line};
  }
  RowTime time{date + value[0] * 3600 + value[1] * 60 + value[2], std::nullopt, line};
  if (parts.size() < 4) return time;
  time.frames = value[3];
  time.digits = int(std::min(point, parts[3].size()));
  time.fraction = fraction;
  time.drop = drop;
  return time;
}

namespace {

// Numbers rows one after the other.
class Numbering {
 public:
  Numbering(PlacedRows& placed, double scale, double step, bool even)
      : placed_(placed), scale_(scale), step_(step), even_(even) {}

  // `seconds` after the first row.
  void place(double seconds) {
    const double position = seconds * scale_;  // in frames
    const double expected = double(number_ + 1);
    const double one = number_ < 0 ? step_ : seconds - before_;
    before_ = seconds;
    std::int64_t next = 0;
    if (even_ && std::abs(one / step_ - 1) <= kEven) {
      next = number_ + 1;
      if (position - expected > std::max(kSlack, kHeard * scale_)) {
        ++next;
        placed_.late.push_back(placed_.numbers.size());
      }
      drift_ = position - double(next);
    } else {
      next = next_number(number_, position - drift_);
    }
    if (next == number_) {
      placed_.numbers.back().reset();
      ++merged_;
    }
    number_ = next;
    placed_.numbers.emplace_back(number_);
  }

  std::size_t merged() const { return merged_; }

 private:
  PlacedRows& placed_;
  double scale_, step_;
  bool even_;
  std::int64_t number_ = -1;
  double before_ = 0, drift_ = 0;
  std::size_t merged_ = 0;
};

// Rows whose steps are those of the clip, nearly all of them.
bool is_even(const std::vector<double>& seconds, double scale) {
  const std::vector<double> steps = steps_of(seconds);
  if (steps.size() < kStepsToTell || 1 - unevenness(seconds) < kMostlyEven) return false;
  return std::abs(measured_rate(seconds, median(steps)) / scale - 1) < kSnap;
}

}  // namespace

Result<PlacedRows> place_rows(const std::vector<RowTime>& times, std::optional<fap::Rate> rate,
                              std::vector<std::string>& warnings) {
  if (rate && !rate->valid()) {
    return make_error(Code::invalid_argument, "the given frame rate is invalid");
  }
  const bool timecode = times.front().frames.has_value();
  const Reading reading = timecode ? tell_reading(times) : Reading::frames;
  const bool counts = timecode && reading == Reading::frames;
  const int per_second = counts ? tell_timecode_rate(times, rate, warnings) : 1;
  std::vector<double> seconds = seconds_of(times, per_second, reading);
  if (timecode && !counts) {
    warnings.push_back("the last field of the timecodes is taken as " +
                       std::string(reading == Reading::milliseconds
                                       ? "milliseconds"
                                       : "a frame and, behind the point, milliseconds") +
                       ", since the steps are even so");
  }
  const double unit = timecode ? 1 : tell_unit(seconds, warnings);
  for (double& time : seconds) time *= unit;
  const bool given = rate.has_value();
  if (!rate) {
    Result<fap::Rate> told = tell_rate(seconds, counts);
    if (!told) return std::move(told).error();
    rate = *told;
  }
  const double scale = scale_of(seconds, *rate, counts, given);
  PlacedRows placed{*rate, unit, {}};
  const std::vector<double> steps = steps_of(seconds);
  Numbering numbering(placed, scale, steps.empty() ? 1 : median(steps), is_even(seconds, scale));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto at = std::int64_t(times[i].line);
    const double after = seconds[i] - seconds.front();
    if (i > 0 && seconds[i] < seconds[i - 1]) {
      return error_at_line(Code::out_of_range, "the time goes back; sort the rows by time", at);
    }
    if (after * scale > kLargestFrame) {
      return error_at_line(Code::out_of_range,
                           "the time is more than 10 million frames after the first; correct it",
                           at);
    }
    numbering.place(after);
  }
  if (numbering.merged() > 0) {
    warnings.push_back(
        "rows on the same frame as the next one, skipped: " + std::to_string(numbering.merged()) +
        " (at " + fap::format_rate(placed.rate) + " frames a second)");
  }
  if (!placed.late.empty()) {
    warnings.push_back("the rows come a little more slowly than " + fap::format_rate(placed.rate) +
                       " frames a second; frames added between them to keep in time: " +
                       std::to_string(placed.late.size()));
  }
  return placed;
}

}  // namespace animeme::exchange
