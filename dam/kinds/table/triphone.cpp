// The kind triphone: checks, model file, synthesis.
#include <algorithm>
#include <cmath>

#include "dam/kinds/table/contexts.h"
#include "dam/kinds/table/table.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

constexpr std::uint32_t kMaxPoints = 64;
constexpr std::size_t kCurveHeader = 4 + 1 + 4 + 4 + 4;

bool sound(const Model& model, const TriphoneParameters& p, const ContextCurve& curve) {
  const auto phones = std::int32_t(model.phones.size());
  if (curve.phone < 0 || curve.phone >= phones || std::size_t(curve.level) >= kCurveLevels)
    return false;
  if (curve.left < kAnyContext || curve.right < kAnyContext || curve.count == 0) return false;
  if (curve.values.size() != p.points * model.controls.size()) return false;
  return std::all_of(curve.values.begin(), curve.values.end(),
                     [](float v) { return std::isfinite(v); });
}

/// The curve of a phone in its context: the sum of what is known of it. False: nothing.
bool add_curves(const Model& model, const TriphoneParameters& p, std::int32_t phone,
                std::int32_t left, std::int32_t right, std::vector<double>& curve) {
  bool found = false;
  std::fill(curve.begin(), curve.end(), 0.0);
  for (const CurveKey& key : curve_keys(model, phone, left, right)) {
    const auto at =
        std::lower_bound(p.curves.begin(), p.curves.end(), key,
                         [](const ContextCurve& c, const CurveKey& k) { return key_of(c) < k; });
    if (at == p.curves.end() || key_of(*at) != key) continue;
    found = true;
    for (std::size_t i = 0; i < curve.size(); ++i) curve[i] += double(at->values[i]);
  }
  return found;
}

}  // namespace

Result<void> validate_triphones(const Model& model) {
  const auto* p = std::get_if<TriphoneParameters>(&model.parameters);
  if (p == nullptr) return invalid_model("its parameters are not those of its method");
  if (p->points < 2 || p->points > kMaxPoints)
    return invalid_model("the points of its curves are out of range");
  if (!(p->reach >= 0.01 && p->reach <= 0.5))
    return invalid_model("the reach of its curves is out of range");
  for (std::size_t i = 0; i < p->curves.size(); ++i) {
    if (!sound(model, *p, p->curves[i]))
      return invalid_model("curve " + std::to_string(i) + " is not complete");
    if (i > 0 && !(key_of(p->curves[i - 1]) < key_of(p->curves[i])))
      return invalid_model("its curves are not sorted");
  }
  return {};
}

void write_triphones(const Model& model, ByteWriter& out) {
  const auto& p = std::get<TriphoneParameters>(model.parameters);
  out.put(p.points, p.reach);
  out.count(p.curves.size());
  for (const ContextCurve& curve : p.curves)
    out.put(curve.phone, curve.level, curve.left, curve.right, curve.count, curve.values);
}

Result<void> read_triphones(ByteReader& in, Model& model) {
  TriphoneParameters p;
  in.get(p.points, p.reach);
  if (p.points < 2 || p.points > kMaxPoints)
    return make_error(Code::syntax, "number of points out of range");
  const std::size_t values = p.points * model.controls.size();
  p.curves.resize(in.count(kCurveHeader + 4 * values));
  for (ContextCurve& curve : p.curves) {
    in.get(curve.phone, curve.level, curve.left, curve.right, curve.count);
    curve.values.resize(in.limited(values, 4));
    in.get(curve.values);
  }
  model.parameters = std::move(p);
  return {};
}

void speak_triphones(const Speech& speech, std::span<double> rows, SynthesisReport&) {
  const auto& p = std::get<TriphoneParameters>(speech.model.parameters);
  const std::size_t controls = speech.model.controls.size();
  std::vector<double> sums(speech.frames, 0.0), curve(p.points * controls);
  for (std::size_t j = 0; j < speech.timeline.size(); ++j) {
    const Occurrence& o = speech.timeline[j];
    if (!add_curves(speech.model, p, speech.phone[j], neighbour(speech.model, o.left),
                    neighbour(speech.model, o.right), curve))
      continue;
    const double reach = p.reach * o.paced();
    const auto [first, last] = speech.frames_between(o.start - reach, o.end() + reach);
    for (std::size_t i = first; i < last; ++i) {
      const double u = o.local(speech.time(i));
      const double weight = fade(u, p.reach);
      const double x = std::clamp((u + p.reach) / (1 + 2 * p.reach), 0.0, 1.0) * (p.points - 1);
      const std::size_t point = std::min(std::size_t(x), std::size_t(p.points) - 2);
      const double b = weight * (x - double(point)), a = weight - b;
      sums[i] += weight;
      for (std::size_t c = 0; c < controls; ++c)
        rows[i * controls + c] +=
            a * curve[point * controls + c] + b * curve[(point + 1) * controls + c];
    }
  }
  for (std::size_t i = 0; i < speech.frames; ++i)
    for (std::size_t c = 0; sums[i] > 0 && c < controls; ++c) rows[i * controls + c] /= sums[i];
}

double reach_of_triphones(const Model& model) {
  double longest = 0;
  for (const PhoneModel& phone : model.phones) longest = std::max(longest, phone.longest);
  return std::get<TriphoneParameters>(model.parameters).reach * longest;
}

}  // namespace animeme::dam
