#include "tools/speech/voice/phone_paths.h"

#include <algorithm>
#include <cmath>

namespace animeme::voice {

namespace {

constexpr std::size_t kParts = kStatesPerPhone;
constexpr float kLeast = 1e-20f;  // no state is ever impossible: after a click all would be lost

// 0..1 for a path and a frame: SplitMix64.
double chance_of(std::uint64_t path, std::uint64_t frame) {
  std::uint64_t z = (path + 1) * 0x9e3779b97f4a7c15u + frame * 0xd1342543de82ef95u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return double(z >> 11) / 9007199254740992.0;
}

}  // namespace

PhonePaths::PhonePaths(const SoundModel& model, std::vector<double> pairs,
                       const PathOptions& options)
    : phones_(model.phones.size()), options_(options), stay_(model.stay) {
  pairs_.resize(phones_ * phones_);
  for (std::size_t from = 0; from < phones_; ++from) {
    for (std::size_t to = 0; to < phones_; ++to) {
      pairs_[to * phones_ + from] =
          options.insertion * std::pow(pairs[from * phones_ + to], options.language);
    }
  }
}

void PhonePaths::push(std::span<const float> scores) {
  const float best = *std::max_element(scores.begin(), scores.end());
  std::vector<float> now(scores.size());
  const auto fit = [&](std::size_t state) {
    return std::exp(float(options_.sound) * (scores[state] - best));
  };
  if (past_.empty()) {
    for (std::size_t phone = 0; phone < phones_; ++phone) now[phone * kParts] = fit(phone * kParts);
  } else {
    const std::vector<float>& then = past_.back();
    std::vector<double> leaving(phones_);
    for (std::size_t phone = 0; phone < phones_; ++phone) {
      const std::size_t last = phone * kParts + kParts - 1;
      leaving[phone] = double(then[last]) * double(1 - stay_[last]);
    }
    for (std::size_t phone = 0; phone < phones_; ++phone) {
      double in = 0;
      for (std::size_t from = 0; from < phones_; ++from) {
        in += leaving[from] * pairs_[phone * phones_ + from];
      }
      for (std::size_t part = 0; part < kParts; ++part) {
        const std::size_t state = phone * kParts + part;
        const double held = double(then[state]) * double(stay_[state]);
        now[state] = float((held + in) * double(fit(state)));
        in = double(then[state]) * double(1 - stay_[state]);
      }
    }
  }
  float sum = 0;
  for (const float value : now) sum += value;
  if (!(sum > 0)) sum = 1;
  for (float& value : now) value = std::max(value / sum, kLeast);
  past_.push_back(std::move(now));
}

Path PhonePaths::draw(std::size_t from, std::uint64_t number) const {
  Path path(frames() - from);
  if (path.empty()) return path;
  std::size_t state = 0;
  std::vector<double> chances(phones_);
  for (std::size_t frame = frames(); frame-- > from;) {
    const std::vector<float>& now = past_[frame - first_];
    double luck = chance_of(number, frame);
    if (frame + 1 == frames()) {
      double sum = 0;
      for (const float value : now) sum += double(value);
      luck *= sum;
      while (state + 1 < now.size() && luck >= double(now[state])) luck -= double(now[state++]);
    } else {
      // Held, or come from the part before, or from the end of any phone.
      const std::size_t phone = state / kParts, part = state % kParts;
      const double held = double(now[state]) * double(stay_[state]);
      if (part > 0) {
        const double moved = double(now[state - 1]) * double(1 - stay_[state - 1]);
        if (luck * (held + moved) >= held) --state;
      } else {
        double sum = held;
        for (std::size_t before = 0; before < phones_; ++before) {
          const std::size_t last = before * kParts + kParts - 1;
          chances[before] =
              double(now[last]) * double(1 - stay_[last]) * pairs_[phone * phones_ + before];
          sum += chances[before];
        }
        luck *= sum;
        if (luck >= held) {
          luck -= held;
          std::size_t before = 0;
          while (before + 1 < phones_ && luck >= chances[before]) luck -= chances[before++];
          state = before * kParts + kParts - 1;
        }
      }
    }
    path[frame - from] = std::uint8_t(state / kParts);
  }
  return path;
}

void PhonePaths::forget(std::size_t before) {
  while (first_ < before && past_.size() > 1) {
    past_.pop_front();
    ++first_;
  }
}

}  // namespace animeme::voice
