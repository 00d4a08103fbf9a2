#include "tools/characters/capture/corpus_checks.h"

#include <algorithm>
#include <cmath>

#include "dam/signal/closure.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

constexpr double kShortPhone = 0.0351;  // seconds
constexpr double kLongPhone = 0.6;
constexpr double kManyShort = 1.0 / 3;  // of the phones
constexpr double kFast = 2;             // times the usual rate
constexpr std::size_t kFewestPhones = 5;
constexpr std::size_t kFewestForLag = 20;
constexpr int kLagSteps = 20;
constexpr double kLagStep = 0.01;

bool is_measured(const dam::Signal& signal, std::size_t frame) {
  return signal.measured.empty() || signal.measured[frame];
}

// The gap at a time, between frames; nothing outside.
std::optional<double> gap_at(const dam::Signal& signal, const dam::LipChannels& lips, double time) {
  const double position = time / signal.rate.seconds(1);
  if (position < 0 || position > double(signal.frames()) - 1) return std::nullopt;
  const auto frame = std::min(std::size_t(position), signal.frames() - 1);
  const std::size_t next = std::min(frame + 1, signal.frames() - 1);
  const double share = position - double(frame);
  return (1 - share) * dam::inner_gap(signal, frame, lips) +
         share * dam::inner_gap(signal, next, lips);
}

}  // namespace

Closures closures_of(const dam::Signal& signal, const dam::Script& script) {
  Closures out;
  const auto lips = dam::inner_lip_channels(signal.names);
  if (!lips) return out;
  for (const dam::Phone& phone : script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    const dam::FrameSpan span = dam::frames_near(signal, phone, dam::kClosureSearch);
    if (span.first >= span.last) continue;
    std::optional<double> least;
    for (std::size_t i = span.first; i < span.last; ++i) {
      if (!is_measured(signal, i)) continue;
      const double gap = dam::inner_gap(signal, i, *lips);
      least = least ? std::min(*least, gap) : gap;
    }
    if (!least) continue;
    ++out.phones;
    out.closed += *least < kClosedGap ? 1 : 0;
    out.gaps.push_back(int(std::lround(*least)));
  }
  return out;
}

double phone_rate(const dam::Script& script) {
  double seconds = 0;
  std::size_t count = 0;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label == dam::kSilence) continue;
    seconds += phone.duration();
    ++count;
  }
  return seconds > 0 ? double(count) / seconds : 0;
}

std::vector<std::string> doubts_about(const dam::Script& script, const Closures& closures,
                                      double usual) {
  std::vector<std::string> doubts;
  if (closures.phones >= 2 && closures.closed * 2 < closures.phones) {
    doubts.push_back(format("only %zu of %zu P B M are closed", closures.closed, closures.phones));
  }
  std::size_t spoken = 0;
  std::size_t brief = 0;
  const dam::Phone* longest = nullptr;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label == dam::kSilence) continue;
    ++spoken;
    brief += phone.duration() <= kShortPhone ? 1 : 0;
    if (longest == nullptr || phone.duration() > longest->duration()) longest = &phone;
  }
  if (spoken == 0) {
    doubts.emplace_back("it contains no speech");
    return doubts;
  }
  if (spoken >= kFewestPhones && double(brief) >= kManyShort * double(spoken)) {
    doubts.push_back(format("%zu of %zu phones have the aligner's minimum length", brief, spoken));
  }
  if (longest->duration() > kLongPhone) {
    doubts.push_back(format("the %s at %.2f s lasts %.2f s", longest->label.c_str(), longest->start,
                            longest->duration()));
  }
  const double rate = phone_rate(script);
  if (usual > 0 && spoken >= kFewestPhones && (rate > kFast * usual || rate < usual / kFast)) {
    doubts.push_back(format("%.3g phones a second; %.3g are usual here", rate, usual));
  }
  return doubts;
}

std::optional<double> lag_of_lips(const std::vector<const dam::Signal*>& signals,
                                  const std::vector<const dam::Script*>& scripts) {
  std::optional<double> best;
  double least = 0;
  for (int step = -kLagSteps; step <= kLagSteps; ++step) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const auto lips = dam::inner_lip_channels(signals[i]->names);
      if (!lips) return std::nullopt;
      const auto& phones = scripts[i]->phones;
      for (std::size_t p = 1; p + 1 < phones.size(); ++p) {
        const dam::Phone& phone = phones[p];
        // Next to silence the duration of the closure is unknown.
        if (!dam::is_bilabial(phone.label) || phones[p - 1].label == dam::kSilence ||
            phones[p + 1].label == dam::kSilence) {
          continue;
        }
        const double middle = (phone.start + phone.end) / 2;
        // The same phones for each shift.
        if (!gap_at(*signals[i], *lips, middle - kLagSteps * kLagStep) ||
            !gap_at(*signals[i], *lips, middle + kLagSteps * kLagStep)) {
          continue;
        }
        sum += *gap_at(*signals[i], *lips, middle + step * kLagStep);
        ++count;
      }
    }
    if (count < kFewestForLag) return std::nullopt;
    if (!best || sum < least) {
      best = step * kLagStep;
      least = sum;
    }
  }
  return best;
}

}  // namespace animeme::tools
