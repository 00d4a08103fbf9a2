#include "tools/characters/capture/corpus_signal.h"

#include <algorithm>
#include <cmath>

#include "dam/signal/fap_signal.h"

namespace animeme::tools {

Result<dam::Signal> curves_of(const CapturedFace& face, double start, double seconds) {
  const fap::Rate rate = face.clip.rate;
  const std::int64_t shift = std::llround(start * rate.frames_per_second());
  CapturedFace moved;
  moved.clip.rate = rate;
  for (fap::Frame frame : face.clip.frames) {
    frame.number += shift;
    if (frame.number >= 0) moved.clip.frames.push_back(frame);
  }
  for (const std::int64_t number : face.made) moved.made.push_back(number + shift);
  if (moved.clip.frames.empty()) {
    return make_error(Code::not_found, "the capture ends before its sound begins");
  }
  const std::int64_t first = moved.clip.frames.front().number;
  if (first > 0) {
    fap::Frame held = moved.clip.frames.front();
    held.number = 0;
    moved.clip.frames.insert(moved.clip.frames.begin(), held);
    moved.made.push_back(0);
  }
  auto signal = dam::to_signal(moved.clip);
  if (!signal) return signal.error();
  mark_made(*signal, moved.made);
  const std::size_t channels = signal->names.size();
  const std::size_t frames = signal->frames();
  const std::size_t wanted =
      seconds > 0
          ? std::max<std::size_t>(1, std::size_t(std::llround(seconds * rate.frames_per_second())))
          : frames;
  if (signal->measured.empty()) signal->measured.assign(frames, true);
  if (wanted <= frames) {
    signal->values.resize(wanted * channels);
  } else {
    const std::vector<double> last(signal->values.end() - std::ptrdiff_t(channels),
                                   signal->values.end());
    for (std::size_t i = frames; i < wanted; ++i) {
      signal->values.insert(signal->values.end(), last.begin(), last.end());
    }
  }
  signal->measured.resize(wanted, false);
  return signal;
}

dam::Signal at_rate(const dam::Signal& signal, fap::Rate rate) {
  dam::Signal out{rate, 0, signal.names, {}, {}};
  const double step = signal.rate.frames_per_second() / rate.frames_per_second();
  const auto frames =
      std::size_t(std::max<long long>(1, std::llround(double(signal.frames()) / step)));
  for (std::size_t i = 0; i < frames; ++i) {
    const double position = std::min(double(i) * step, double(signal.frames() - 1));
    const auto before = std::size_t(position);
    const std::size_t behind = std::min(before + 1, signal.frames() - 1);
    const double share = position - double(before);
    for (std::size_t c = 0; c < signal.names.size(); ++c) {
      out.values.push_back((1 - share) * signal.at(before, c) + share * signal.at(behind, c));
    }
    out.measured.push_back(signal.measured.empty() ||
                           (signal.measured[before] && (share == 0 || signal.measured[behind])));
  }
  return out;
}

std::size_t measured_frames(const dam::Signal& signal) {
  if (signal.measured.empty()) return signal.frames();
  return std::size_t(std::count(signal.measured.begin(), signal.measured.end(), true));
}

std::vector<std::string> keep_common_controls(std::vector<dam::Signal*>& signals) {
  std::vector<std::string> common;
  if (signals.empty()) return common;
  for (const std::string& name : signals[0]->names) {
    const bool all = std::all_of(signals.begin(), signals.end(), [&](const dam::Signal* signal) {
      return std::find(signal->names.begin(), signal->names.end(), name) != signal->names.end();
    });
    if (all) common.push_back(name);
  }
  for (dam::Signal* signal : signals) {
    if (signal->names == common) continue;
    std::vector<std::size_t> from;
    for (const std::string& name : common) {
      const auto at = std::find(signal->names.begin(), signal->names.end(), name);
      from.push_back(std::size_t(at - signal->names.begin()));
    }
    dam::Signal kept{signal->rate, 0, common, {}, signal->measured};
    for (std::size_t i = 0; i < signal->frames(); ++i) {
      for (const std::size_t c : from) kept.values.push_back(signal->at(i, c));
    }
    *signal = std::move(kept);
  }
  return common;
}

void extend_with_silence(dam::Script& script, double seconds) {
  if (script.phones.empty() || !(seconds > script.duration())) return;
  if (script.phones.back().label == dam::kSilence) {
    script.phones.back().end = seconds;
  } else {
    script.phones.push_back({script.duration(), seconds, std::string(dam::kSilence), {}});
  }
}

}  // namespace animeme::tools
