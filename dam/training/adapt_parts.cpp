#include <algorithm>
#include <cmath>
#include <map>

#include "dam/corpus/statistics_internal.h"
#include "dam/kinds/refined/terms.h"
#include "dam/maths/linear_algebra.h"
#include "dam/training/adapt_internal.h"

namespace animeme::dam {
namespace {

/// Weight, in frames, of the belief that a gain of a control of the same name is 1, of another one
/// 0.
constexpr double kSameGain = 25, kOtherGain = 100;

/// Means and products of the base's controls (x) and the own ones (y) over the frames of speech.
struct Moments {
  double frames = 0;
  std::vector<double> x, y;    ///< sums, then means
  std::vector<double> xx, xy;  ///< about the means: nx x nx, ny x nx
  std::vector<double> yy;
};

template <class Visit>
void each_frame(std::span<const Utterance* const> sentences, std::span<const Signal* const> made,
                const Visit& visit) {
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    const auto speech = speech_frames(*sentences[s]);
    const std::size_t nx = made[s]->names.size(), ny = sentences[s]->signal.names.size();
    for (std::size_t i = 0; i < speech.size(); ++i)
      if (speech[i]) visit(&made[s]->values[i * nx], &sentences[s]->signal.values[i * ny]);
  }
}

Moments moments_of(std::span<const Utterance* const> sentences,
                   std::span<const Signal* const> made) {
  const std::size_t nx = made[0]->names.size(), ny = sentences[0]->signal.names.size();
  Moments m{0,
            std::vector<double>(nx),
            std::vector<double>(ny),
            std::vector<double>(nx * nx),
            std::vector<double>(ny * nx),
            std::vector<double>(ny)};
  each_frame(sentences, made, [&](const double* x, const double* y) {
    m.frames += 1;
    for (std::size_t a = 0; a < nx; ++a) m.x[a] += x[a];
    for (std::size_t c = 0; c < ny; ++c) m.y[c] += y[c];
  });
  for (double& sum : m.x) sum /= std::max(1.0, m.frames);
  for (double& sum : m.y) sum /= std::max(1.0, m.frames);
  each_frame(sentences, made, [&](const double* x, const double* y) {
    for (std::size_t a = 0; a < nx; ++a) {
      const double dx = x[a] - m.x[a];
      for (std::size_t b = 0; b <= a; ++b) m.xx[a * nx + b] += dx * (x[b] - m.x[b]);
      for (std::size_t c = 0; c < ny; ++c) m.xy[c * nx + a] += dx * (y[c] - m.y[c]);
    }
    for (std::size_t c = 0; c < ny; ++c) m.yy[c] += (y[c] - m.y[c]) * (y[c] - m.y[c]);
  });
  for (std::size_t a = 0; a < nx; ++a)
    for (std::size_t b = 0; b < a; ++b) m.xx[b * nx + a] = m.xx[a * nx + b];
  return m;
}

/// Mixtures for all own controls at once: nx x ny, row by row.
std::vector<double> mixtures(const Moments& m) {
  const std::size_t nx = m.x.size(), ny = m.y.size();
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
  const std::size_t nx = m.x.size();
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

Telling tell_base(const Model& base, std::span<const Utterance* const> sentences,
                  std::span<const Signal* const> made, std::vector<AdaptedControl>* found) {
  const Moments m = moments_of(sentences, made);
  const std::size_t nx = m.x.size(), ny = m.y.size();
  const std::vector<double> mixed = mixtures(m);
  Telling telling{std::vector<double>(ny), std::vector<double>(ny * nx)};
  for (std::size_t c = 0; c < ny; ++c) {
    const std::string& name = sentences[0]->signal.names[c];
    const std::span<double> gain(&telling.gain[c * nx], nx);
    const std::int32_t same = base.find_control(name);
    if (same >= 0) {
      const auto b = std::size_t(same);
      const double square = m.xx[b * nx + b];
      const double prior = kSameGain * square / std::max(1.0, m.frames);
      gain[b] = square > 0 ? (m.xy[c * nx + b] + prior) / (square + prior) : 0;
    } else {
      for (std::size_t b = 0; b < nx; ++b) gain[b] = mixed[b * ny + c];
    }
    telling.offset[c] = m.y[c];
    for (std::size_t b = 0; b < nx; ++b) telling.offset[c] -= gain[b] * m.x[b];
    if (found != nullptr)
      found->push_back(
          {name, same >= 0, same >= 0 ? gain[std::size_t(same)] : 0, share_of(m, c, gain)});
  }
  return telling;
}

Signal rest_of(const Signal& own, const Signal& made, const Telling& telling) {
  Signal rest = own;
  const std::size_t nx = made.names.size(), ny = own.names.size();
  for (std::size_t c = 0; c < ny; ++c) rest.names[c] = "rest" + std::to_string(c);
  for (std::size_t i = 0; i < own.frames(); ++i) {
    for (std::size_t c = 0; c < ny; ++c) {
      double told = telling.offset[c];
      for (std::size_t b = 0; b < nx; ++b) told += telling.gain[c * nx + b] * made.at(i, b);
      rest.at(i, c) -= told;
    }
  }
  return rest;
}

Model add_up(const Model& base, const Telling& telling, std::vector<Control> controls,
             const Model* more) {
  const std::size_t nx = base.controls.size(), ny = controls.size();
  std::map<RefinedTerm, Sum> sums;
  const auto row_of = [&](const TermTable& table, std::uint32_t key) -> std::vector<double>& {
    Sum& sum = sums[table.term];
    sum.orders = std::max(sum.orders, table.orders);
    auto& row = sum.rows[key];
    row.resize(kRefinedOrders * ny);
    return row;
  };
  const auto per_sd = [&](std::size_t c) { return controls[c].sd > 0 ? 1 / controls[c].sd : 0.0; };
  for (const TermTable& table : std::get<RefinedParameters>(base.parameters).tables) {
    for (std::size_t r = 0; r < table.keys.size(); ++r) {
      auto& row = row_of(table, table.keys[r]);
      for (std::size_t m = 0; m < table.orders; ++m) {
        const float* from = &table.values[(r * table.orders + m) * nx];
        for (std::size_t c = 0; c < ny; ++c)
          for (std::size_t b = 0; b < nx; ++b)
            row[m * ny + c] += telling.gain[c * nx + b] * base.controls[b].sd * from[b] * per_sd(c);
      }
    }
  }
  for (std::size_t c = 0; c < ny; ++c) {
    if (controls[c].sd == 0) continue;
    controls[c].rest = telling.offset[c];
    for (std::size_t b = 0; b < nx; ++b)
      controls[c].rest += telling.gain[c * nx + b] * base.controls[b].rest;
    if (more != nullptr) controls[c].rest += more->controls[c].rest;
  }
  Model model = base;
  if (more != nullptr) {
    std::vector<std::uint32_t> number;
    for (const PhoneModel& phone : more->phones) {
      const auto at = std::size_t(base.find_phone(phone.label));
      number.push_back(std::uint32_t(at));
      model.phones[at].examples += phone.examples;
      model.phones[at].longest = std::max(model.phones[at].longest, phone.longest);
    }
    for (const TermTable& table : std::get<RefinedParameters>(more->parameters).tables) {
      for (std::size_t r = 0; r < table.keys.size(); ++r) {
        auto& row = row_of(table, renumbered(table.term, table.keys[r], number));
        for (std::size_t i = 0; i < table.orders * ny; ++i)
          row[i] +=
              more->controls[i % ny].sd * table.values[r * table.orders * ny + i] * per_sd(i % ny);
      }
    }
  }
  model.controls = std::move(controls);
  auto& parameters = std::get<RefinedParameters>(model.parameters);
  parameters.tables.clear();
  for (const auto& [term, sum] : sums) parameters.tables.push_back(table_of(term, sum, ny));
  return model;
}

}  // namespace animeme::dam
