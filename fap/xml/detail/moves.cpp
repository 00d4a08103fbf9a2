#include "fap/xml/detail/moves.h"

namespace animeme::head::detail {
namespace {

Pose posed(const Rig& rig, int fap, int value) {
  fap::Frame frame;
  frame.set(fap, value);
  return pose(rig, frame, {.contact = false});
}

}  // namespace

std::array<std::vector<Vec3>, kPartCount> moves_between(const Rig& rig, int fap, int from, int to) {
  const Pose first = posed(rig, fap, from);
  const Pose last = posed(rig, fap, to);
  std::array<std::vector<Vec3>, kPartCount> moves;
  const float share = 1 / float(to - from);
  for (std::size_t part = 0; part < moves.size(); ++part) {
    const auto& neutral = rig.parts[part].positions;
    const auto& a = first.positions[part].empty() ? neutral : first.positions[part];
    const auto& b = last.positions[part].empty() ? neutral : last.positions[part];
    if (a == b && first.transforms[part] == last.transforms[part]) continue;
    moves[part].resize(neutral.size());
    for (std::size_t v = 0; v < neutral.size(); ++v) {
      moves[part][v] = (last.transforms[part](b[v]) - first.transforms[part](a[v])) * share;
    }
  }
  return moves;
}

Result<void> check_writable(const Head& head, const Rig& rig) {
  const auto refuse = [](std::string message) {
    return make_error(Code::invalid_argument, std::move(message));
  };
  bool any = false;
  for (const FeaturePoint& point : head.feature_points) {
    any = any || (point.exists() && point.part == Part::skin);
  }
  if (!any) {
    return refuse(
        "the head has no feature points, which face definition files require; name some, or "
        "write another format");
  }
  const fap::Fapu& f = head.fapu;
  if (!(f.es > 0 && f.irisd > 0 && f.ens > 0 && f.mns > 0 && f.mw > 0)) {
    return refuse("the head has no FAPU");
  }
  for (std::size_t p = 0; p < head.parts.size(); ++p) {
    if (rig.parts[p].positions.size() != head.parts[p].positions.size()) {
      return refuse("the rig is that of another head");
    }
  }
  return {};
}

}  // namespace animeme::head::detail
