#include "fap/xml/detail/xface.h"

namespace animeme::head::detail {

namespace {

// Yaw and pitch of the eyeballs.
bool turns_eye(int fap) { return fap >= 23 && fap <= 26; }

}  // namespace

Vec3 xface_direction(int fap) {
  if (turns_eye(fap)) return fap <= 24 ? Vec3{1, 0, 0} : Vec3{0, -1, 0};
  const fap::Move move = fap::move_of(fap);
  if (move.kind != fap::MoveKind::translate) return {};
  Vec3 direction(Vec3d{move.axis[0], move.axis[1], move.axis[2]});
  if (fap == 19 || fap == 20) direction.z += 0.5f;
  return direction;
}

double xface_step(int fap, const fap::Fapu& fapu) {
  if (fap == 19) return fapu.mns / 1024;
  const bool moves = turns_eye(fap) || fap::move_of(fap).kind == fap::MoveKind::translate;
  return moves ? fap::step_size(fap, fapu) : 0;
}

float xface_distance(Reach reach, Vec3 a, Vec3 b) {
  const Vec3 d = a - b;
  switch (reach) {
    case Reach::wave_x:
      return std::abs(d.x);
    case Reach::wave_y:
      return std::abs(d.y);
    case Reach::wave_z:
      return std::abs(d.z);
    case Reach::sphere:
      break;
  }
  return length(d);
}

std::vector<float> raised_cosine(std::span<const Vec3> positions, const XfaceItem& item,
                                 const XfaceInfluence& influence) {
  std::vector<float> factors;
  float farthest = 0;
  for (const std::uint32_t v : item.region) {
    factors.push_back(xface_distance(influence.reach, positions[item.pivot], positions[v]));
    farthest = std::max(farthest, factors.back());
  }
  for (float& f : factors) {
    // Xface divides by 0 where the region is one point; that point moves with full weight here.
    const double share = farthest > 0 ? double(f) / double(farthest) : 0;
    f = float(std::cos(std::numbers::pi * share) + 1) * influence.weight;
  }
  return factors;
}

void XfaceMesh::add(const XfaceItem& item) {
  for (const XfaceInfluence& influence : item.influences) {
    const std::vector<float> factors = raised_cosine(positions_, item, influence);
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const std::uint32_t v = item.region[i];
      if (factors[i] == 0) continue;  // takes no slot
      if (used_[v] == kXfaceSlots) {
        ++lost_;
        continue;
      }
      slots_[v][used_[v]++] = {influence.fap, factors[i]};
    }
  }
}

std::vector<float> XfaceMesh::factors(int fap) const {
  std::vector<float> sums(slots_.size());
  for (std::size_t v = 0; v < slots_.size(); ++v) {
    for (std::size_t k = 0; k < used_[v]; ++k) {
      if (slots_[v][k].fap == fap) sums[v] += slots_[v][k].factor;
    }
  }
  return sums;
}

}  // namespace animeme::head::detail
