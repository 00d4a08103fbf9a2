#include <limits>

#include "fap/head/detail/assemble.h"

namespace animeme::head::detail {
namespace {

class Finder {
 public:
  Finder(const Shape& shape, const Skin& skin, Head& head)
      : shape_(shape), skin_(skin), head_(head) {}

  void set(std::string_view id, Part part, std::uint32_t vertex) {
    for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
      if (fap::kFeaturePoints[i].id == id) head_.feature_points[i] = {part, vertex};
    }
  }
  void grid(std::string_view id, int row, int column) {
    set(id, Part::skin, skin_.at(row, column));
  }
  // The same place on both sides.
  void pair(std::string_view left, std::string_view right, int row, int column) {
    grid(left, row, column);
    grid(right, row, -column);
  }
  /// The vertex of the face nearest to a place of its left side, and its mirror image.
  void near(std::string_view left, std::string_view right, Vec3d place) {
    const Layout& l = skin_.layout;
    double best = std::numeric_limits<double>::max();
    int best_row = 0;
    int best_column = 0;
    for (int row = 1; row < l.bottom; ++row) {
      for (int c = 0; c < l.columns(); ++c) {
        const Vec3d d = skin_.places[skin_.at(row, c)] - place;
        if (dot(d, d) >= best) continue;
        best = dot(d, d);
        best_row = row;
        best_column = c;
      }
    }
    grid(left, best_row, best_column);
    if (!right.empty()) grid(right, best_row, -best_column);
  }
  void near_front(std::string_view left, std::string_view right, double x, double y) {
    near(left, right, shape_.front(x, y));
  }
  /// The vertex first..end - 1 of a part that is furthest along a direction.
  std::uint32_t furthest(Part part, Vec3 direction, std::uint32_t first, std::uint32_t end) const {
    const auto& places = head_.part(part).positions;
    std::uint32_t best = first;
    for (std::uint32_t i = first; i < end; ++i) {
      if (dot(places[i], direction) > dot(places[best], direction)) best = i;
    }
    return best;
  }
  std::uint32_t count(Part part) const { return std::uint32_t(head_.part(part).positions.size()); }
  /// Row of column 0 between two rows with the largest value.
  template <class Value>
  int best_row(int first, int last, const Value& value) const {
    int best = first;
    for (int row = first; row <= last; ++row) {
      if (value(place(row)) > value(place(best))) best = row;
    }
    return best;
  }
  Vec3d place(int row) const { return skin_.places[skin_.at(row, 0)]; }

 private:
  const Shape& shape_;
  const Skin& skin_;
  Head& head_;
};

void lips_and_chin(const Layout& l, Finder& find) {
  const int corner = l.mouth_corner;
  const int half = corner / 2;
  find.grid("2.2", l.upper_contact, 0);
  find.grid("2.3", l.lower_contact, 0);
  find.pair("2.4", "2.5", l.upper_contact, corner);
  find.pair("2.6", "2.7", l.upper_contact, half);
  find.pair("2.8", "2.9", l.lower_contact, half);
  find.grid("8.1", l.upper_lip, 0);
  find.grid("8.2", l.lower_lip, 0);
  find.pair("8.3", "8.4", l.upper_contact, corner + std::max(corner * 3 / 20, 1));
  find.pair("8.5", "8.6", l.upper_lip, half);
  find.pair("8.7", "8.8", l.lower_lip, half);
  find.pair("8.10", "8.9", l.upper_lip, corner / 5);
  const auto low = [](Vec3d p) { return -p.y + 0.35 * p.z; };
  find.grid("2.1", find.best_row(l.lower_lip, l.under_chin, low), 0);
  const int fold = find.best_row(l.lower_lip, l.lower_lip + (l.chin - l.lower_lip) / 2,
                                 [](Vec3d p) { return -p.z; });
  find.grid("2.10", find.best_row(fold, l.chin, [](Vec3d p) { return p.z; }), 0);
}

void jaw_cheeks_and_brows(const Shape& shape, Finder& find) {
  const HeadParameters& p = shape.p;
  find.near("2.11", "2.12", {p.chin_size * 1.6, -p.chin_drop + 0.7, 7.0});
  find.near("2.13", "2.14", {p.jaw_width * 1.6, -p.chin_drop + 3.2, 1.6});
  find.near_front("4.1", "4.2", shape.brow(0).x, shape.brow(0).y);
  find.near_front("4.3", "4.4", shape.brow(0.5).x, shape.brow(0.5).y);
  find.near_front("4.5", "4.6", shape.brow(1).x, shape.brow(1).y);
  find.near_front("5.1", "5.2", 4.0, -p.mouth_drop + 0.6);
  find.near_front("5.3", "5.4", 4.3, -2.5);
}

void eyes(const Layout& l, Finder& find) {
  const int middle = (l.eye_inner + l.eye_outer) / 2;
  find.pair("3.1", "3.2", l.upper_lid, middle);
  find.pair("3.3", "3.4", l.lower_lid, middle);
  find.set("3.5", Part::left_eye, 0);
  find.set("3.6", Part::right_eye, 0);
  find.pair("3.7", "3.12", l.upper_lid, l.eye_outer);
  find.pair("3.11", "3.8", l.upper_lid, l.eye_inner);
  find.pair("3.9", "3.10", l.lower_lid + 5, middle);
  find.pair("3.13", "3.14", l.upper_lid - 5, middle);
}

void nose(const Shape& shape, const Layout& l, Finder& find) {
  const HeadParameters& p = shape.p;
  const double tip = -p.nose_length;
  find.near("9.1", "9.2", {p.nose_size * 1.75, tip - 0.28, 9.0});
  find.grid("9.3", find.best_row(l.lower_lid, l.nose_base, [](Vec3d q) { return q.z; }), 0);
  find.near("9.5", "9.4", {p.nose_size * 0.95, tip - 0.75, 9.3});
  find.near_front("9.7", "9.6", 0.75, -0.2);
  find.near_front("9.12", "", 0, tip * 0.45);
  find.near_front("9.13", "9.14", 0.95, tip * 0.5);
  find.grid("9.15", l.nose_base, 0);
}

void teeth_and_tongue(Finder& find) {
  const auto tooth = [&](std::string_view id, Part part, float up) {
    find.set(id, part, find.furthest(part, {0, up, 0.5f}, 0, find.count(part)));
  };
  tooth("9.8", Part::upper_teeth, 1);
  tooth("9.9", Part::lower_teeth, -1);
  tooth("9.10", Part::upper_teeth, -1);
  tooth("9.11", Part::lower_teeth, 1);
  const auto on_tongue = [](int row, int k) { return std::uint32_t(row * kTongueAround + k); };
  find.set("6.1", Part::tongue, find.count(Part::tongue) - 1);
  find.set("6.2", Part::tongue, on_tongue(kTongueRows * 3 / 8, 0));
  find.set("6.3", Part::tongue, on_tongue(kTongueRows / 2, kTongueAround / 4));
  find.set("6.4", Part::tongue, on_tongue(kTongueRows / 2, kTongueAround * 3 / 4));
}

void ears_and_hair(const Shape& shape, const EarVertices& ears, Finder& find) {
  const struct {
    std::string_view left, right;
    Vec3 direction;
  } points[] = {{"10.1", "10.2", {0, 1, 0}},
                {"10.3", "10.4", {0.2f, 0, -1}},
                {"10.5", "10.6", {0, -1, 0}},
                {"10.7", "10.8", {-0.3f, -0.8f, 0.6f}},
                {"10.9", "10.10", {-0.3f, 0.8f, 0.6f}}};
  for (const auto& p : points) {
    const std::uint32_t vertex =
        find.furthest(Part::skin, p.direction, ears.left_first, ears.right_first);
    find.set(p.left, Part::skin, vertex);
    find.set(p.right, Part::skin, vertex + ears.right_first - ears.left_first);
  }
  find.near_front("11.1", "", 0, 5.9);
  find.near("11.3", "11.2", shape.front(4.6, 4.6));
  find.grid("11.4", 0, 0);
  if (shape.p.hair == HairStyle::bald) {
    find.grid("11.5", 0, 0);
  } else {
    find.set("11.5", Part::hair, find.furthest(Part::hair, {0, 1, 0}, 0, find.count(Part::hair)));
  }
  find.near("11.6", "", {0, 3.4, -9.4});
}

}  // namespace

void find_feature_points(const Shape& shape, const Skin& skin, const EarVertices& ears,
                         Head& head) {
  Finder find(shape, skin, head);
  lips_and_chin(skin.layout, find);
  jaw_cheeks_and_brows(shape, find);
  eyes(skin.layout, find);
  nose(shape, skin.layout, find);
  teeth_and_tongue(find);
  ears_and_hair(shape, ears, find);
}

}  // namespace animeme::head::detail
