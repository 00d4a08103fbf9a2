// How Xface moves a face: raised cosines around feature points. Facts of the player, for the reader
// and for the writer. Source: the format as its player takes it; fap/head/face_models.md, section
// 2.
#pragma once

#include <array>
#include <span>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// What distance from the pivot means.
enum class Reach : std::uint8_t { sphere, wave_x, wave_y, wave_z };
/// "RaisedCosInfluenceSph" ...
inline constexpr std::array<std::string_view, 4> kReachNames = {
    "RaisedCosInfluenceSph", "RaisedCosInfluenceWaveX", "RaisedCosInfluenceWaveY",
    "RaisedCosInfluenceWaveZ"};

/// One influence of an <fdp>: a FAP moves the region by weight * (cos(pi * d / d_max) + 1) units,
/// d the distance from the pivot, d_max the largest in the region.
struct XfaceInfluence {
  int fap = 0;  ///< 1..68; the file counts from 0
  Reach reach = Reach::sphere;
  float weight = 0;
};

/// An <fdp> element.
struct XfaceItem {
  std::string name;      ///< "2.1"; may be anything
  std::size_t mesh = 0;  ///< that it moves
  std::uint32_t pivot = 0;
  std::vector<std::uint32_t> region;  ///< ascending
  std::vector<XfaceInfluence> influences;
};

/// More influences on one vertex are lost in Xface; the first ones count.
inline constexpr std::size_t kXfaceSlots = 8;
/// Vertices of a mesh are counted with 16 bits.
inline constexpr std::size_t kXfaceMostVertices = 65536;

/// Direction of positive values: that of the table, but upper lids also come forward by half as
/// much, and turns of the eyeballs are shifts: yaw to the left, pitch down. Zero for FAPs by which
/// Xface moves no vertex as it should (high-level ones, the head, pupils, the rolled tongue).
Vec3 xface_direction(int fap);

/// Model units of one step at weight 0.5, or 0: that of the table, but FAP 19 counts in MNS, a slip
/// of the player that its files allow for. 1e-5 for turns of the eyeballs.
double xface_step(int fap, const fap::Fapu& fapu);

/// Distance of two points.
float xface_distance(Reach reach, Vec3 a, Vec3 b);

/// The factor of each vertex of item.region, 2 * weight at the pivot.
std::vector<float> raised_cosine(std::span<const Vec3> positions, const XfaceItem& item,
                                 const XfaceInfluence& influence);

/// What the influences of all items add up to on one mesh.
class XfaceMesh {
 public:
  explicit XfaceMesh(std::span<const Vec3> positions)
      : positions_(positions), slots_(positions.size()), used_(positions.size()) {}

  /// Items in the order of the file. Pivot and region lie within the mesh.
  void add(const XfaceItem& item);
  /// How often an influence found no free slot of a vertex.
  std::size_t lost() const { return lost_; }
  /// How far the vertices move for one step of the FAP, in units of its direction and step.
  std::vector<float> factors(int fap) const;

 private:
  struct Slot {
    int fap = 0;
    float factor = 0;
  };
  std::span<const Vec3> positions_;
  std::vector<std::array<Slot, kXfaceSlots>> slots_;
  std::vector<std::uint8_t> used_;
  std::size_t lost_ = 0;
};

}  // namespace animeme::head::detail
