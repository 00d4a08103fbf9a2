#include <algorithm>
#include <cmath>

#include "tools/formats/inspect/face_ruler_internal.h"

namespace animeme::inspect {

namespace {

constexpr float kMoved = 0.01f;                 // cm
constexpr double kMillimetres = 10;             // in a centimetre
constexpr std::size_t kTurns[] = {48, 49, 50};  // the head's

const std::vector<head::Vec3>& skin_of(fap::Frame face, head::Pose& pose) {
  for (const std::size_t fap : kTurns) face.value[fap] = 0;
  head::pose(ruling_rig(), face, pose);
  return pose.positions[std::size_t(head::Part::skin)];
}

float distance(const head::Vec3& a, const head::Vec3& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) +
                   (a.z - b.z) * (a.z - b.z));
}

}  // namespace

const head::Rig& ruling_rig() {
  static const head::Rig rig = [] {
    head::HeadParameters parameters;
    parameters.density = 0.5;
    return head::make_rig(*head::make_head(parameters));
  }();
  return rig;
}

FaceRuler::FaceRuler(const std::vector<fap::Frame>& faces, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>((faces.size() + most - 1) / most, 1);
  for (std::size_t i = 0; i < faces.size(); i += stride) looked_at_.push_back(i);
  head::Pose pose;
  const std::vector<head::Vec3> rest = skin_of({}, pose);
  std::vector<std::vector<head::Vec3>> all;
  std::vector<bool> moves(rest.size());
  for (const std::size_t i : looked_at_) {
    all.push_back(skin_of(faces[i], pose));
    for (std::size_t v = 0; v < rest.size(); ++v) {
      moves[v] = moves[v] || distance(all.back()[v], rest[v]) > kMoved;
    }
  }
  for (std::size_t v = 0; v < rest.size(); ++v) {
    if (moves[v]) moved_.push_back(v);
  }
  for (const auto& face : all) {
    for (const std::size_t v : moved_) places_.push_back(face[v]);
  }
}

double FaceRuler::error(const std::vector<fap::Frame>& faces) const {
  if (places_.empty()) return 0;
  head::Pose pose;
  double sum = 0;
  auto place = places_.begin();
  for (const std::size_t i : looked_at_) {
    const std::vector<head::Vec3>& skin = skin_of(faces[i], pose);
    for (const std::size_t v : moved_) {
      const double away = distance(skin[v], *place++);
      sum += away * away;
    }
  }
  return kMillimetres * std::sqrt(sum / double(places_.size()));
}

}  // namespace animeme::inspect
