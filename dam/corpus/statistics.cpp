#include "dam/corpus/statistics_internal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "dam/script/timeline_internal.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

/// Two controls undo each other if what they have in common is less than this part of the larger.
constexpr double kCommon = 0.01;

constexpr double kConstant = 1e-9;  // a smaller standard deviation is no motion
constexpr double kOpenestClosure = 25;
constexpr double kShutReach = 0.2;  // seconds from the least gap

/// Mean and deviation of one set of frames.
struct Moments {
  double count = 0;
  std::vector<double> sum, squares;

  explicit Moments(std::size_t k) : sum(k, 0.0), squares(k, 0.0) {}
  double mean(std::size_t c) const { return count > 0 ? sum[c] / count : 0.0; }
};

/// The least value of a lip measure near every phone of a sort.
template <class Sort, class Measure>
void add_extremes(const Utterance& u, Sort wanted, Measure measure, std::vector<double>& extremes) {
  const auto lips = inner_lip_channels(u.signal.names);
  if (!lips) return;
  for (const Phone& phone : u.script.phones) {
    if (!wanted(phone.label)) continue;
    double least = std::numeric_limits<double>::infinity();
    const FrameSpan span = frames_near(u.signal, phone, kClosureSearch);
    for (std::size_t i = span.first; i < span.last; ++i)
      if (is_measured(u.signal, i)) least = std::min(least, measure(u.signal, i, *lips));
    if (std::isfinite(least)) extremes.push_back(least);
  }
}

template <class Add>
std::optional<double> median_over(std::span<const Utterance* const> sentences, Add add) {
  std::vector<double> extremes;
  for (const Utterance* u : sentences) add(*u, extremes);
  if (extremes.size() < kFewContacts) return std::nullopt;
  const auto middle = extremes.begin() + std::ptrdiff_t(extremes.size() / 2);
  std::nth_element(extremes.begin(), middle, extremes.end());
  return *middle;
}

}  // namespace

std::vector<FramePlace> frame_places(const Utterance& u, double pause_edge) {
  const auto stretches = speech_stretches(u.script);
  std::vector<FramePlace> places(u.signal.frames(), FramePlace::neither);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!is_measured(u.signal, i)) continue;
    const double distance = distance_to_speech(stretches, u.signal.time(i));
    if (distance <= kSpeechMargin)
      places[i] = FramePlace::speech;
    else if (distance > pause_edge)
      places[i] = FramePlace::rest;
  }
  return places;
}

void settle_controls(std::vector<Control>& controls) {
  std::vector<std::string> names;
  std::vector<double> pose;
  for (Control& c : controls) {
    if (c.sd < kConstant * (1 + std::abs(c.mean))) c.sd = 0;
    names.push_back(c.name);
    pose.push_back(c.rest);
  }
  close_pose(names, pose);
  for (std::size_t c = 0; c < controls.size(); ++c)
    if (controls[c].sd > 0) controls[c].rest = pose[c];
}

std::vector<Control> control_statistics(std::span<const Utterance* const> sentences,
                                        double pause_edge) {
  std::vector<Control> controls;
  for (const std::string& name : sentences[0]->signal.names) controls.push_back({name, 0, 0, 0});
  const std::size_t k = controls.size();
  Moments speech(k), rest(k);
  const auto each_frame = [&](const auto& visit) {
    for (const Utterance* u : sentences) {
      const auto places = frame_places(*u, pause_edge);
      for (std::size_t i = 0; i < places.size(); ++i) visit(&u->signal.values[i * k], places[i]);
    }
  };
  each_frame([&](const double* row, FramePlace place) {
    if (place == FramePlace::neither) return;
    Moments& m = place == FramePlace::speech ? speech : rest;
    m.count += 1;
    for (std::size_t c = 0; c < k; ++c) m.sum[c] += row[c];
  });
  each_frame([&](const double* row, FramePlace place) {
    if (place != FramePlace::speech) return;
    for (std::size_t c = 0; c < k; ++c) {
      const double d = row[c] - speech.mean(c);
      speech.squares[c] += d * d;
    }
  });
  for (std::size_t c = 0; c < k; ++c) {
    controls[c].mean = speech.mean(c);
    controls[c].sd = std::sqrt(speech.squares[c] / std::max(1.0, speech.count));
    controls[c].rest = rest.count > 0 ? rest.mean(c) : speech.mean(c);
  }
  settle_controls(controls);
  return controls;
}

ControlLimit limit_of_data(const ControlLimit& limit, const Control& control, double low,
                           double high) {
  if (!limit.free() || fap_of_channel(control.name) != 0 || control.sd == 0) return limit;
  return low >= 0 && high <= 1 ? ControlLimit{0, 1, -1, 0} : limit;
}

std::vector<ControlLimit> control_limits(std::span<const Utterance* const> sentences,
                                         std::span<const Control> controls) {
  const std::size_t k = controls.size();
  std::vector<double> low(k, std::numeric_limits<double>::infinity());
  std::vector<double> high(k, -std::numeric_limits<double>::infinity());
  for (const Utterance* u : sentences) {
    for (std::size_t i = 0; i < u->signal.values.size(); ++i) {
      if (!is_measured(u->signal, i / k)) continue;
      low[i % k] = std::min(low[i % k], u->signal.values[i]);
      high[i % k] = std::max(high[i % k], u->signal.values[i]);
    }
  }
  std::vector<std::string> names;
  for (const Control& control : controls) names.push_back(control.name);
  std::vector<ControlLimit> limits = natural_limits(names);
  untie(limits, [&](std::size_t a, std::size_t b) {
    double common = 0, larger = 0;
    for (const Utterance* u : sentences) {
      for (std::size_t i = 0; i < u->signal.frames(); ++i) {
        const double x = u->signal.at(i, a), y = u->signal.at(i, b);
        common += std::max(0.0, std::min(x, y));
        larger += std::max({0.0, x, y});
      }
    }
    return common <= kCommon * larger;
  });
  for (std::size_t c = 0; c < k; ++c)
    limits[c] = limit_of_data(limits[c], controls[c], low[c], high[c]);
  return settled(std::move(limits));
}

std::vector<bool> speech_frames(const Utterance& utterance) {
  std::vector<bool> speech;
  for (const FramePlace place : frame_places(utterance, 0))
    speech.push_back(place == FramePlace::speech);
  return speech;
}

void add_closures(const Utterance& utterance, std::vector<double>& gaps) {
  add_extremes(utterance, is_bilabial, inner_gap, gaps);
}

void add_lip_tooth_contacts(const Utterance& utterance, std::vector<double>& lows) {
  add_extremes(
      utterance, is_labiodental,
      [](const Signal& signal, std::size_t i, const LipChannels& lips) {
        return -signal.at(i, lips.lower);
      },
      lows);
}

double closure_gap_of(std::optional<double> median) {
  return median ? std::clamp(*median, 0.0, kOpenestClosure) : kOpenestClosure;
}

void ShutSums::add(const Utterance& u) {
  const auto lips = inner_lip_channels(u.signal.names);
  if (!lips) return;
  const auto& phones = u.script.phones;
  for (std::size_t i = 1; i < phones.size(); ++i) {
    const bool behind_silence =
        phones[i - 1].label == kSilence || phones[i].start - phones[i - 1].end > kTimeTolerance;
    if (behind_silence || !is_bilabial(phones[i].label)) continue;
    const auto span = closed_span(u.signal, phones[i], *lips, kShutReach);
    if (!span) continue;
    const double d = phones[i].duration(), s = u.signal.rate.seconds(span->frames());
    add({1, d, s, d * d, d * s});
  }
}

void ShutSums::add(const ShutSums& o) {
  count += o.count;
  phone += o.phone;
  shut += o.shut;
  phone_squared += o.phone_squared;
  both += o.both;
}

std::optional<ClosureDuration> ShutSums::line() const {
  if (count < double(kFewContacts)) return std::nullopt;
  // Few phones, or all of one length, hardly determine the slope: as many seconds squared as ten of
  // them spread by 50 ms hold it at 0.
  constexpr double kPrior = 10 * 0.05 * 0.05;
  const double spread = phone_squared - phone * phone / count;
  const double slope = (both - phone * shut / count) / (spread + kPrior);
  return ClosureDuration{(shut - slope * phone) / count, slope};
}

std::optional<ClosureDuration> measured_closure_duration(
    std::span<const Utterance* const> sentences) {
  ShutSums sums;
  for (const Utterance* u : sentences) sums.add(*u);
  return sums.line();
}

double measured_closure_gap(std::span<const Utterance* const> sentences) {
  return closure_gap_of(median_over(sentences, add_closures));
}

std::optional<double> measured_lip_tooth_raise(std::span<const Utterance* const> sentences) {
  const auto low = median_over(sentences, add_lip_tooth_contacts);
  return low ? std::optional(-*low) : std::nullopt;
}

}  // namespace animeme::dam
