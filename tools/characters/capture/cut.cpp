#include "tools/characters/capture/cut.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dam/script/phones.h"

namespace animeme::tools {

namespace {

constexpr double kLeastPause = 0.12;  // seconds
constexpr double kLeastPart = 2;      // of sound on both sides of a cut
constexpr double kKeptPause = 0.5;    // at the ends of a sentence

bool silent(const dam::Phone& phone) { return phone.label == dam::kSilence; }

// Phones [first, last) that begin and end with sound; nothing: there is none.
using Range = std::pair<std::size_t, std::size_t>;

std::optional<Range> without_pauses(const dam::Script& script, Range range) {
  while (range.first < range.second && silent(script.phones[range.first])) ++range.first;
  while (range.first < range.second && silent(script.phones[range.second - 1])) --range.second;
  if (range.first == range.second) return std::nullopt;
  return range;
}

void cut(const dam::Script& script, Range range, double most, std::vector<Range>& parts) {
  const auto trimmed = without_pauses(script, range);
  if (!trimmed) return;
  const double begin = script.phones[trimmed->first].start;
  const double end = script.phones[trimmed->second - 1].end;
  std::size_t best = 0;
  double longest = kLeastPause;
  if (end - begin > most) {
    for (std::size_t i = trimmed->first; i < trimmed->second; ++i) {
      const dam::Phone& phone = script.phones[i];
      if (!silent(phone) || phone.start - begin < kLeastPart || end - phone.end < kLeastPart) {
        continue;
      }
      if (phone.end - phone.start < longest) continue;
      if (best != 0 && phone.end - phone.start == longest) continue;
      longest = phone.end - phone.start;
      best = i;
    }
  }
  if (best == 0) {
    parts.push_back(*trimmed);
    return;
  }
  cut(script, {trimmed->first, best}, most, parts);
  cut(script, {best + 1, trimmed->second}, most, parts);
}

}  // namespace

std::vector<Stretch> cut_at_pauses(const dam::Script& script, fap::Rate rate, std::size_t frames,
                                   double most) {
  std::vector<Range> parts;
  if (most > 0 && rate.seconds(double(frames)) > most) {
    cut(script, {0, script.phones.size()}, most, parts);
  }
  if (parts.size() < 2) return {{0, frames}};
  std::vector<Stretch> out;
  const double per_second = rate.frames_per_second();
  double before = 0;  // the end of the sound before
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double begin = script.phones[parts[i].first].start;
    const double end = script.phones[parts[i].second - 1].end;
    const double next = i + 1 < parts.size() ? script.phones[parts[i + 1].first].start
                                             : std::max(end, rate.seconds(double(frames)));
    const double low = std::max(begin - kKeptPause, i == 0 ? 0 : 0.5 * (before + begin));
    const double high =
        std::min(end + kKeptPause, i + 1 < parts.size() ? 0.5 * (end + next) : next);
    before = end;
    const auto first = std::size_t(std::max(0.0, std::ceil(low * per_second - 1e-9)));
    const auto last = std::min(frames, std::size_t(std::floor(high * per_second + 1e-9)));
    if (last > first + 1) out.push_back({first, last});
  }
  return out;
}

dam::Script part_of(const dam::Script& script, fap::Rate rate, Stretch stretch) {
  const double begin = rate.seconds(double(stretch.first)),
               end = rate.seconds(double(stretch.last));
  dam::Script part;
  for (dam::Phone phone : script.phones) {
    phone.start = std::max(phone.start, begin) - begin;
    phone.end = std::min(phone.end, end) - begin;
    if (phone.end > phone.start) part.phones.push_back(std::move(phone));
  }
  return part;
}

dam::Signal part_of(const dam::Signal& signal, Stretch stretch) {
  dam::Signal part;
  part.rate = signal.rate;
  part.names = signal.names;
  const auto width = std::ptrdiff_t(signal.names.size());
  part.values.assign(signal.values.begin() + std::ptrdiff_t(stretch.first) * width,
                     signal.values.begin() + std::ptrdiff_t(stretch.last) * width);
  if (!signal.measured.empty()) {
    part.measured.assign(signal.measured.begin() + std::ptrdiff_t(stretch.first),
                         signal.measured.begin() + std::ptrdiff_t(stretch.last));
  }
  return part;
}

media::Pcm part_of(const media::Pcm& sound, fap::Rate rate, Stretch stretch) {
  media::Pcm part;
  part.sample_rate = sound.sample_rate;
  const auto sample = [&](std::size_t frame) {
    const double at = rate.seconds(double(frame)) * double(sound.sample_rate);
    return std::min(sound.samples.size(), std::size_t(std::llround(at)));
  };
  part.samples.assign(sound.samples.begin() + std::ptrdiff_t(sample(stretch.first)),
                      sound.samples.begin() + std::ptrdiff_t(sample(stretch.last)));
  return part;
}

}  // namespace animeme::tools
