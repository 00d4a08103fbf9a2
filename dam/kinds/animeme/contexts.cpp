#include "dam/kinds/animeme/contexts.h"

#include <algorithm>
#include <cmath>

namespace animeme::dam {
namespace {

/// Examples of each mode at one level of the back-off.
struct Level {
  std::vector<double> count;
  double total = 0;

  explicit Level(std::size_t modes) : count(modes, 0.0) {}
  void add(std::size_t mode, double n) {
    count[mode] += n;
    total += n;
  }
  double smoothed(std::size_t mode, double lower) const {
    return (count[mode] + kBackOff * lower) / (total + kBackOff);
  }
};

struct Levels {
  Level all, left_class, right_class, both_classes, both_phones;

  explicit Levels(std::size_t n)
      : all(n), left_class(n), right_class(n), both_classes(n), both_phones(n) {}
};

constexpr std::uint32_t kRestClass = 0xffffffffu;

std::uint32_t class_at(std::span<const std::uint32_t> class_of, std::int32_t phone) {
  return phone < 0 ? kRestClass : class_of[std::size_t(phone)];
}

void add_context(Levels& levels, const ContextCount& c, double n, std::int32_t left,
                 std::int32_t right, std::span<const std::uint32_t> class_of) {
  const bool left_class = class_at(class_of, c.left) == class_at(class_of, left);
  const bool right_class = class_at(class_of, c.right) == class_at(class_of, right);
  const std::size_t mode = c.mode;
  levels.all.add(mode, n);
  if (left_class) levels.left_class.add(mode, n);
  if (right_class) levels.right_class.add(mode, n);
  if (left_class && right_class) levels.both_classes.add(mode, n);
  if (c.left == left && c.right == right) levels.both_phones.add(mode, n);
}

/// Product of independent pieces of evidence, `base` being what both already contain.
void combine(std::vector<double>& p, const Level& left, const Level& right,
             const std::vector<double>& base) {
  double sum = 0;
  for (std::size_t g = 0; g < p.size(); ++g) {
    p[g] = left.smoothed(g, base[g]) * right.smoothed(g, base[g]) / base[g];
    sum += p[g];
  }
  for (double& v : p) v /= sum;
}

void refine(std::vector<double>& p, const Level& level) {
  for (std::size_t g = 0; g < p.size(); ++g) p[g] = level.smoothed(g, p[g]);
}

}  // namespace

std::vector<double> mode_costs(const AnimemePhone& phone, std::span<const std::uint32_t> class_of,
                               std::int32_t left, std::int32_t right, std::int32_t leave_out) {
  const std::size_t n = phone.modes.size();
  if (n == 1) return {0.0};
  Levels levels(n);
  for (const ContextCount& c : phone.contexts)
    add_context(levels, c, double(c.count), left, right, class_of);
  if (leave_out >= 0)
    add_context(levels, {left, right, std::uint32_t(leave_out), 1}, -1, left, right, class_of);
  std::vector<double> base(n), p(n);
  for (std::size_t g = 0; g < n; ++g)
    base[g] = (levels.all.count[g] + 0.5) / (levels.all.total + 0.5 * double(n));
  combine(p, levels.left_class, levels.right_class, base);
  refine(p, levels.both_classes);
  refine(p, levels.both_phones);
  for (double& v : p) v = -std::log(std::clamp(v, 1e-12, 1.0));
  return p;
}

std::vector<std::uint32_t> context_classes(const Model& model) {
  std::vector<std::uint32_t> classes;
  for (const PhoneModel& phone : model.phones) classes.push_back(phone.context_class);
  return classes;
}

}  // namespace animeme::dam
