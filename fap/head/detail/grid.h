// The mesh of the skin: rows from the crown to the neck, columns around, with slits for eyes and
// mouth. Rows bend around the slits, so edges run along lids and lips.
#pragma once

#include <cstdint>
#include <vector>

#include "fap/head/detail/shape.h"

namespace animeme::head::detail {

/// Numbers of rows and columns. Rows count from the crown; a slit has two rows.
struct Layout {
  explicit Layout(double density);

  // Columns of the left half, 0 = front, `back` = back.
  int mouth_corner, eye_inner, eye_outer, back;
  // Rows where something begins.
  int hairline, brow, upper_lid, lower_lid, nose_base, upper_lip, upper_contact, lower_contact,
      lower_lip, chin, under_chin, throat, bottom;

  int rows() const { return bottom + 1; }
  int columns() const { return back + 1; }
  bool in_eye(int column) const { return column >= eye_inner && column <= eye_outer; }
  bool in_mouth(int column) const { return column <= mouth_corner; }
};

/// Places of the left half, row by row: grid[row * columns + column].
std::vector<Vec3d> lay_out(const Shape& shape, const Layout& layout);

/// The skin with everything that hangs on its topology.
struct Skin {
  Layout layout;
  Mesh mesh;
  Seams seams;
  std::vector<Vec3d> places;  ///< as mesh.positions

  /// Vertex of a row and a column, negative columns on the right.
  std::uint32_t at(int row, int column) const;
  std::vector<std::uint32_t> ids;  ///< row by row, columns 0..2*back-1 (right ones at the end)
};

/// Face, neck, bag of the mouth and sockets.
Skin make_skin(const Shape& shape, double density);

// What lies behind the slits of the skin: the bag of the mouth and the pockets of the eyes.

/// Lips from inside, vestibule, cavity; also the contact pairs and jaw weights.
void add_mouth_bag(const Shape& shape, Skin& skin);

/// Rim of the lids and a pocket inside the eyeball; side 1: left, -1: right. Also the contact
/// pairs and lid weights.
void add_eye_pocket(const Shape& shape, Skin& skin, int side);

}  // namespace animeme::head::detail
