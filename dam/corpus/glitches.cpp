#include "dam/corpus/glitches.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "dam/corpus/statistics_internal.h"
#include "dam/signal/limits.h"
#include "fap/detail/quantile.h"

namespace animeme::dam {
namespace {

constexpr double kShare = 0.05, kMostShare = 0.2;  // of the frames beyond the usual span
constexpr double kNonsense = 0.6;                  // seconds that must not become usual
constexpr double kJump = 3, kJumpOfLittle = 4;     // usual spans from the middle
constexpr double kSpike = 3, kSpikeShare = 0.995;
constexpr double kStuck = 0.3;   // seconds
constexpr double kHabit = 0.01;  // of the frames: a value where the control likes to be
constexpr double kRepeats = 0.1;
constexpr double kTooMany = 0.05;  // of the frames
constexpr double kBridge = 0.12;   // seconds
constexpr std::size_t kApart = 3;  // frames between two parts of one jump

/// Distance from the median of a normal distribution beyond which `share` lie, over that of
/// kShare.
double reach_ratio(double share) {
  // Straight lines between 5, 10, 15 and 20 %.
  constexpr double kReach[] = {1.645, 1.282, 1.036, 0.842};
  const double at = std::clamp((share - 0.05) / 0.05, 0.0, 3.0);
  const auto low = std::min(std::size_t(at), std::size_t(2));
  return (kReach[low] + (at - double(low)) * (kReach[low + 1] - kReach[low])) / kReach[0];
}

/// How a control moves, whatever happens in a few frames.
struct Usual {
  double middle = 0, span = 0;
  double reach = 0;  ///< further from the middle is a jump
  double bend = 0;   ///< kSpikeShare of the frames are off their neighbours by less
  bool repeats = false;
  double habit = 0;                     ///< frames that make a value a habit
  std::map<double, std::size_t> often;  ///< values and their frames, of those that are more
};

/// One channel of one sentence.
struct Channel {
  const Signal& signal;
  std::size_t control;
  const std::vector<bool>& speech;

  std::size_t frames() const { return signal.frames(); }
  double operator[](std::size_t i) const { return signal.at(i, control); }
  bool measured(std::size_t i) const { return is_measured(signal, i); }
  bool has_neighbours(std::size_t i) const {
    return i > 0 && i + 1 < frames() && measured(i - 1) && measured(i) && measured(i + 1);
  }
  double bend(std::size_t i) const { return (*this)[i] - ((*this)[i - 1] + (*this)[i + 1]) / 2; }
};

std::size_t stuck_frames(fap::Rate rate) {
  return std::size_t(std::ceil(kStuck * rate.frames_per_second()));
}

using SpeechMasks = std::vector<std::vector<bool>>;

Usual usual_of(std::span<const Utterance* const> sentences, const SpeechMasks& speech,
               std::size_t control) {
  std::vector<double> values, bends;
  double seconds = 0;
  std::size_t same = 0, spoken = 0;
  const std::size_t longest = stuck_frames(sentences[0]->signal.rate);
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    const Channel channel{sentences[s]->signal, control, speech[s]};
    std::size_t held = 0;  // frames of the same value so far
    for (std::size_t i = 0; i < channel.frames(); ++i) {
      if (!channel.measured(i)) continue;
      values.push_back(channel[i]);
      held = i > 0 && channel[i] == channel[i - 1] ? held + 1 : 0;
      if (channel.speech[i]) ++spoken;
      if (channel.speech[i] && held > 0 && held < longest) ++same;
      if (channel.has_neighbours(i)) bends.push_back(std::abs(channel.bend(i)));
    }
  }
  Usual usual;
  if (values.empty() || bends.empty()) return usual;
  seconds = sentences[0]->signal.rate.seconds(double(values.size()));
  const double share = std::clamp(kNonsense / seconds, kShare, kMostShare);
  const double low = fap::detail::quantile(values, share),
               high = fap::detail::quantile(values, 1 - share);
  usual.middle = fap::detail::quantile(values, 0.5);
  usual.span = (high - low) / reach_ratio(share);
  usual.reach = usual.span * (share > kShare ? kJumpOfLittle : kJump);
  usual.bend = fap::detail::quantile(bends, std::min(kSpikeShare, 1 - share / 2));
  usual.repeats = double(same) > kRepeats * double(spoken);
  std::sort(values.begin(), values.end());
  usual.habit = std::max(2.0, kHabit * double(values.size()));
  for (std::size_t i = 0; i < values.size();) {
    std::size_t j = i;
    while (j < values.size() && values[j] == values[i]) ++j;
    if (double(j - i) > usual.habit) usual.often[values[i]] = j - i;
    i = j;
  }
  return usual;
}

struct FaultyRun {
  GlitchKind kind;
  std::size_t first, last;  // last: behind it
};

std::vector<FaultyRun> runs_of(const Channel& channel, const Usual& usual,
                               const ControlLimit& limit) {
  std::vector<FaultyRun> runs;
  if (usual.span <= 0) return runs;
  const auto possible = [&](std::size_t i) {  // by nature
    return !limit.free() && channel[i] >= limit.low && channel[i] <= limit.high;
  };
  const auto jumps = [&](std::size_t i) {
    return !possible(i) && std::abs(channel[i] - usual.middle) > usual.reach;
  };
  const auto spikes = [&](std::size_t i) {
    if (possible(i) || !channel.has_neighbours(i)) return false;
    const double off = std::abs(channel.bend(i));
    return off > usual.span && off > kSpike * usual.bend &&
           std::abs(channel[i + 1] - channel[i - 1]) < off / 3;
  };
  for (std::size_t i = 0; i < channel.frames(); ++i) {
    if (!channel.measured(i)) continue;
    if (jumps(i)) {
      if (!runs.empty() && runs.back().kind == GlitchKind::jump && i <= runs.back().last + kApart)
        runs.back().last = i + 1;
      else
        runs.push_back({GlitchKind::jump, i, i + 1});
    } else if (spikes(i)) {
      runs.push_back({GlitchKind::spike, i, i + 1});
    }
  }
  // Nonsense passes through the usual on its way in and out.
  const auto odd = [&](std::size_t i) {
    return channel.measured(i) && std::abs(channel[i] - usual.middle) > usual.span;
  };
  for (FaultyRun& run : runs) {
    if (run.kind != GlitchKind::jump) continue;
    for (std::size_t n = 0; n < kApart && run.first > 0 && odd(run.first - 1); ++n) --run.first;
    for (std::size_t n = 0; n < kApart && run.last < channel.frames() && odd(run.last); ++n)
      ++run.last;
  }
  if (usual.repeats) return runs;
  const std::size_t least = stuck_frames(channel.signal.rate);
  for (std::size_t i = 0; i < channel.frames();) {
    std::size_t j = i;
    while (j < channel.frames() && channel[j] == channel[i] && channel.speech[j]) ++j;
    const auto often = usual.often.find(channel[i]);
    const bool habit = often != usual.often.end() && double(often->second - (j - i)) > usual.habit;
    if (j - i >= least && !habit) runs.push_back({GlitchKind::stuck, i, j});
    i = std::max(j, i + 1);
  }
  std::sort(runs.begin(), runs.end(),
            [](const FaultyRun& a, const FaultyRun& b) { return a.first < b.first; });
  return runs;
}

/// Whether the sentences are what they should be; who learns from them says so otherwise.
bool sound(std::span<const Utterance* const> sentences) {
  return std::all_of(sentences.begin(), sentences.end(), [&](const Utterance* u) {
    const Signal& s = u->signal;
    return s.names == sentences[0]->signal.names && s.rate == sentences[0]->signal.rate &&
           s.rate.valid() && s.values.size() == s.frames() * s.names.size() &&
           std::all_of(s.values.begin(), s.values.end(), [](double x) { return std::isfinite(x); });
  });
}

std::unique_ptr<Utterance> mended(const Utterance& sentence, const std::vector<Glitch>& glitches) {
  auto copy = std::make_unique<Utterance>(sentence);
  Signal& signal = copy->signal;
  std::vector<bool> measured = signal.measured;
  measured.resize(signal.frames(), true);
  for (const Glitch& glitch : glitches) {
    const auto control = std::find(signal.names.begin(), signal.names.end(), glitch.control);
    for (std::size_t i = glitch.first; i < glitch.first + glitch.frames; ++i) {
      signal.at(i, std::size_t(control - signal.names.begin())) =
          std::numeric_limits<double>::quiet_NaN();
      if (!glitch.bridged) measured[i] = false;
    }
  }
  leave_out_blanks(signal);  // straight lines
  signal.measured = std::move(measured);
  return copy;
}

}  // namespace

const char* glitch_name(GlitchKind kind) {
  switch (kind) {
    case GlitchKind::jump:
      return "jump";
    case GlitchKind::spike:
      return "spike";
    case GlitchKind::stuck:
      break;
  }
  return "stuck";
}

std::string describe(const Glitch& glitch) {
  const char* what = "is stuck from";
  if (glitch.kind == GlitchKind::jump) what = "jumps out of range at";
  if (glitch.kind == GlitchKind::spike) what = "has a spike at";
  char text[80];
  std::snprintf(text, sizeof text, " %s %.2f s, %zu frame%s; ", what, glitch.time, glitch.frames,
                glitch.frames == 1 ? "" : "s");
  return "sentence '" + glitch.id + "': " + glitch.control + text +
         (glitch.bridged ? "interpolated" : "left out");
}

CleanedSentences remove_glitches(std::span<const Utterance* const> sentences,
                                 ShortGlitches short_glitches) {
  CleanedSentences out;
  out.sentences.assign(sentences.begin(), sentences.end());
  if (sentences.empty() || !sound(sentences)) return out;
  const std::vector<std::string>& names = sentences[0]->signal.names;
  const auto limits = natural_limits(names);
  SpeechMasks speech;
  for (const Utterance* u : sentences) speech.push_back(speech_frames(*u));
  std::vector<std::vector<Glitch>> found(sentences.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    const Usual usual = usual_of(sentences, speech, c);
    std::vector<std::vector<FaultyRun>> runs;
    double frames = 0, bad = 0;
    for (std::size_t s = 0; s < sentences.size(); ++s) {
      runs.push_back(runs_of({sentences[s]->signal, c, speech[s]}, usual, limits[c]));
      frames += double(sentences[s]->signal.frames());
      for (const FaultyRun& run : runs.back()) bad += double(run.last - run.first);
    }
    const double nonsense = kNonsense * sentences[0]->signal.rate.frames_per_second();
    if (bad > std::max(nonsense, kTooMany * frames)) continue;
    for (std::size_t s = 0; s < sentences.size(); ++s) {
      const Signal& signal = sentences[s]->signal;
      for (const FaultyRun& run : runs[s])
        found[s].push_back({sentences[s]->id, names[c], run.kind, run.first, run.last - run.first,
                            signal.time(run.first),
                            short_glitches == ShortGlitches::interpolate &&
                                signal.rate.seconds(double(run.last - run.first)) <= kBridge});
    }
  }
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    if (found[s].empty()) continue;
    out.copies.push_back(mended(*sentences[s], found[s]));
    out.sentences[s] = out.copies.back().get();
    out.glitches.insert(out.glitches.end(), found[s].begin(), found[s].end());
  }
  return out;
}

}  // namespace animeme::dam
