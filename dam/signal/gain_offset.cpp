#include "dam/signal/gain_offset.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "fap/detail/text_scanner.h"

namespace animeme::dam {
namespace {

constexpr double kTelling = 0.5;    // of what is typical
constexpr double kNothing = 0.001;  // of the largest value
constexpr double kRounding = 1e-6;  // of the largest value
constexpr double kMost = 1e100;     // squares of more have no end

std::string key_of(std::string_view label) {
  const std::string key = fap::detail::lower_case(label);
  return key == "neutral" || key == "sil" ? "rest" : key;
}

Result<void> check(const Poses& poses, const char* whose) {
  const auto fault = [&](const std::string& what) {
    return make_error(Code::invalid_argument, std::string(whose) + what);
  };
  if (poses.values.size() != poses.names.size() * poses.labels.size())
    return fault(" poses: the number of values is not poses times controls");
  for (const double value : poses.values)
    if (std::abs(value) > kMost) return fault(" poses have a value beyond 1e100");
  std::set<std::string> seen;
  for (const std::string& name : poses.names)
    if (!seen.insert(name).second) return fault(" poses have the control " + name + " twice");
  seen.clear();
  for (const std::string& label : poses.labels)
    if (!seen.insert(key_of(label)).second) return fault(" poses have " + label + " twice");
  return {};
}

/// A value of the first face and the one that it has to become.
struct Pair {
  double from = 0, to = 0;
  bool rest = false;
};

/// The poses of one control that both faces have.
std::vector<Pair> pairs_of(const Poses& from, std::size_t control, const Poses& to,
                           std::size_t other) {
  std::vector<Pair> pairs;
  for (std::size_t p = 0; p < from.labels.size(); ++p) {
    const std::string key = key_of(from.labels[p]);
    for (std::size_t q = 0; q < to.labels.size(); ++q) {
      if (key_of(to.labels[q]) != key) continue;
      const Pair pair{from.at(p, control), to.at(q, other), key == "rest"};
      if (!std::isnan(pair.from) && !std::isnan(pair.to)) pairs.push_back(pair);
    }
  }
  return pairs;
}

/// What differences are taken from: rest, else the mean of all.
Pair middle_of(const std::vector<Pair>& pairs) {
  Pair middle;
  for (const Pair& pair : pairs) {
    if (pair.rest) return pair;
    middle.from += pair.from / double(pairs.size());
    middle.to += pair.to / double(pairs.size());
  }
  return middle;
}

/// The gain by least squares; nothing if the first face moves by less than `least`.
std::optional<double> gain_of(const std::vector<Pair>& pairs, const Pair& middle, double least) {
  double square = 0, product = 0, largest = 0;
  for (const Pair& pair : pairs) {
    const double from = pair.from - middle.from;
    square += from * from;
    product += from * (pair.to - middle.to);
    largest = std::max(largest, std::abs(from));
  }
  if (!(square > 0) || largest < least) return std::nullopt;
  return product / square;
}

double missed(const std::vector<Pair>& pairs, double gain, double offset) {
  double sum = 0;
  for (const Pair& pair : pairs) {
    const double off = pair.to - gain * pair.from - offset;
    sum += off * off;
  }
  return std::sqrt(sum / double(pairs.size()));
}

/// The largest value that either face has there.
double largest_of(const std::vector<Pair>& pairs) {
  double largest = 0;
  for (const Pair& pair : pairs)
    largest = std::max({largest, std::abs(pair.from), std::abs(pair.to)});
  return largest;
}

double least_telling(const std::vector<Pair>& pairs, std::span<const double> typical,
                     std::size_t control) {
  if (!typical.empty()) return kTelling * typical[control];
  return kNothing * largest_of(pairs);
}

double middle_gain(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

bool is_rest_pose(std::string_view label) { return key_of(label) == "rest"; }

Result<std::vector<GainOffset>> fit_gain_offset(const Poses& from, const Poses& to,
                                                std::span<const double> typical) {
  if (auto good = check(from, "the first face's"); !good) return good.error();
  if (auto good = check(to, "the second face's"); !good) return good.error();
  if (!typical.empty() && typical.size() != from.names.size())
    return make_error(Code::invalid_argument, "typical motion must have one value per control");
  const std::size_t count = from.names.size();
  std::vector<GainOffset> out(count);
  std::vector<std::vector<Pair>> pairs(count);
  std::vector<double> gains;
  bool common = false;
  for (std::size_t c = 0; c < count; ++c) {
    const auto other = std::find(to.names.begin(), to.names.end(), from.names[c]);
    if (other == to.names.end()) continue;
    common = true;
    pairs[c] = pairs_of(from, c, to, std::size_t(other - to.names.begin()));
    out[c].poses = pairs[c].size();
    if (pairs[c].empty()) continue;
    out[c].source = GainSource::others;
    const auto gain = gain_of(pairs[c], middle_of(pairs[c]), least_telling(pairs[c], typical, c));
    if (!gain) continue;
    out[c].source = GainSource::poses;
    out[c].gain = *gain;
    gains.push_back(*gain);
  }
  if (!common) return make_error(Code::not_found, "the two faces have no control in common");
  if (gains.empty())
    return make_error(Code::not_found,
                      "no common pose moves a control, so the gains cannot be determined");
  const double usual = middle_gain(gains);
  for (std::size_t c = 0; c < count; ++c) {
    GainOffset& one = out[c];
    if (one.source == GainSource::none) continue;
    if (one.source == GainSource::others) one.gain = usual;
    const Pair middle = middle_of(pairs[c]);
    one.offset = middle.to - one.gain * middle.from;
    one.residual = missed(pairs[c], one.gain, one.offset);
    // What tables round off is no offset.
    const double nothing = kRounding * largest_of(pairs[c]);
    if (std::abs(one.offset) <= nothing) one.offset = 0;
    if (one.residual <= nothing) one.residual = 0;
  }
  return out;
}

void apply_gain_offset(Signal& signal, std::span<const GainOffset> gains) {
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    const GainOffset& one = gains[i % gains.size()];
    signal.values[i] = one.gain * signal.values[i] + one.offset;
  }
}

}  // namespace animeme::dam
