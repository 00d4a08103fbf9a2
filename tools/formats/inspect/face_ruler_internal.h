// How far apart two runs of faces are on a head, in millimetres.
#pragma once

#include <vector>

#include "fap/frame.h"
#include "fap/head/rig.h"

namespace animeme::inspect {

// A built-in head with few vertices, ready to move.
const head::Rig& ruling_rig();

class FaceRuler {
 public:
  // Errors are measured from these faces, on at most `most` of them.
  FaceRuler(const std::vector<fap::Frame>& faces, std::size_t most);

  // Vertices of the skin that the faces move.
  std::size_t points() const { return moved_.size(); }
  // The frames that are looked at.
  const std::vector<std::size_t>& looked_at() const { return looked_at_; }
  // mm RMS; `faces` are as many as the ruler's.
  double error(const std::vector<fap::Frame>& faces) const;

 private:
  std::vector<std::size_t> looked_at_;
  std::vector<std::size_t> moved_;
  std::vector<head::Vec3> places_;  // of the moved ones, face after face
};

}  // namespace animeme::inspect
