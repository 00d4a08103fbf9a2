#include "dam/crossmap/retarget.h"

#include <algorithm>
#include <cmath>

#include "dam/crossmap/bounded_least_squares.h"

namespace animeme::dam {
namespace {

Error bad_character(const char* text) { return make_error(Code::invalid_argument, text); }

bool are_numbers(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

Result<void> check_controls(const Character& character) {
  const std::size_t controls = character.controls.size();
  if (controls == 0) return bad_character("the target has no controls");
  if (character.lows.size() != controls || character.highs.size() != controls) {
    return bad_character("each control of the target has two limits");
  }
  for (std::size_t c = 0; c < controls; ++c) {
    if (std::isfinite(character.lows[c]) && character.lows[c] <= character.highs[c]) continue;
    return make_error(Code::invalid_argument,
                      "the limits of " + character.controls[c] + " are no range");
  }
  return {};
}

// How many key shapes a blend has. Errors: frames that are none.
Result<std::size_t> shapes_of(const Blend& blend, std::size_t wanted) {
  const std::size_t frames = blend.measured.size();
  if (frames == 0 || wanted == 0 || blend.weights.size() != frames * wanted) {
    return bad_character(
        "the target's number of key shapes differs from that of the recording's fit");
  }
  return wanted;
}

Signal signal_of(const Blend& blend, fap::Rate rate, const Character& character) {
  Signal signal{rate, 0, character.controls, {}, {}};
  signal.values.reserve(blend.measured.size() * character.controls.size());
  if (std::find(blend.measured.begin(), blend.measured.end(), false) != blend.measured.end()) {
    signal.measured = blend.measured;
  }
  return signal;
}

// Products of all pairs of rows of `values`, `count` rows of `size` numbers.
std::vector<double> products_of(const std::vector<double>& values, std::size_t size,
                                std::size_t count) {
  std::vector<double> out(count * count, 0.0);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double sum = 0;
      for (std::size_t k = 0; k < size; ++k) sum += values[a * size + k] * values[b * size + k];
      out[a * count + b] = out[b * count + a] = sum;
    }
  }
  return out;
}

std::vector<double> products_of_columns(const std::vector<double>& matrix, std::size_t rows,
                                        std::size_t columns) {
  std::vector<double> out(columns * columns, 0.0);
  for (std::size_t r = 0; r < rows; ++r) {
    const double* row = &matrix[r * columns];
    for (std::size_t a = 0; a < columns; ++a) {
      if (row[a] == 0) continue;
      for (std::size_t b = 0; b < columns; ++b) out[a * columns + b] += row[a] * row[b];
    }
  }
  return out;
}

// x'M x.
double form(const std::vector<double>& matrix, const double* x, std::size_t size) {
  double sum = 0;
  for (std::size_t a = 0; a < size; ++a) {
    if (x[a] == 0) continue;
    for (std::size_t b = 0; b < size; ++b) sum += x[a] * matrix[a * size + b] * x[b];
  }
  return sum;
}

bool stands_at_limit(const Character& character, std::size_t control, double value) {
  return value >= character.highs[control] && character.highs[control] > character.lows[control];
}

}  // namespace

Result<Retarget> fit_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const RetargetOptions& options) {
  if (auto ok = check_controls(character); !ok) return ok.error();
  const std::size_t controls = character.controls.size(), rows = character.rows;
  if (rows == 0 || character.moves.size() != rows * controls ||
      character.keys.size() % std::max<std::size_t>(rows, 1) != 0) {
    return bad_character("the shapes of the target are not of one size");
  }
  if (!are_numbers(character.moves) || !are_numbers(character.keys)) {
    return bad_character("the shapes of the target have values that are not finite");
  }
  if (!(options.ridge >= 0 && options.ridge <= 1)) return bad_character("the ridge is 0 to 1");
  const Result<std::size_t> shapes = shapes_of(blend, character.keys.size() / rows);
  if (!shapes) return shapes.error();
  BoundedLeastSquares fit(
      character.moves, rows, controls,
      {.lows = character.lows, .highs = character.highs, .ridge = options.ridge});
  // Mixed targets have mixed products, so that no frame needs its vertices to be made for the fit.
  std::vector<std::vector<double>> products;
  for (std::size_t s = 0; s < *shapes; ++s) {
    products.push_back(fit.products({&character.keys[s * rows], rows}));
  }
  // So do residuals: |V a - B c|^2 = a'V'V a - 2 a'V'B c + c'B'B c.
  const std::vector<double> keys = products_of(character.keys, rows, *shapes);
  const std::vector<double> moves = products_of_columns(character.moves, rows, controls);
  Retarget out{signal_of(blend, rate, character), {}, 0};
  std::vector<double> mixed(controls);
  for (std::size_t i = 0; i < blend.measured.size(); ++i) {
    const double* alpha = &blend.weights[i * *shapes];
    std::fill(mixed.begin(), mixed.end(), 0.0);
    for (std::size_t s = 0; s < *shapes; ++s) {
      if (alpha[s] == 0) continue;
      for (std::size_t c = 0; c < controls; ++c) mixed[c] += alpha[s] * products[s][c];
    }
    const auto values = fit.fit_products(mixed);
    bool limited = false;
    double square = form(keys, alpha, *shapes) + form(moves, values.data(), controls);
    for (std::size_t c = 0; c < controls; ++c) {
      limited = limited || stands_at_limit(character, c, values[c]);
      square -= 2 * values[c] * mixed[c];
    }
    out.signal.values.insert(out.signal.values.end(), values.begin(), values.end());
    out.residuals.push_back(std::sqrt(std::max(0.0, square) / double(rows)));
    out.limited += limited ? 1 : 0;
  }
  return out;
}

Result<Retarget> mix_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const std::vector<double>& values) {
  if (auto ok = check_controls(character); !ok) return ok.error();
  const std::size_t controls = character.controls.size();
  if (values.size() % controls != 0 || !are_numbers(values)) {
    return bad_character("the table of controls must have one number per key shape and control");
  }
  const Result<std::size_t> shapes = shapes_of(blend, values.size() / controls);
  if (!shapes) return shapes.error();
  Retarget out{signal_of(blend, rate, character), {}, 0};
  for (std::size_t i = 0; i < blend.measured.size(); ++i) {
    bool limited = false;
    double over = 0;
    for (std::size_t c = 0; c < controls; ++c) {
      double sum = 0;
      for (std::size_t s = 0; s < *shapes; ++s) {
        sum += blend.weights[i * *shapes + s] * values[s * controls + c];
      }
      const double held = std::clamp(sum, character.lows[c], character.highs[c]);
      limited = limited || stands_at_limit(character, c, held);
      over += (sum - held) * (sum - held);
      out.signal.values.push_back(held);
    }
    out.residuals.push_back(std::sqrt(over / double(controls)));
    out.limited += limited ? 1 : 0;
  }
  return out;
}

}  // namespace animeme::dam
