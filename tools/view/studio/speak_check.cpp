#include "tools/view/studio/speak_check.h"

#include <algorithm>

#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/arkit.h"
#include "fap/fill.h"
#include "fap/wider.h"

namespace animeme::studio {
namespace {

struct Mouth {
  double gap = 0;      // beyond that at rest, mm
  double width = 0;    // between the corners, mm
  double forward = 0;  // mean of both lips, mm beyond rest
};

class Ruler {
 public:
  Ruler(const head::Head& head, const head::Rig& rig)
      : head_(head), rig_(rig), scale_(kEyesApart / head.fapu.es) {}

  Mouth of(const fap::Frame& frame) {
    head::pose(rig_, frame, pose_);
    const auto moved = [&](std::string_view id) {
      const head::FeaturePoint point = head_.point(id);
      const auto& places = pose_.positions[std::size_t(point.part)];
      return places.empty() ? head_.at(id) : places[point.vertex];
    };
    const head::Vec3 up = moved("2.2"), low = moved("2.3");
    const head::Vec3 up0 = head_.at("2.2"), low0 = head_.at("2.3");
    return {scale_ * double((up.y - low.y) - (up0.y - low0.y)),
            scale_ * double(length(moved("2.4") - moved("2.5"))),
            scale_ * double(up.z + low.z - up0.z - low0.z) / 2};
  }

 private:
  const head::Head& head_;
  const head::Rig& rig_;
  double scale_;  // mm for 1 cm of the head
  head::Pose pose_;
};

dam::Script sentence() {
  dam::Script script;
  double at = 0;
  for (const char* label :
       {"SIL", "P", "AA", "B", "AA", "M", "AA", "SIL", "IY", "SIL", "UW", "SIL"}) {
    const bool lips = std::string_view("PBM").find(label) != std::string_view::npos;
    const double long_for = lips ? 0.1 : 0.3;
    script.phones.push_back({at, at + long_for, label, ""});
    at += long_for;
  }
  return script;
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

double full_opening(Ruler& ruler) {
  fap::ArkitFrame open{};
  open[std::size_t(fap::find_arkit("jawOpen").value_or(0))] = 1;
  return ruler.of(fap::arkit_to_fap(open, fap::kAllArkit)).gap;
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

}  // namespace

Result<double> speaking_gain(const head::Head& head) {
  if (auto can = measurable(head); !can) return can.error();
  const dam::Script script = sentence();
  const Result<fap::Sequence> clip = said(script);
  if (!clip) return clip.error();
  head::Rig rig = head::make_rig(head);
  rig.mouth_gain = 1;
  Ruler ruler(head, rig);
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

Result<std::vector<SpeakRow>> check_speech(const head::Head& head, const head::Rig& rig) {
  if (auto can = measurable(head); !can) return can.error();
  const dam::Script script = sentence();
  const Result<fap::Sequence> clip = said(script);
  if (!clip) return clip.error();
  Ruler ruler(head, rig);
  // Consonants at their narrowest, vowels at their widest (UW: roundest).
  std::vector<SpeakRow> rows;
  Mouth aa, iy, uw;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label == "SIL") continue;
    std::vector<Mouth> seen;
    for (const fap::Frame& frame : clip->frames) {
      if (is_during(phone, clip->rate.seconds(double(frame.number)))) {
        seen.push_back(ruler.of(frame));
      }
    }
    if (seen.empty()) continue;
    const auto by_gap = [](const Mouth& a, const Mouth& b) { return a.gap < b.gap; };
    const auto [least, most] = std::minmax_element(seen.begin(), seen.end(), by_gap);
    if (phone.label == "AA" && most->gap > aa.gap) aa = *most;
    if (phone.label == "IY") iy = seen[seen.size() / 2];
    if (phone.label == "UW") uw = seen[seen.size() / 2];
    if (phone.label.size() == 1) {
      rows.push_back({phone.label, "lips apart, mm", std::max(least->gap, 0.0), 0.1, true});
    }
  }
  const double range = full_opening(ruler);
  const double narrower = iy.width > 0 ? 100 * (1 - uw.width / iy.width) : 0;
  rows.push_back({"UW against IY", "mouth narrower, %", narrower, 100 * kRoundVowel, false});
  rows.push_back({"UW against IY", "lips forward, mm", uw.forward - iy.forward, 0.1, false});
  rows.push_back({"AA", "open, % of a full jawOpen", range > 0 ? 100 * aa.gap / range : 0,
                  100 * kWideOpen, false});
  rows.push_back({"IY", "lips apart, mm", iy.gap, 0.1, false});
  rows.push_back({"IY", "lips apart, % of AA", aa.gap > 0 ? 100 * iy.gap / aa.gap : 0,
                  100 * kCloseVowel, true});
  rows.push_back({"UW", "lips apart, mm", uw.gap, 0.1, false});
  return rows;
}

}  // namespace animeme::studio
