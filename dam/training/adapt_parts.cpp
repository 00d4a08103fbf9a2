#include <algorithm>
#include <cmath>
#include <map>

#include "dam/corpus/statistics_internal.h"
#include "dam/kinds/refined/terms.h"
#include "dam/maths/linear_algebra.h"
#include "dam/signal/articulators_internal.h"
#include "dam/training/adapt_internal.h"

namespace animeme::dam {
namespace {

/// Weight, in frames, of the belief that the gain of a control of another name is 0.
constexpr double kOtherGain = 100;
/// The same of the belief that speech and pauses have the level of the own rest.
constexpr double kLevelPrior = 10;

/// Products of the base's controls (x) and the own ones (y) over the frames of speech, both about
/// their rest, without what the levels of speech and pauses explain.
struct Moments {
  double frames = 0;
  std::vector<double> xx, xy;  ///< nx x nx, ny x nx
  std::vector<double> yy;
  /// Inverse of the products of the levels, 2 x 2; levels with x and y, 2 x nx, 2 x ny, in full.
  std::vector<double> ll, lx, ly;
};

/// `made`: as of the base with levels. `nx`: controls without these.
Moments moments_of(const Model& base, std::span<const Control> own,
                   std::span<const Utterance* const> sentences,
                   std::span<const Signal* const> made) {
  const std::size_t nx = base.controls.size() - kLevels, ny = own.size();
  Moments m{0,
            std::vector<double>(nx * nx),
            std::vector<double>(ny * nx),
            std::vector<double>(ny),
            std::vector<double>(kLevels * kLevels),
            std::vector<double>(kLevels * nx),
            std::vector<double>(kLevels * ny)};
  std::vector<double> x(nx), y(ny);
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    const auto speech = speech_frames(*sentences[s]);
    for (std::size_t i = 0; i < speech.size(); ++i) {
      if (!speech[i]) continue;
      m.frames += 1;
      for (std::size_t a = 0; a < nx; ++a) x[a] = made[s]->at(i, a) - base.controls[a].rest;
      for (std::size_t c = 0; c < ny; ++c) y[c] = sentences[s]->signal.at(i, c) - own[c].rest;
      for (std::size_t a = 0; a < nx; ++a) {
        for (std::size_t b = 0; b < nx; ++b) m.xx[a * nx + b] += x[a] * x[b];
        for (std::size_t c = 0; c < ny; ++c) m.xy[c * nx + a] += x[a] * y[c];
      }
      for (std::size_t c = 0; c < ny; ++c) m.yy[c] += y[c] * y[c];
      for (std::size_t l = 0; l < kLevels; ++l) {
        const double level = made[s]->at(i, nx + l);
        for (std::size_t j = 0; j < kLevels; ++j)
          m.ll[l * kLevels + j] += level * made[s]->at(i, nx + j);
        for (std::size_t a = 0; a < nx; ++a) m.lx[l * nx + a] += level * x[a];
        for (std::size_t c = 0; c < ny; ++c) m.ly[l * ny + c] += level * y[c];
      }
    }
  }
  for (std::size_t l = 0; l < kLevels; ++l) m.ll[l * (kLevels + 1)] += kLevelPrior;
  // What is left of x and y when the levels are taken off.
  const double det = m.ll[0] * m.ll[3] - m.ll[1] * m.ll[2];
  const double inverse[] = {m.ll[3] / det, -m.ll[1] / det, -m.ll[2] / det, m.ll[0] / det};
  const auto off = [&](const std::vector<double>& p, std::size_t np, std::size_t a,
                       const std::vector<double>& q, std::size_t nq, std::size_t b) {
    return p[a] * (inverse[0] * q[b] + inverse[1] * q[nq + b]) +
           p[np + a] * (inverse[2] * q[b] + inverse[3] * q[nq + b]);
  };
  for (std::size_t a = 0; a < nx; ++a) {
    for (std::size_t b = 0; b < nx; ++b) m.xx[a * nx + b] -= off(m.lx, nx, a, m.lx, nx, b);
    for (std::size_t c = 0; c < ny; ++c) m.xy[c * nx + a] -= off(m.lx, nx, a, m.ly, ny, c);
  }
  for (std::size_t c = 0; c < ny; ++c)
    m.yy[c] = std::max(0.0, m.yy[c] - off(m.ly, ny, c, m.ly, ny, c));
  m.ll.assign(std::begin(inverse), std::end(inverse));
  return m;
}

/// Mixtures for all own controls at once: nx x ny, row by row.
std::vector<double> mixtures(const Moments& m) {
  const std::size_t ny = m.yy.size(), nx = m.xy.size() / ny;
  std::vector<double> matrix = m.xx, right(nx * ny);
  for (std::size_t a = 0; a < nx; ++a) {
    const double square = m.xx[a * nx + a];
    matrix[a * nx + a] += kOtherGain * square / std::max(1.0, m.frames) + (square > 0 ? 0 : 1);
    for (std::size_t c = 0; c < ny; ++c) right[a * ny + c] = m.xy[c * nx + a];
  }
  if (!cholesky_in_place(matrix, nx, 1)) return std::vector<double>(nx * ny, 0.0);
  cholesky_solve(matrix, nx, right, ny, 1);
  return right;
}

/// Share of the own control that its gains explain.
double share_of(const Moments& m, std::size_t c, std::span<const double> gain) {
  const std::size_t nx = m.xy.size() / m.yy.size();
  if (!(m.yy[c] > 0)) return 0;
  double told = 0;
  for (std::size_t a = 0; a < nx; ++a) {
    double bent = 0;
    for (std::size_t b = 0; b < nx; ++b) bent += m.xx[a * nx + b] * gain[b];
    told += gain[a] * (2 * m.xy[c * nx + a] - bent);
  }
  return told / m.yy[c];
}

/// A key of the tables, with the phones that it names numbered as in `number`.
std::uint32_t renumbered(RefinedTerm term, std::uint32_t key,
                         std::span<const std::uint32_t> number) {
  if (term == RefinedTerm::triphone)
    return (number[key / 65536] * 256 + number[key / 256 % 256]) * 256 + number[key % 256];
  if (const auto phone = phone_of_key(term, key)) return key_with_phone(term, key, number[*phone]);
  return key;
}

/// A table while rows are added to it.
struct Sum {
  std::uint32_t orders = 0;
  std::map<std::uint32_t, std::vector<double>> rows;  // kRefinedOrders x controls each
};

TermTable table_of(RefinedTerm term, const Sum& sum, std::size_t controls) {
  TermTable table{term, sum.orders, {}, {}};
  for (const auto& [key, row] : sum.rows) {
    table.keys.push_back(key);
    for (std::size_t i = 0; i < sum.orders * controls; ++i) table.values.push_back(float(row[i]));
  }
  return table;
}

}  // namespace

Model with_levels(const Model& base) {
  Model out = base;
  const std::size_t nx = base.controls.size(), all = nx + kLevels;
  for (const char* name : {"level of speech", "level of pauses"})
    out.controls.push_back({name, 0, 0, 1});
  auto& tables = std::get<RefinedParameters>(out.parameters).tables;
  for (TermTable& table : tables) {
    Sum sum{table.orders, {}};
    for (std::size_t r = 0; r < table.keys.size(); ++r) {
      auto& row = sum.rows[table.keys[r]];
      row.resize(table.orders * all);
      for (std::size_t m = 0; m < table.orders; ++m)
        std::copy_n(&table.values[(r * table.orders + m) * nx], nx, &row[m * all]);
    }
    for (std::uint32_t p = 0; table.term == RefinedTerm::phone && p < out.phones.size(); ++p) {
      auto& row = sum.rows[p];
      row.resize(table.orders * all);
      row[nx + (is_silence(out.phones, std::int32_t(p)) ? 1 : 0)] = 1;
    }
    table = table_of(table.term, sum, all);
  }
  return out;
}

Telling tell_base(const Model& base, std::span<const Control> own,
                  std::span<const Utterance* const> sentences, std::span<const Signal* const> made,
                  std::vector<AdaptedControl>* found) {
  const Moments m = moments_of(base, own, sentences, made);
  const std::size_t ny = own.size(), nx = base.controls.size() - kLevels, all = nx + kLevels;
  const auto& names = sentences[0]->signal.names;
  const std::vector<double> mixed = mixtures(m);
  // Other controls share the correlation of the jaw.
  const auto group_of = [&](std::size_t c) {
    const Articulator articulator = articulator_of(names[c]);
    return std::size_t(articulator == Articulator::other ? Articulator::jaw : articulator);
  };
  const auto place_of = [&](std::size_t c) {
    const std::int32_t same = base.find_control(names[c]);
    return same >= 0 && m.xx[std::size_t(same) * (nx + 1)] > 0 && m.yy[c] > 0 ? same : -1;
  };
  // The correlation of a single control is uncertain with few sentences, that of its articulator
  // less so.
  std::vector<double> correlation(kArticulatorCount), members(kArticulatorCount);
  for (std::size_t c = 0; c < ny; ++c) {
    const std::int32_t b = place_of(c);
    if (b < 0) continue;
    correlation[group_of(c)] +=
        m.xy[c * nx + std::size_t(b)] / std::sqrt(m.xx[std::size_t(b) * (nx + 1)] * m.yy[c]);
    members[group_of(c)] += 1;
  }
  Telling telling{std::vector<double>(ny), std::vector<double>(ny * all)};
  for (std::size_t c = 0; c < ny; ++c) {
    const std::span<double> gain(&telling.gain[c * all], all);
    const bool same = base.find_control(names[c]) >= 0;
    double own_gain = 0;
    if (const std::int32_t b = place_of(c); b >= 0) {
      const double common = std::max(0.0, correlation[group_of(c)] / members[group_of(c)]);
      own_gain = common * std::sqrt(m.yy[c] / m.xx[std::size_t(b) * (nx + 1)]);
      gain[std::size_t(b)] = own_gain;
    } else if (!same) {
      for (std::size_t b2 = 0; b2 < nx; ++b2) gain[b2] = mixed[b2 * ny + c];
    }
    double left[kLevels];
    for (std::size_t l = 0; l < kLevels; ++l) {
      left[l] = m.ly[l * ny + c];
      for (std::size_t b2 = 0; b2 < nx; ++b2) left[l] -= gain[b2] * m.lx[l * nx + b2];
    }
    gain[nx] = m.ll[0] * left[0] + m.ll[1] * left[1];
    gain[nx + 1] = m.ll[2] * left[0] + m.ll[3] * left[1];
    telling.offset[c] = own[c].rest;
    for (std::size_t b2 = 0; b2 < nx; ++b2) telling.offset[c] -= gain[b2] * base.controls[b2].rest;
    if (found != nullptr) found->push_back({names[c], same, own_gain, share_of(m, c, gain)});
  }
  return telling;
}

Model with_phones_of(const Model& base, const Model& model) {
  const std::size_t k = model.controls.size();
  Model out = model;
  out.phones = base.phones;
  for (PhoneModel& phone : out.phones) phone.examples = 0;
  std::vector<std::uint32_t> number;
  for (const PhoneModel& phone : model.phones) {
    number.push_back(std::uint32_t(base.find_phone(phone.label)));
    out.phones[number.back()].examples = phone.examples;
    out.phones[number.back()].longest = phone.longest;
  }
  auto& parameters = std::get<RefinedParameters>(out.parameters);
  parameters.dominance = std::get<RefinedParameters>(base.parameters).dominance;
  for (TermTable& table : parameters.tables) {
    Sum sum{table.orders, {}};
    for (std::size_t r = 0; r < table.keys.size(); ++r) {
      const auto from = table.values.begin() + std::ptrdiff_t(r * table.orders * k);
      sum.rows[renumbered(table.term, table.keys[r], number)].assign(
          from, from + std::ptrdiff_t(table.orders * k));
    }
    for (std::uint32_t p = 0; table.term == RefinedTerm::phone && p < out.phones.size(); ++p) {
      auto& row = sum.rows[p];
      if (!row.empty()) continue;
      row.resize(table.orders * k);
      for (std::size_t c = 0; c < k && !is_silence(out.phones, std::int32_t(p)); ++c)
        if (const Control& control = out.controls[c]; control.sd > 0)
          row[c] = (control.mean - control.rest) / control.sd;
    }
    table = table_of(table.term, sum, k);
  }
  return out;
}

Model add_up(const Model& base, std::span<const ModelShare> shares, std::span<const double> offset,
             std::vector<Control> controls) {
  const std::size_t ny = controls.size();
  Model model = base;
  std::map<RefinedTerm, Sum> sums;
  const auto row_of = [&](RefinedTerm term, std::uint32_t orders,
                          std::uint32_t key) -> std::vector<double>& {
    Sum& sum = sums[term];
    sum.orders = std::max(sum.orders, orders);
    auto& row = sum.rows[key];
    row.resize(kRefinedOrders * ny);
    return row;
  };
  const auto per_sd = [&](std::size_t c) { return controls[c].sd > 0 ? 1 / controls[c].sd : 0.0; };
  std::vector<double> level(ny);  // above the rest
  for (std::size_t c = 0; c < ny; ++c) level[c] = offset[c] - controls[c].rest;
  for (const ModelShare& share : shares) {
    const Model& from = *share.model;
    const std::size_t nx = from.controls.size();
    const auto mix = [&](std::size_t c, const auto& value) {
      double sum = 0;
      for (std::size_t b = 0; b < nx; ++b)
        if (const double gain = share.gain[c * nx + b]; gain != 0) sum += gain * value(b);
      return sum;
    };
    for (std::size_t c = 0; c < ny; ++c)
      level[c] += mix(c, [&](std::size_t b) { return from.controls[b].rest; });
    for (const TermTable& table : std::get<RefinedParameters>(from.parameters).tables) {
      for (std::size_t r = 0; r < table.keys.size(); ++r) {
        auto& row = row_of(table.term, table.orders, table.keys[r]);
        for (std::size_t m = 0; m < table.orders; ++m) {
          const float* values = &table.values[(r * table.orders + m) * nx];
          for (std::size_t c = 0; c < ny; ++c)
            row[m * ny + c] +=
                per_sd(c) * mix(c, [&](std::size_t b) { return from.controls[b].sd * values[b]; });
        }
      }
    }
  }
  // Weights of phones add up to 1, so a constant of all phones is one of the speech and of the
  // silences next to it; further away the mouth rests.
  for (std::size_t p = 0; p < base.phones.size(); ++p) {
    auto& row = row_of(RefinedTerm::phone, 1, std::uint32_t(p));
    for (std::size_t c = 0; c < ny; ++c) row[c] += per_sd(c) * level[c];
  }
  model.controls = std::move(controls);
  auto& parameters = std::get<RefinedParameters>(model.parameters);
  parameters.tables.clear();
  for (const auto& [term, sum] : sums) parameters.tables.push_back(table_of(term, sum, ny));
  return model;
}

}  // namespace animeme::dam
