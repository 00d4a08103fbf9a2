// The file of sums. Layout: dam/training/README.md.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "dam/kinds/refined/terms.h"
#include "dam/model/bytes_internal.h"
#include "dam/model/file_frame_internal.h"
#include "dam/training/accumulate.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {
namespace {

constexpr FileFormat kSumsFormat{"ANIMESUM", 4, 0, "file of sums",
                                 "accumulate its sentences again"};

constexpr std::uint64_t kMostCount = std::uint64_t(1) << 48;

Error damaged_sums(const std::string& how) { return damaged_file(kSumsFormat, how); }

void write_base(const SumsState& state, ByteWriter& out) {
  const SumsBase& base = state.base;
  out.put(base.pause_edge, base.refined.time_margin, base.refined.duration_exponent,
          base.offset_frames);
  out.count(base.phones.size());
  for (std::size_t p = 0; p < base.phones.size(); ++p) {
    const PhoneModel& phone = base.phones[p];
    const PhoneDominance& d = base.refined.dominance[p];
    const PhoneSums& sums = state.phones[p];
    out.put(phone.label, phone.context_class, phone.duration, d.left, d.right, d.strength,
            sums.examples, sums.log_duration, sums.longest);
  }
}

/// A number and its partner, many times: a histogram, the sentences.
template <class Pairs>
void write_pairs(const Pairs& pairs, ByteWriter& out) {
  out.count(pairs.size());
  for (const auto& [first, second] : pairs) out.put(first, second);
}

void write_statistics(const SumsState& state, ByteWriter& out) {
  out.put(state.rate.num, state.rate.den, state.speech_frames, state.rest_frames);
  out.count(state.controls.size());
  for (const ControlSums& c : state.controls)
    out.put(c.name, c.low, c.high, c.sum, c.squares, c.rest_sum);
  write_pairs(state.closures.counts, out);
  write_pairs(state.lip_tooth.counts, out);
  const ShutTotals& shut = state.shut;
  out.put(shut.count, shut.phone, shut.shut, shut.phone_squared, shut.both);
  write_pairs(state.sentences, out);
}

/// In the order of the space, whatever order its unknowns came in.
void write_fit(const FitSums& fit, const std::vector<std::size_t>& rows, ByteWriter& out) {
  out.put(fit.sentences, fit.frames, fit.bound.bits(), fit.energy, fit.level);
  const std::size_t n = rows.size(), columns = fit.energy.size();
  for (const std::size_t row : rows) out.put(std::span(fit.right).subspan(row * columns, columns));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) out.put(fit.gram.at(rows[i], rows[j]).bits());
}

// ---- reading ----

/// A problem in words, empty: none.
using Problem = std::string;

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool between(double x, double low, double high) { return x >= low && x <= high; }

/// The phones of the file by label; `number` gets the place of each among those of this version.
Problem read_phones(ByteReader& in, SumsState& state, std::vector<std::uint32_t>& number) {
  const auto& known = state.base.phones;
  std::size_t next = 0;
  for (std::size_t left = in.count(4 + 4 + 4 * 8 + 8 + 3 * 8); left > 0; --left) {
    const auto label = in.next<std::string>();
    while (next < known.size() && known[next].label != label) ++next;
    if (next == known.size()) return "phone '" + label + "' is not known or out of order";
    const auto group = in.next<std::uint32_t>();
    PhoneModel& phone = state.base.phones[next];
    PhoneDominance& d = state.base.refined.dominance[next];
    PhoneSums& sums = state.phones[next];
    in.get(phone.duration, d.left, d.right, d.strength, sums.examples, sums.log_duration,
           sums.longest);
    const bool fine = between(phone.duration, 1e-6, 1e6) && between(d.left, 1e-9, 10) &&
                      between(d.right, 1e-9, 10) && between(d.strength, 1e-9, 1e6) &&
                      between(sums.longest, 0, 1e6);
    if (!fine || group != phone.context_class) return "phone " + label + " is out of range";
    number.push_back(std::uint32_t(next++));
  }
  return {};
}

Problem read_base(ByteReader& in, SumsState& state, std::vector<std::uint32_t>& number) {
  SumsBase& base = state.base;
  in.get(base.pause_edge, base.refined.time_margin, base.refined.duration_exponent,
         base.offset_frames);
  if (!between(base.pause_edge, 0, 1e6) || !between(base.refined.time_margin, 0, 100) ||
      !between(base.refined.duration_exponent, 0, 2) || !between(base.offset_frames, 0.01, 1e9))
    return "a setting is out of range";
  return read_phones(in, state, number);
}

Problem read_histogram(ByteReader& in, Histogram& histogram) {
  for (std::size_t left = in.count(4 + 8); left > 0; --left) {
    const auto bin = in.next<std::int32_t>();
    const auto count = in.next<std::uint64_t>();
    const bool ascending = histogram.counts.empty() || bin > histogram.counts.rbegin()->first;
    if (!ascending || std::abs(double(bin)) > Histogram::kLastBin || count == 0 ||
        count > kMostCount)
      return "a count is out of range";
    histogram.counts[bin] = count;
  }
  return {};
}

Problem read_controls(ByteReader& in, SumsState& state) {
  state.controls.resize(in.count(4 + 8 * 8));
  for (ControlSums& c : state.controls) {
    in.get(c.name, c.low, c.high, c.sum, c.squares, c.rest_sum);
    const bool range =
        state.speech_frames == 0 ? c.low > c.high : c.low <= c.high && all_finite({c.low, c.high});
    if (c.name.empty() || !range || c.squares.value() < 0)
      return "control '" + c.name + "' is out of range";
  }
  return {};
}

Problem read_statistics(ByteReader& in, SumsState& state) {
  in.get(state.rate.num, state.rate.den, state.speech_frames, state.rest_frames);
  if (Problem p = read_controls(in, state); !p.empty()) return p;
  if (Problem p = read_histogram(in, state.closures); !p.empty()) return p;
  if (Problem p = read_histogram(in, state.lip_tooth); !p.empty()) return p;
  ShutTotals& shut = state.shut;
  in.get(shut.count, shut.phone, shut.shut, shut.phone_squared, shut.both);
  for (const FixedSum& sum : {shut.phone, shut.shut, shut.phone_squared, shut.both})
    if (!between(sum.value(), 0, 1e12) || shut.count > kMostCount)
      return "its times of closures are out of range";
  for (std::size_t left = in.count(4 + 8); left > 0; --left) {
    std::pair<std::string, std::uint64_t> sentence;
    in.get(sentence.first, sentence.second);
    if (!state.sentences.empty() && sentence <= *state.sentences.rbegin())
      return "its sentences are not ascending";
    state.sentences.insert(state.sentences.end(), std::move(sentence));
  }
  const bool begun = !state.controls.empty();
  if (begun != !state.sentences.empty() || (begun && !state.rate.valid()))
    return "its controls, rate and sentences do not match";
  return {};
}

Problem read_space(ByteReader& in, const std::vector<std::uint32_t>& number, SumsState& state) {
  for (std::size_t t = 0; t < kTermCount; ++t) {
    const RefinedTerm term = kTermInfo[t].term;
    if (in.next<RefinedTerm>() != term || in.next<std::uint32_t>() != kTermInfo[t].orders)
      return "a term is unknown";
    auto& keys = state.space.tables[t].keys;
    keys.resize(in.count(4));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto key = in.next<std::uint32_t>();
      keys[i] = key;
      if (const auto phone = phone_of_key(term, key)) {
        if (*phone >= number.size() || state.phones[number[*phone]].examples == 0)
          return "a term belongs to no phone";
        keys[i] = key_with_phone(term, key, number[*phone]);
      } else if (key > largest_key(term, number.size())) {
        return "a term belongs to no class";
      }
      if (i > 0 && keys[i] <= keys[i - 1]) return "its terms are not ascending";
    }
  }
  std::vector<std::uint32_t> heard;
  for (std::size_t p = 0; p < state.phones.size(); ++p)
    if (state.phones[p].examples > 0) heard.push_back(std::uint32_t(p));
  if (heard != state.space.tables[std::size_t(RefinedTerm::phone)].keys)
    return "its phones and their terms do not match";
  state.space.number();
  state.rows.resize(state.space.size);
  std::iota(state.rows.begin(), state.rows.end(), std::size_t(0));
  if (state.controls.empty() && state.space.size > 0) return "there are terms but no controls";
  return {};
}

/// True if so many sums were there.
bool read_sums(ByteReader& in, std::size_t count, std::vector<FixedSum>& values) {
  values.resize(in.limited(count, 16));
  in.get(values);
  return values.size() == count;
}

Problem read_fit(ByteReader& in, std::size_t n, std::size_t k, FitSums& fit) {
  in.get(fit.sentences, fit.frames);
  fit.bound.set_bits(in.next<std::uint64_t>());
  const std::size_t triangle = n * (n + 1) / 2;
  if (!read_sums(in, k + 1, fit.energy) || !read_sums(in, k, fit.level) ||
      !read_sums(in, n * (k + 1), fit.right) || in.limited(triangle, 8) != triangle)
    return "its parts are larger than the file";
  if (!between(fit.bound.value(), 0, SmallFixedSum::kMost)) return "it has too many frames";
  fit.gram.grow(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) fit.gram.at(i, j).set_bits(in.next<std::uint64_t>());
  return {};
}

Problem read_payload(ByteReader& in, bool newer_minor, SumsState& state) {
  state.base = start_base();
  state.phones.resize(state.base.phones.size());
  std::vector<std::uint32_t> number;
  if (Problem p = read_base(in, state, number); !p.empty()) return p;
  if (Problem p = read_statistics(in, state); !p.empty()) return p;
  if (Problem p = read_space(in, number, state); !p.empty()) return p;
  if (!state.controls.empty())
    for (FitSums* fit : {&state.kept, &state.held})
      if (Problem p = read_fit(in, state.space.size, state.controls.size(), *fit); !p.empty())
        return p;
  if (in.failed()) return "its parts are larger than the file";
  if (!in.at_end() && !newer_minor) return "there is data after the sums";
  return {};
}

}  // namespace

std::vector<std::uint8_t> write_training_sums(const TrainingSums& sums) {
  const SumsState& state = sums.state();
  const std::size_t n = state.space.size;
  ByteWriter body;
  body.bytes.reserve(8 * n * (n + 1) + 32 * n * (state.controls.size() + 1) + 65536);
  write_base(state, body);
  write_statistics(state, body);
  for (std::size_t t = 0; t < kTermCount; ++t) {
    body.put(kTermInfo[t].term, kTermInfo[t].orders);
    body.count(state.space.tables[t].keys.size());
    body.put(state.space.tables[t].keys);
  }
  if (!state.controls.empty())
    for (const FitSums* fit : {&state.kept, &state.held}) write_fit(*fit, state.rows, body);
  return frame_file(kSumsFormat, body.bytes);
}

Result<TrainingSums> read_training_sums(std::span<const std::uint8_t> bytes) {
  const auto body = open_frame(kSumsFormat, bytes);
  if (!body) return body.error();
  ByteReader in(body->bytes);
  auto state = std::make_unique<SumsState>();
  if (const Problem problem = read_payload(in, body->newer_minor, *state);
      in.failed() || !problem.empty())
    return damaged_sums(in.failed() ? "its parts are larger than the file" : problem);
  return TrainingSums(std::move(state));
}

Result<TrainingSums> load_training_sums(const std::filesystem::path& path) {
  const auto bytes = load_file(kSumsFormat, path);
  if (!bytes) return bytes.error();
  auto sums = read_training_sums(*bytes);
  if (!sums) return std::move(sums).error().in_file(path.string());
  return sums;
}

}  // namespace animeme::dam
