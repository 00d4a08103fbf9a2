// How far the raised cosines of a written .fdp are from our own rig.
#pragma once

#include "fap/tables.h"
#include "fap/xml/detail/fdp_file.h"
#include "fap/xml/detail/moves.h"
#include "fap/xml/fdp.h"

namespace animeme::test {

/// Distances in cm over the vertices that a FAP moves by more than 0.001 cm, in ours or in Xface.
struct FdpError {
  double rms = 0;
  double largest = 0;
  double move = 0;  ///< RMS of our own moves
  std::size_t vertices = 0;

  void add(head::Vec3 ours, head::Vec3 theirs) {
    if (length(ours) < 1e-3f && length(theirs) < 1e-3f) return;
    const double d = length(ours - theirs);
    rms += d * d;  // sums until finish()
    move += double(dot(ours, ours));
    largest = std::max(largest, d);
    ++vertices;
  }
  void finish() {
    const double count = vertices > 0 ? double(vertices) : 1;
    rms = std::sqrt(rms / count);
    move = std::sqrt(move / count);
  }
};

struct FdpMeasure {
  std::array<FdpError, fap::kGroupCount> groups;
  FdpError all;
  std::size_t regions = 0;
  std::size_t most_influences = 0;  ///< on one vertex
  std::size_t lost = 0;             ///< influences beyond the eighth of a vertex
};

/// Moves of every FAP that shifts vertices, at a value of 300 (eyes come out by 50), as the file
/// says and as the rig does them without contact. `scale`: units of the file for one cm.
inline Result<FdpMeasure> measure_fdp(const head::Rig& rig, const head::FdpFiles& files,
                                      double scale) {
  const auto file = head::detail::load_fdp(
      files.fdp, [&](const std::string&) -> Result<std::string> { return files.wrl; });
  if (!file) return file.error();
  FdpMeasure measure;
  std::vector<head::detail::XfaceMesh> meshes;
  std::vector<head::Part> parts;
  for (const head::detail::FdpMesh& mesh : file->meshes) meshes.emplace_back(mesh.positions);
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    if (!rig.parts[p].triangles.empty()) parts.push_back(head::Part(p));
  }
  std::vector<std::vector<std::size_t>> counts;
  for (const auto& mesh : file->meshes) counts.emplace_back(mesh.positions.size());
  for (const head::detail::XfaceItem& item : file->items) {
    meshes[item.mesh].add(item);
    measure.regions += item.influences.empty() ? 0 : 1;
    for (const auto& influence : item.influences) {
      const auto factors = raised_cosine(file->meshes[item.mesh].positions, item, influence);
      for (std::size_t i = 0; i < factors.size(); ++i) {
        if (factors[i] != 0) ++counts[item.mesh][item.region[i]];
      }
    }
  }
  for (const auto& of_mesh : counts) {
    for (const std::size_t n : of_mesh) {
      measure.most_influences = std::max(measure.most_influences, n);
    }
  }
  for (const auto& mesh : meshes) measure.lost += mesh.lost();
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const double step = head::detail::xface_step(fap, file->fapu);
    if (step == 0 || fap::move_of(fap).kind != fap::MoveKind::translate) continue;
    const int value = fap == 27 || fap == 28 ? 50 : 300;
    FdpError& group = measure.groups[std::size_t(fap::info(fap).group - 1)];
    const auto ours = head::detail::moves_between(rig, fap, 0, value);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const auto factors = meshes[m].factors(fap);
      const auto& moves = ours[std::size_t(parts[m])];
      const head::Vec3 unit = head::detail::xface_direction(fap) * float(step / scale * value);
      for (std::size_t v = 0; v < factors.size(); ++v) {
        const head::Vec3 own = moves.empty() ? head::Vec3{} : moves[v] * float(value);
        group.add(own, unit * factors[v]);
        measure.all.add(own, unit * factors[v]);
      }
    }
  }
  for (FdpError& group : measure.groups) group.finish();
  measure.all.finish();
  return measure;
}

}  // namespace animeme::test
