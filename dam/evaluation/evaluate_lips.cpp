// Lip-tooth contact of F and V, and rounded sounds.
#include <algorithm>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"
#include "dam/script/phones.h"
#include "dam/signal/closure.h"

namespace animeme::dam {
namespace {

constexpr double kMedian = 0.5;

/// One value a phone, from both sides.
struct PhoneValues {
  std::vector<double> synthesised, recorded;
};

/// The extreme value of a series from 40 ms before to 40 ms after the phones that are wanted.
template <class Wanted, class Better>
PhoneValues extremes(const AllSeries& all, std::size_t series, Wanted wanted, Better better) {
  PhoneValues out;
  for (const PairSeries& pair : all) {
    for (const Phone& phone : pair.script().phones) {
      const PhoneInfo* info = find_phone(phone.label);
      if (info == nullptr || !wanted(*info)) continue;
      const FrameSpan span = frames_near(pair.signal(), phone, kClosureSearch);
      if (span.first >= span.last) continue;
      const auto extreme = [&](const std::vector<double>& values) {
        double best = values[span.first];
        for (std::size_t i = span.first; i < span.last; ++i)
          if (better(values[i], best)) best = values[i];
        return best;
      };
      out.synthesised.push_back(extreme(pair.synthesised[series]));
      out.recorded.push_back(extreme(pair.recorded[series]));
    }
  }
  return out;
}

double share_from(const std::vector<double>& values, double level) {
  const auto reach = [&](double v) { return v >= level; };
  return double(std::count_if(values.begin(), values.end(), reach)) / double(values.size());
}

Comparison compare(const PhoneValues& values) {
  Comparison sums;
  for (std::size_t i = 0; i < values.synthesised.size(); ++i)
    sums.add(values.synthesised[i], values.recorded[i]);
  return sums;
}

ContactScore score_contact(const AllSeries& all, std::size_t lower_lip, double slack) {
  const PhoneValues values = extremes(
      all, lower_lip, [](const PhoneInfo& p) { return p.labiodental; }, std::greater<>());
  ContactScore out;
  out.phones = values.synthesised.size();
  if (out.phones == 0) return out;
  std::vector<double> sorted = values.recorded;
  out.level = percentile(sorted, kMedian) - slack;
  out.measured = share_from(values.recorded, out.level);
  out.predicted = share_from(values.synthesised, out.level);
  out.difference = compare(values).mean_difference();
  return out;
}

RoundingScore score_rounding(const AllSeries& all, std::size_t width) {
  const PhoneValues values = extremes(
      all, width, [](const PhoneInfo& p) { return p.rounded; }, std::less<>());
  RoundingScore out;
  out.phones = values.synthesised.size();
  if (out.phones == 0) return out;
  Comparison speech;
  for (const PairSeries& pair : all)
    for (std::size_t i = 0; i < pair.frames(); ++i)
      if (pair.speech[i]) speech.add(pair.recorded[width][i], 0);
  const Comparison least = compare(values);
  out.measured = speech.mean_difference() - least.y / least.n;
  out.predicted = speech.mean_difference() - least.x / least.n;
  out.rmse = least.rmse();
  out.correlation = least.correlation();
  return out;
}

}  // namespace

void score_lips(const Layout& layout, const AllSeries& all, const ScoreOptions& options,
                Evaluation& result) {
  if (layout.lower_lip >= 0)
    result.contact = score_contact(all, std::size_t(layout.lower_lip), options.contact_slack);
  if (layout.width >= 0) result.rounding = score_rounding(all, std::size_t(layout.width));
}

}  // namespace animeme::dam
