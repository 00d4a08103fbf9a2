#include "tools/speech/talking/utterance_times.h"

#include <algorithm>
#include <utility>

namespace animeme::speech {

namespace {

constexpr double kShortest = 0.0005;  // seconds: what is shorter is a rounding error
constexpr double kLasting = 0.3;      // seconds that a sound may last without being told

void add_silence(dam::Script& script, double end) {
  const double start = script.duration();
  if (end <= start) return;
  if (!script.phones.empty() &&
      (end - start < kShortest || script.phones.back().label == dam::kSilence)) {
    script.phones.back().end = end;
  } else {
    script.phones.push_back({start, end, std::string(dam::kSilence), {}});
  }
}

}  // namespace

void UtteranceTimes::add(const dam::Script& script, double from, bool lasting) {
  std::vector<dam::Phone> added;
  for (dam::Phone phone : script.phones) {
    if (phone.label == dam::kSilence) continue;
    phone.start += from;
    phone.end += from;
    added.push_back(std::move(phone));
  }
  known_ = std::max(known_, script.duration() + from);
  if (added.empty()) return;
  const double first = added.front().start, last = added.back().end;
  auto place = std::find_if(phones_.begin(), phones_.end(), [first](const dam::Phone& phone) {
    return phone.start >= first - kShortest;
  });
  if (place != phones_.begin()) {
    dam::Phone& before = *(place - 1);
    if (before.end > first || (lasting && first - before.end < kLasting)) before.end = first;
    if (before.end - before.start < kShortest) place = phones_.erase(place - 1);
  }
  const auto rest = std::find_if(place, phones_.end(), [last](const dam::Phone& phone) {
    return phone.start >= last - kShortest;
  });
  place = phones_.erase(place, rest);
  phones_.insert(place, added.begin(), added.end());
}

UtterancePart UtteranceTimes::between(double begin, double end, const dam::Script* heard) const {
  UtterancePart part;
  const double length = end - begin;
  const auto put = [&](const dam::Phone& phone, double start, double stop) {
    if (stop - start < kShortest) return;
    add_silence(part.script, start);
    dam::Phone shown = phone;
    shown.start = part.script.duration();
    shown.end = stop;
    part.script.phones.push_back(std::move(shown));
  };
  for (const dam::Phone& phone : phones_) {
    const double start = std::max(phone.start, begin) - begin;
    const double stop = std::min(phone.end, end) - begin;
    if (stop <= start) continue;
    if (part.script.phones.empty() && phone.start < begin - kShortest) {
      part.goes_on = stop - start >= kShortest;
    }
    put(phone, start, stop);
  }
  const double untold = std::max(known_ - begin, 0.0);
  if (heard != nullptr && untold < length) {
    for (const dam::Phone& phone : heard->phones) {
      if (phone.label == dam::kSilence) continue;
      put(phone, std::max({phone.start, untold, part.script.duration()}),
          std::min(phone.end, length));
    }
  }
  add_silence(part.script, length);
  for (const dam::ScriptWord& word : dam::words_of({phones_})) {
    if (word.start < begin - kShortest || word.start >= end - kShortest) continue;
    dam::ScriptWord shown = word;
    shown.start -= begin;
    shown.end -= begin;
    part.words.push_back(std::move(shown));
  }
  return part;
}

void UtteranceTimes::forget(double time) {
  auto kept = std::find_if(phones_.begin(), phones_.end(),
                           [time](const dam::Phone& phone) { return phone.end >= time; });
  // The phones of a word stay together: the first one says where it begins.
  while (kept != phones_.begin() && kept != phones_.end() && !kept->word.empty() &&
         (kept - 1)->word == kept->word) {
    --kept;
  }
  phones_.erase(phones_.begin(), kept);
}

}  // namespace animeme::speech
