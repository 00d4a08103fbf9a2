#include "fap/xml/detail/writable.h"

namespace animeme::head::detail {

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
        "the head has no feature points, which face definition files are about; name some, or "
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
