#include "tools/characters/crossmap/run.h"

#include <cmath>

#include "tools/formats/common/text.h"

namespace animeme::crossmap {

RegionResidual region_residual(const Mapped& mapped, std::size_t take, std::size_t region) {
  const std::size_t regions = mapped.capture.regions.size();
  const auto& residuals = mapped.takes[take].blend.residuals;
  RegionResidual out;
  std::size_t count = 0;
  for (std::size_t i = 0; i * regions + region < residuals.size(); ++i) {
    const double value = residuals[i * regions + region];
    if (std::isnan(value)) continue;
    out.rms += value * value;
    ++count;
    if (value <= out.worst) continue;
    out.worst = value;
    out.frame = i;
  }
  if (count > 0) out.rms = std::sqrt(out.rms / double(count));
  return out;
}

Result<Mapped> run(const Project& project, const tools::Log& log) {
  Mapped out;
  auto capture = load_capture(project, log);
  if (!capture) return capture.error();
  out.capture = std::move(*capture);
  auto keys = load_keys(project, out.capture, log);
  if (!keys) return keys.error();
  out.keys = std::move(*keys);
  auto target = load_target(project, out.capture, out.keys, log);
  if (!target) return target.error();
  out.target = std::move(*target);
  for (const dam::PointTrack& track : out.capture.tracks) {
    auto blend = dam::fit_blend(track, out.keys.shapes, out.capture.regions, out.capture.fit);
    if (!blend) return blend.error();
    if (blend->partly > 0) {
      log.warn(track.name + ": points are missing in " + std::to_string(blend->partly) +
               " frames, which are fitted to the others");
    }
    if (blend->unseen > 0) {
      log.warn(track.name + ": nothing is seen in " + std::to_string(blend->unseen) +
               " frames; they are bridged and marked as not measured");
    }
    auto retarget = fit_target(out.target, *blend, track.rate, project.controls_fit);
    if (!retarget) return retarget.error();
    out.takes.push_back({std::move(*blend), std::move(*retarget)});
  }
  return out;
}

}  // namespace animeme::crossmap
