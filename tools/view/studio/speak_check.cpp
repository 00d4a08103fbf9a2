#include "tools/view/studio/speak_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "dam/speaking/viseme_curves.h"
#include "fap/arkit.h"
#include "fap/fill.h"
#include "fap/wider.h"

namespace animeme::studio {
namespace {

using head::Part;
using head::Vec3;

struct Mouth {
  double gap = 0;       // beyond that at rest, mm
  double width = 0;     // between the corners, mm
  double forward = 0;   // mean of both lips, mm beyond rest
  double to_teeth = 0;  // from the lower lip up to the edge of the upper teeth, mm
  double tongue = 0;    // by which its tip is in front of that edge, mm
};

// What is measured on the mesh as it is drawn.
class Ruler {
 public:
  Ruler(const head::Head& head, const head::Rig& rig, bool visemes)
      : head_(head),
        rig_(rig),
        visemes_(visemes && head::has_own_visemes(rig)),
        said_(visemes),
        scale_(kEyesApart / head.fapu.es) {
    pose({});
    const float reach = 0.3f * float(head.fapu.mw);
    const Vec3 lip = place("2.2");
    edge_ = front_of(Part::upper_teeth, [&](Vec3 p) {
      return std::abs(p.x - lip.x) < reach ? -p.y + 0.5f * p.z : -kFar;
    });
  }

  bool has_teeth() const { return edge_.exists(); }
  bool has_tongue() const { return !rig_.parts[std::size_t(Part::tongue)].positions.empty(); }
  bool knows_phones() const { return said_; }
  bool by_visemes() const { return visemes_; }

  Mouth of(const fap::Frame& frame, const std::optional<fap::VisemeWeights>& visemes = {}) {
    head::PoseOptions options;
    if (said_) options.visemes = visemes;
    pose(frame, options);
    const Vec3 up = place("2.2"), low = place("2.3");
    const Vec3 up0 = head_.at("2.2"), low0 = head_.at("2.3");
    Mouth mouth{scale_ * double((up.y - low.y) - (up0.y - low0.y)),
                scale_ * double(length(place("2.4") - place("2.5"))),
                scale_ * double(up.z + low.z - up0.z - low0.z) / 2};
    if (!has_teeth()) return mouth;
    const Vec3 edge = place(edge_);
    mouth.to_teeth = scale_ * double(edge.y - low.y);
    if (has_tongue()) {
      const auto tip = front_of(Part::tongue, [](Vec3 p) { return p.z; });
      mouth.tongue = scale_ * double(place(tip).z - edge.z);
    }
    return mouth;
  }

  // How far the lids of both eyes are apart, of what they are at rest: the wider one; nullopt: it
  // is not known.
  std::optional<double> lids(const fap::Frame& frame) {
    pose(frame);
    double most = 0;
    for (const auto& [upper, lower] : {std::pair{"3.1", "3.3"}, {"3.2", "3.4"}}) {
      if (!head_.point(upper).exists() || !head_.point(lower).exists()) return std::nullopt;
      const float rest = head_.at(upper).y - head_.at(lower).y;
      if (!(rest > 0)) return std::nullopt;
      most = std::max(most, double((place(upper).y - place(lower).y) / rest));
    }
    return most;
  }

 private:
  static constexpr float kFar = 1e9f;

  void pose(const fap::Frame& frame, const head::PoseOptions& options = {}) {
    head::pose(rig_, frame, pose_, options);
  }

  Vec3 place(head::FeaturePoint point) const {
    const auto part = std::size_t(point.part);
    const auto& moved = pose_.positions[part];
    return pose_.transforms[part](moved.empty() ? rig_.parts[part].positions[point.vertex]
                                                : moved[point.vertex]);
  }
  Vec3 place(std::string_view id) const { return place(head_.point(id)); }

  // The vertex of a part that has most of something; missing if the part is.
  head::FeaturePoint front_of(Part part, const std::function<float(Vec3)>& what) const {
    head::FeaturePoint best{part, head::kMissing};
    float most = -kFar;
    for (std::uint32_t v = 0; v < rig_.parts[std::size_t(part)].positions.size(); ++v) {
      const float value = what(place({part, v}));
      if (value <= most) continue;
      most = value;
      best.vertex = v;
    }
    return best;
  }

  const head::Head& head_;
  const head::Rig& rig_;
  bool visemes_;  // it has its own, and they are shown
  bool said_;     // what is said is known
  double scale_;  // mm for 1 cm of the head
  head::FeaturePoint edge_;
  head::Pose pose_;
};

dam::Script script_of(std::initializer_list<const char*> labels) {
  dam::Script script;
  double at = 0;
  for (const char* label : labels) {
    const dam::PhoneInfo* info = dam::find_phone(label);
    const bool consonant = info != nullptr && !info->vowel && std::string_view(label) != "SIL";
    const double long_for = consonant ? 0.1 : 0.3;
    script.phones.push_back({at, at + long_for, label, ""});
    at += long_for;
  }
  return script;
}

dam::Script sentence() {
  return script_of({"SIL", "P", "AA", "B", "AA", "M", "AA", "SIL", "IY", "SIL", "UW", "SIL"});
}

// With what its lips and its tongue have to show besides.
dam::Script long_sentence() {
  return script_of({"SIL", "P",   "AA",  "B",  "AA", "M",   "AA", "SIL", "IY",
                    "SIL", "UW",  "SIL", "AA", "F",  "AA",  "V",  "AA",  "TH",
                    "AA",  "SIL", "IY",  "W",  "IY", "SIL", "OW", "SIL"});
}

Result<fap::Sequence> said(const dam::Script& script) {
  const Result<dam::Model> model = dam::builtin_model();
  if (!model) return model.error();
  dam::SynthesisOptions options;
  options.rate = {50, 1};
  options.articulation = std::nullopt;
  const Result<dam::Signal> signal = dam::synthesise(*model, script, options);
  if (!signal) return signal.error();
  const Result<fap::Sequence> clip = dam::to_sequence(*signal);
  if (!clip) return clip.error();
  return fap::fill(*clip, {.complete = true});
}

Result<void> measurable(const head::Head& head) {
  for (const char* id : {"2.2", "2.3", "2.4", "2.5"}) {
    if (!head.point(id).exists()) {
      return make_error(Code::not_found, std::string("the head has no feature point ") + id +
                                             " of the mouth: give a list with --points");
    }
  }
  if (!(head.fapu.es > 0)) {
    return make_error(Code::not_found,
                      "the eye distance is unknown: give points 3.5 and 3.6 (pupils) by "
                      "--points");
  }
  return {};
}

bool is_during(const dam::Phone& phone, double time) {
  return time > phone.start - 0.005 && time < phone.end + 0.005;
}

// Of the jaw; of a head that speaks by its own visemes that of the widest of these, if that is
// less.
double full_opening(Ruler& ruler) {
  fap::ArkitFrame open{};
  open[std::size_t(fap::find_arkit("jawOpen").value_or(0))] = 1;
  const double jaw = ruler.of(fap::arkit_to_fap(open, fap::kAllArkit)).gap;
  if (!ruler.by_visemes()) return jaw;
  constexpr std::size_t kAa = 10;
  fap::VisemeWeights widest{};
  widest[kAa] = 1;
  const double own = ruler.of({}, widest).gap;
  return jaw > 0 ? std::min(jaw, own) : own;
}

fap::Frame closed_lids() {
  fap::Frame frame;
  for (const int lid : {19, 20}) frame.set(lid, 1024);
  for (const int lid : {21, 22}) frame.set(lid, 0);
  return frame;
}

// The frame of an AA that opens the lips widest.
fap::Frame widest_frame(Ruler& ruler, const dam::Script& script, const fap::Sequence& clip) {
  fap::Frame widest;
  double most = 0;
  for (const dam::Phone& phone : script.phones) {
    for (const fap::Frame& frame : clip.frames) {
      if (phone.label != "AA" || !is_during(phone, clip.rate.seconds(double(frame.number)))) {
        continue;
      }
      const double gap = ruler.of(frame).gap;
      if (gap <= most) continue;
      most = gap;
      widest = frame;
    }
  }
  return widest;
}

// Width, height and how far forward, of what is round.
void add_round(const std::map<std::string, Mouth>& sounds, const Mouth& iy,
               std::vector<SpeakRow>& rows) {
  for (const char* label : {"UW", "OW", "W"}) {
    const auto found = sounds.find(label);
    if (found == sounds.end()) continue;
    const Mouth& round = found->second;
    const std::string against = std::string(label) + " against IY";
    const double narrower = iy.width > 0 ? 100 * (1 - round.width / iy.width) : 0;
    rows.push_back({against, "mouth narrower, %", narrower,
                    100 * (std::string_view(label) == "W" ? kRoundGlide : kRoundVowel), false});
    rows.push_back({against, "lips forward, mm", round.forward - iy.forward, 0.5, false});
    rows.push_back({label, "lips apart, mm", round.gap, 0.1, false});
  }
}

// Lips and tongue at the teeth.
void add_at_teeth(const Ruler& ruler, const std::map<std::string, Mouth>& sounds,
                  std::vector<SpeakRow>& rows) {
  for (const char* label : {"F", "V"}) {
    const auto found = sounds.find(label);
    if (found == sounds.end()) continue;
    rows.push_back({label, "lips apart, mm", found->second.gap, kTeethShow, false});
    if (!ruler.has_teeth()) continue;
    rows.push_back({label, "lip below teeth, mm", found->second.to_teeth, kLipAtTeeth, true});
  }
  const auto th = sounds.find("TH");
  if (th == sounds.end()) return;
  rows.push_back({"TH", "lips apart, mm", th->second.gap, kTeethShow, false});
  if (!ruler.has_teeth() || !ruler.has_tongue() || !ruler.knows_phones()) return;
  rows.push_back({"TH", "tongue behind teeth, mm", -th->second.tongue, kTongueBehind, true});
}

}  // namespace

Result<double> speaking_gain(const head::Head& head) {
  if (auto can = measurable(head); !can) return can.error();
  const dam::Script script = sentence();
  const Result<fap::Sequence> clip = said(script);
  if (!clip) return clip.error();
  head::Rig rig = head::make_rig(head);
  rig.mouth_gain = 1;
  Ruler ruler(head, rig, false);
  const double wanted = kWideOpen * full_opening(ruler);
  const fap::Frame widest = widest_frame(ruler, script, *clip);
  double low = 1, high = fap::kMostMouthGain;
  if (ruler.of(widest).gap >= wanted) return low;
  for (int step = 0; step < 16; ++step) {
    const double middle = (low + high) / 2;
    rig.mouth_gain = middle;
    (ruler.of(widest).gap < wanted ? low : high) = middle;
  }
  return high;
}

Result<std::vector<SpeakRow>> check_speech(const head::Head& head, const head::Rig& rig,
                                           const SpeakOptions& options) {
  if (auto can = measurable(head); !can) return can.error();
  const dam::Script script = long_sentence();
  const Result<fap::Sequence> clip = said(script);
  if (!clip) return clip.error();
  const auto visemes = dam::viseme_weights(script, *clip);
  Ruler ruler(head, rig, options.visemes);
  // Consonants at their narrowest, vowels at their widest (UW, OW and W in the middle).
  std::vector<SpeakRow> rows;
  Mouth aa, iy;
  std::map<std::string, Mouth> sounds;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label == "SIL") continue;
    std::vector<Mouth> seen;
    for (std::size_t i = 0; i < clip->frames.size(); ++i) {
      const fap::Frame& frame = clip->frames[i];
      if (is_during(phone, clip->rate.seconds(double(frame.number)))) {
        seen.push_back(ruler.of(frame, visemes[i]));
      }
    }
    if (seen.empty()) continue;
    const auto by_gap = [](const Mouth& a, const Mouth& b) { return a.gap < b.gap; };
    const auto [least, most] = std::minmax_element(seen.begin(), seen.end(), by_gap);
    const Mouth& middle = seen[seen.size() / 2];
    if (phone.label == "AA" && most->gap > aa.gap) aa = *most;
    if (phone.label == "IY" && !(iy.width > 0)) iy = middle;
    sounds[phone.label] = middle;
    if (std::string_view("PBM").find(phone.label) != std::string_view::npos) {
      rows.push_back({phone.label, "lips apart, mm", std::max(least->gap, 0.0), 0.1, true});
    }
  }
  add_round(sounds, iy, rows);
  const double range = full_opening(ruler);
  rows.push_back({"AA", "open, % of a full opening", range > 0 ? 100 * aa.gap / range : 0,
                  100 * kWideOpen, false});
  rows.push_back({"IY", "lips apart, mm", iy.gap, 0.1, false});
  rows.push_back({"IY", "lips apart, % of AA", aa.gap > 0 ? 100 * iy.gap / aa.gap : 0,
                  100 * kCloseVowel, true});
  add_at_teeth(ruler, sounds, rows);
  if (const auto apart = ruler.lids(closed_lids())) {
    rows.push_back({"blink", "lids apart, % of rest", 100 * *apart, 100 * kShutLids, true});
  }
  return rows;
}

}  // namespace animeme::studio
