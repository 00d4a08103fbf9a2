#include "codec/encode/plan_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

bool is_event(const ClipData& clip, std::size_t plane) {
  if (clip.viseme.empty()) return false;
  const bool same = clip.viseme[plane] == clip.viseme[plane - 1] &&
                    clip.expression[plane] == clip.expression[plane - 1];
  return !same || clip.viseme[plane].def || clip.expression[plane].def ||
         clip.expression[plane].init_face;
}

}  // namespace

std::vector<std::size_t> moving_planes(const ClipData& clip, const Decision& decision) {
  std::vector<bool> moving(clip.planes(), false);
  moving.back() = true;
  for (const Row& row : decision.rows) {
    for (std::size_t plane = 1; plane < moving.size(); ++plane) {
      if (row.levels[plane] != row.levels[plane - 1]) moving[plane] = true;
    }
  }
  std::vector<std::size_t> planes = {0};
  for (std::size_t plane = 1; plane < moving.size(); ++plane) {
    const bool far = plane + 1 < moving.size() &&
                     clip.number[plane + 1] - clip.number[planes.back()] > kMaxSkip + 1;
    if (moving[plane] || is_event(clip, plane) || far) planes.push_back(plane);
  }
  return planes;
}

void keep_planes(const std::vector<std::size_t>& planes, ClipData& clip, Decision& decision) {
  const auto keep = [&](auto& row) {
    if (row.empty()) return;
    for (std::size_t i = 0; i < planes.size(); ++i) row[i] = row[planes[i]];
    row.resize(planes.size());
  };
  keep(clip.number);
  keep(clip.viseme);
  keep(clip.expression);
  for (Channel& channel : clip.channels) keep(channel.value);
  for (Row& row : decision.rows) keep(row.levels);
}

}  // namespace animeme::fba::internal
