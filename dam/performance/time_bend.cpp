#include "dam/performance/time_bend.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace animeme::dam {
namespace {

constexpr double kBendStep = 0.4;       // seconds between places where the speed may change
constexpr double kBendMostShift = 3;    // seconds from the even map
constexpr double kBendTolerance = 0.6;  // frames between the path and the straight lines shown

// Rewards and costs.
constexpr double kBendOfBorder = 3, kBendOfAccent = 1;  // a match
constexpr double kBendNear = 0.1, kBendFar = 0.4;       // seconds: widths of a match
constexpr double kBendOfFar = 0.3;                      // share of the wide part
constexpr double kBendOfSilence = 1.5;                  // a second in which only one of them speaks
constexpr double kBendOfBend = 0.6;                     // a second at the fastest
constexpr double kBendOfEnd = 1.5;                      // a second between the ends
constexpr double kBendAgreementStep = 0.1;              // seconds between places that are compared

/// A function of the time of the new speech, as values a frame.
class TimeField {
 public:
  TimeField(double seconds, double frame)
      : frame_(frame), values_(std::size_t(std::max(0.0, seconds / frame)) + 2, 0.0f) {}
  void add_match(double time, double weight) {
    const double reach = 3 * kBendFar;
    const auto first = std::size_t(std::max(0.0, std::ceil((time - reach) / frame_)));
    for (std::size_t i = first; i < values_.size(); ++i) {
      const double away = double(i) * frame_ - time;
      if (away > reach) break;
      const double narrow = std::exp(-0.5 * away * away / (kBendNear * kBendNear));
      const double wide = std::exp(-std::abs(away) / kBendFar);
      const double value = weight * ((1 - kBendOfFar) * narrow + kBendOfFar * wide);
      values_[i] = std::max(values_[i], float(value));
    }
  }
  void add_span(double start, double end) {
    const auto first = std::size_t(std::max(0.0, std::ceil(start / frame_)));
    for (std::size_t i = first; i < values_.size() && double(i) * frame_ < end; ++i) values_[i] = 1;
  }
  double at(double time) const {
    const double x = time / frame_ + 0.5;
    return x < 0 || x >= double(values_.size()) ? 0.0 : double(values_[std::size_t(x)]);
  }

 private:
  double frame_;
  std::vector<float> values_;
};

/// The new speech as what the performance is drawn to.
struct Attraction {
  TimeField begins, ends, accents, speech;
  Attraction(const SpeechPlan& plan, double seconds, double frame)
      : begins(seconds, frame),
        ends(seconds, frame),
        accents(seconds, frame),
        speech(seconds, frame) {
    for (const SpeechPhrase& phrase : plan.phrases) {
      begins.add_match(phrase.start, kBendOfBorder);
      ends.add_match(phrase.end, kBendOfBorder);
      speech.add_span(phrase.start, phrase.end);
    }
    for (const SpeechAccent& accent : plan.accents)
      accents.add_match((accent.start + accent.end) / 2, kBendOfAccent * accent.weight);
  }
};

/// What of the performance is drawn, in order of its time.
struct Drawn {
  double source = 0;
  const TimeField* to = nullptr;
  double weight = 1;
};

std::vector<Drawn> drawn_by(const SpeechPlan& plan, const Attraction& attraction) {
  std::vector<Drawn> list;
  for (const SpeechPhrase& phrase : plan.phrases) {
    list.push_back({phrase.start, &attraction.begins});
    list.push_back({phrase.end, &attraction.ends});
  }
  for (const SpeechAccent& accent : plan.accents)
    list.push_back({(accent.start + accent.end) / 2, &attraction.accents, accent.weight});
  std::stable_sort(list.begin(), list.end(),
                   [](const Drawn& a, const Drawn& b) { return a.source < b.source; });
  return list;
}

/// A piece of the performance in which time runs evenly.
struct PacedStep {
  double from = 0, to = 0;  // seconds of the performance
  bool fixed = false;
  double even = 0;            // frames by which the even map is longer here
  std::ptrdiff_t centre = 0;  // frames: the shift of the even map at its end
};

std::vector<PacedStep> steps_of(double length, double frame, std::span<const OwnPace> fixed) {
  const double longest = std::max(kBendStep, 5 * frame);
  std::vector<PacedStep> steps;
  double at = 0;
  const auto fill = [&](double to) {
    if (!(to > at)) return;
    const double count = std::max(1.0, std::floor((to - at) / longest));
    const double from = at;
    for (double i = 0; i < count; ++i) {
      const double end = i + 1 < count ? from + (to - from) * (i + 1) / count : to;
      steps.push_back({at, end});
      at = end;
    }
  };
  for (const OwnPace& one : fixed) {
    const double start = std::clamp(one.start, at, length), end = std::min(one.end, length);
    if (!(end > start)) continue;
    fill(start);
    steps.push_back({start, end, true});
    at = end;
  }
  fill(length);
  return steps;
}

constexpr double kBendImpossible = -std::numeric_limits<double>::infinity();

/// Dynamic programming over steps of the performance; a state is the shift of time in frames.
class BendSearch {
 public:
  BendSearch(const SpeechPlan& source, const SpeechPlan& target, const BendOptions& options)
      : options_(options),
        frame_(options.rate.seconds(1)),
        fastest_(1 + options.most),
        attraction_(target, options.wanted + kBendMostShift, frame_),
        own_speech_(options.length, frame_),
        drawn_(drawn_by(source, attraction_)),
        fits_(options.wanted * fastest_ >= options.length) {
    for (const SpeechPhrase& phrase : source.phrases)
      own_speech_.add_span(phrase.start, phrase.end);
    const double last = std::min(options.length, options.wanted * fastest_ + 2 * frame_);
    steps_ = steps_of(last, frame_, options.fixed);
    make_even(fits_ ? (options.wanted - last) / frame_ : 0);
    reach_ = std::ptrdiff_t(std::ceil(kBendMostShift / frame_));
    rest_ = source.phrases.empty() || target.phrases.empty();
  }

  std::vector<BentMoment> run() {
    const auto states = std::size_t(2 * reach_ + 1);
    std::vector<double> best(states, kBendImpossible), next;
    best[std::size_t(reach_)] = 0;
    std::vector<std::vector<std::int16_t>> moves;
    std::ptrdiff_t before = 0;
    std::size_t first_drawn = 0;
    for (const PacedStep& step : steps_) {
      while (first_drawn < drawn_.size() && drawn_[first_drawn].source < step.from) ++first_drawn;
      next.assign(states, kBendImpossible);
      moves.emplace_back(states, std::int16_t(0));
      const Moves allowed = moves_of(step);
      for (std::size_t s = 0; s < states; ++s) {
        if (best[s] == kBendImpossible) continue;
        const std::ptrdiff_t shift = std::ptrdiff_t(s) - reach_ + before;
        for (std::ptrdiff_t move = allowed.least; move <= allowed.most; ++move) {
          const std::ptrdiff_t state = shift + move - step.centre + reach_;
          if (state < 0 || state >= std::ptrdiff_t(states)) continue;
          const double value = best[s] + gain(step, first_drawn, shift, move);
          if (!(value > next[std::size_t(state)])) continue;
          next[std::size_t(state)] = value;
          moves.back()[std::size_t(state)] = std::int16_t(move);
        }
      }
      best.swap(next);
      before = step.centre;
    }
    return path(best, moves, before);
  }

 private:
  struct Moves {
    std::ptrdiff_t least = 0, most = 0;  // frames
  };

  // Spreads a shift of so many frames, as far as it is possible, over the steps that can bend.
  void make_even(double shift) {
    double possible = 0;
    const auto room = [&](const PacedStep& step) {
      const Moves moves = moves_of(step);
      return double(shift > 0 ? moves.most : -moves.least);
    };
    for (const PacedStep& step : steps_) possible += room(step);
    const double share = possible > 0 ? std::clamp(shift / possible, -1.0, 1.0) : 0;
    double sum = 0;
    for (PacedStep& step : steps_) {
      step.even = share * room(step);
      sum += step.even;
      step.centre = std::ptrdiff_t(std::llround(sum));
    }
  }

  Moves moves_of(const PacedStep& step) const {
    if (step.fixed) return {};
    const double length = (step.to - step.from) / frame_;
    constexpr double kBendRounding = 1e-9;
    return {-std::ptrdiff_t((1 - 1 / fastest_) * length + kBendRounding),
            std::ptrdiff_t((fastest_ - 1) * length + kBendRounding)};
  }

  double gain(const PacedStep& step, std::size_t drawn, std::ptrdiff_t shift,
              std::ptrdiff_t move) const {
    const double length = step.to - step.from;
    const auto time = [&](double source) {
      const double share = (source - step.from) / length;
      return source + frame_ * (double(shift) + share * double(move));
    };
    double gained = 0;
    for (; drawn < drawn_.size() && drawn_[drawn].source < step.to; ++drawn)
      gained += drawn_[drawn].weight * drawn_[drawn].to->at(time(drawn_[drawn].source));
    if (!rest_) {
      const double count = std::max(1.0, std::round(length / kBendAgreementStep));
      double differs = 0;
      for (double i = 0.5; i < count; ++i) {
        const double source = step.from + length * i / count;
        differs += std::abs(own_speech_.at(source) - attraction_.speech.at(time(source)));
      }
      gained -= kBendOfSilence * length * differs / count;
    }
    const double bend = (double(move) - step.even) * frame_ / length / options_.most;
    return gained - (step.fixed ? 0 : kBendOfBend * length * bend * bend);
  }

  std::vector<BentMoment> path(const std::vector<double>& best,
                               const std::vector<std::vector<std::int16_t>>& moves,
                               std::ptrdiff_t centre) const {
    std::ptrdiff_t end = 0;
    double most = kBendImpossible;
    for (std::size_t s = 0; s < best.size(); ++s) {
      const std::ptrdiff_t shift = std::ptrdiff_t(s) - reach_ + centre;
      const double ends = steps_.back().to + frame_ * double(shift);
      const double value = best[s] - (fits_ ? kBendOfEnd * std::abs(ends - options_.wanted) : 0);
      if (value > most) most = value, end = shift;
    }
    std::vector<BentMoment> moments(steps_.size() + 1);
    for (std::size_t i = steps_.size(); i > 0; --i) {
      const PacedStep& step = steps_[i - 1];
      moments[i] = {step.to + frame_ * double(end), step.to};
      const std::ptrdiff_t state = end - step.centre + reach_;
      end -= moves[i - 1][std::size_t(state)];
    }
    return straight(moments);
  }

  // Few lines in place of many steps, between stretches that keep their speed.
  std::vector<BentMoment> straight(const std::vector<BentMoment>& moments) const {
    std::vector<bool> kept(moments.size(), false);
    kept.front() = kept.back() = true;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (steps_[i].fixed) kept[i] = kept[i + 1] = true;
    std::vector<std::pair<std::size_t, std::size_t>> lines;
    for (std::size_t a = 0, b = 1; b < moments.size(); ++b) {
      if (!kept[b]) continue;
      lines.emplace_back(a, b);
      a = b;
    }
    while (!lines.empty()) {
      const auto [a, b] = lines.back();
      lines.pop_back();
      const double slope =
          (moments[b].time - moments[a].time) / (moments[b].source - moments[a].source);
      std::size_t worst = a;
      double distance = kBendTolerance * frame_;
      for (std::size_t i = a + 1; i < b; ++i) {
        const double line = moments[a].time + slope * (moments[i].source - moments[a].source);
        const double away = std::abs(moments[i].time - line);
        if (away > distance) distance = away, worst = i;
      }
      if (worst == a) continue;
      kept[worst] = true;
      lines.emplace_back(a, worst);
      lines.emplace_back(worst, b);
    }
    std::vector<BentMoment> few;
    for (std::size_t i = 0; i < moments.size(); ++i)
      if (kept[i]) few.push_back(moments[i]);
    return few;
  }

  BendOptions options_;
  double frame_, fastest_;
  Attraction attraction_;
  TimeField own_speech_;
  std::vector<Drawn> drawn_;
  bool fits_;  // the performance need not be cut
  std::vector<PacedStep> steps_;
  std::ptrdiff_t reach_ = 0;
  bool rest_ = false;  // one of them never speaks, or it is not known when
};

}  // namespace

double BentTime::source(double time) const {
  if (moments_.empty()) return time;
  if (time <= moments_.front().time) return moments_.front().source + time - moments_.front().time;
  if (time >= moments_.back().time) return moments_.back().source + time - moments_.back().time;
  const auto after =
      std::upper_bound(moments_.begin(), moments_.end(), time,
                       [](double moment, const BentMoment& one) { return moment < one.time; });
  const BentMoment& a = *(after - 1);
  const double length = after->time - a.time;
  // Exact where time is only shifted.
  const double shift = a.source - a.time, change = after->source - after->time - shift;
  return time + shift + change * (time - a.time) / length;
}

BentTime bend_time(const SpeechPlan& source, const SpeechPlan& target, const BendOptions& options) {
  const double frame = options.rate.seconds(1);
  if (!(options.most > 0) || !(options.length > frame) || !(options.wanted > frame)) {
    return BentTime({{0, 0}, {std::max(options.length, frame), std::max(options.length, frame)}});
  }
  return BentTime(BendSearch(source, target, options).run());
}

}  // namespace animeme::dam
