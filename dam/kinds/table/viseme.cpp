// The kind viseme: checks, model file, synthesis.
#include <cmath>

#include "dam/kinds/table/table.h"
#include "dam/kinds/table/viseme_weights.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {

Result<void> validate_visemes(const Model& model) {
  const auto* p = std::get_if<VisemeParameters>(&model.parameters);
  if (p == nullptr) return invalid_model("its parameters are not those of its method");
  if (!(p->place >= 0 && p->place <= 1))
    return invalid_model("the place of its poses is out of range");
  if (!(p->plateau >= 0 && p->plateau <= 1))
    return invalid_model("the plateau of its poses is out of range");
  if (p->poses.size() != model.phones.size() * model.controls.size())
    return invalid_model("its number of poses does not match its phones and controls");
  for (const double v : p->poses)
    if (!std::isfinite(v)) return invalid_model("a pose has no value");
  return {};
}

void write_visemes(const Model& model, ByteWriter& out) {
  const auto& p = std::get<VisemeParameters>(model.parameters);
  out.put(p.place, p.plateau, p.poses);
}

Result<void> read_visemes(ByteReader& in, Model& model) {
  VisemeParameters p;
  in.get(p.place, p.plateau);
  p.poses.resize(in.limited(model.phones.size() * model.controls.size(), 8));
  in.get(p.poses);
  model.parameters = std::move(p);
  return {};
}

void speak_visemes(const Speech& speech, std::span<double> rows, SynthesisReport&) {
  if (speech.timeline.empty()) return;
  const auto& p = std::get<VisemeParameters>(speech.model.parameters);
  const std::size_t controls = speech.model.controls.size();
  const auto hold = [&](std::size_t j) {
    return hold_of(speech.timeline[j].start, speech.timeline[j].duration, p.place, p.plateau);
  };
  std::size_t near = 0;
  for (std::size_t i = 0; i < speech.frames; ++i) {
    const Between at = between_poses(speech.timeline.size(), speech.time(i), hold, near);
    const double* a = &p.poses[std::size_t(speech.phone[at.from]) * controls];
    const double* b = &p.poses[std::size_t(speech.phone[at.to]) * controls];
    for (std::size_t c = 0; c < controls; ++c)
      rows[i * controls + c] = (1 - at.share) * a[c] + at.share * b[c];
  }
}

double reach_of_visemes(const Model& model) {
  double longest = 0;
  for (const PhoneModel& phone : model.phones) longest = std::max(longest, phone.longest);
  return longest;
}

}  // namespace animeme::dam
