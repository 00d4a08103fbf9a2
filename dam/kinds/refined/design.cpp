#include <algorithm>
#include <cmath>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/refined/dominance.h"
#include "dam/kinds/refined/fit.h"

namespace animeme::dam {

std::vector<Neighbourhood> neighbourhoods(const SpeechData& speech,
                                          std::span<const PhoneModel> phones) {
  std::vector<Neighbourhood> list(speech.occurrences.size());
  for (const FitSentence& sentence : speech.sentences) {
    SpeechClock clock;
    for (std::size_t i = 0; i < sentence.occurrences; ++i) {
      const std::size_t j = sentence.first_occurrence + i;
      const FitOccurrence& o = speech.occurrences[j];
      Neighbourhood& here = list[j];
      here.phone = o.phone;
      here.duration = o.duration;
      here.left = o.left;
      here.right = o.right;
      if (o.left != kRestContext) here.left_2 = speech.occurrences[j - 1].left;
      here.since = clock.since(o.start, o.end(), is_silence(phones, o.phone));
      if (o.right == kRestContext) continue;
      here.right_2 = speech.occurrences[j + 1].right;
      here.next_duration = speech.occurrences[j + 1].duration;
    }
  }
  return list;
}

namespace {

/// Per frame: strengths of the phones in reach, not divided by their sum yet.
void add_parts(const RefinedData& data, const FitSentence& sentence, std::size_t index,
               std::span<const PhoneDominance> dominance,
               std::vector<std::vector<RefinedPart>>& frames) {
  const FitOccurrence& o = data.speech->occurrences[index];
  const auto phone = std::size_t(o.phone);
  const PhoneDominance& d = dominance[phone];
  const double rate = data.speech->rate;
  const double strength = d.strength * duration_strength(o.duration, data.phones[phone].duration,
                                                         data.duration_exponent);
  const auto limit = [&](double frame) {
    return std::size_t(std::clamp(frame, 0.0, double(sentence.frames)));
  };
  const std::size_t first = limit(std::ceil((o.start - reach_before(d)) * rate));
  const std::size_t last = limit(std::floor((o.end() + reach_after(d)) * rate) + 1);
  for (std::size_t i = first; i < last; ++i) {
    const double t = double(i) / rate;
    const double before = std::max(0.0, o.start - t), after = std::max(0.0, t - o.end());
    RefinedPart part;
    part.occurrence = std::uint32_t(index);
    part.phone = std::uint32_t(phone);
    part.weight = strength * fall_off(d, before, after);
    part.before = before / d.left * (before / d.left);
    part.after = after / d.right * (after / d.right);
    refined_basis((t - o.start) / o.duration, data.time_margin, part.basis);
    frames[i].push_back(part);
  }
}

}  // namespace

RefinedDesign make_refined_design(const RefinedData& data, const FitSentence& sentence,
                                  std::span<const PhoneDominance> dominance) {
  std::vector<std::vector<RefinedPart>> frames(sentence.frames);
  for (std::size_t i = 0; i < sentence.occurrences; ++i)
    add_parts(data, sentence, sentence.first_occurrence + i, dominance, frames);
  RefinedDesign design;
  for (std::vector<RefinedPart>& parts : frames) {
    design.begin.push_back(design.parts.size());
    double sum = 0;
    for (const RefinedPart& part : parts) sum += part.weight;
    for (RefinedPart& part : parts) {
      part.weight /= std::max(sum, 1e-12);
      design.parts.push_back(part);
    }
  }
  design.begin.push_back(design.parts.size());
  return design;
}

}  // namespace animeme::dam
