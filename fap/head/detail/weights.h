// How far each vertex of the skin goes along with each feature point.
#pragma once

#include <string_view>

#include "fap/head/detail/geodesic.h"

namespace animeme::head::detail {

/// A table of weights: a row for each vertex, a column for each control.
class Weights {
 public:
  Weights(std::size_t vertices, std::size_t controls)
      : controls_(controls), values_(vertices * controls) {}

  std::size_t vertices() const { return values_.size() / controls_; }
  std::size_t controls() const { return controls_; }
  std::span<float> row(std::size_t vertex) {
    return std::span(values_).subspan(vertex * controls_, controls_);
  }
  std::span<const float> row(std::size_t vertex) const {
    return std::span(values_).subspan(vertex * controls_, controls_);
  }

 private:
  std::size_t controls_;
  std::vector<float> values_;
};

/// The moved feature points of the skin, in the order of the columns.
struct ControlInfo {
  std::string_view id;
  float reach;            ///< cm on a face whose pupils are 6.3 cm apart
  float core;             ///< cm: the pull is flat this near to the point
  std::string_view dual;  ///< the point of the other lip, for points of lips
};
std::span<const ControlInfo> controls();
/// Column of a feature point; -1 if it is none.
int control_index(std::string_view id);

/// Column that rounds the corner of the mouth as this FAP opens it; -1 if there is none.
int rounding_column(int fap);

/// Weights of all vertices of a head's skin, a column for each of controls() and for each
/// rounding_column(): 1 at the own point, 0 at all others. Columns of points that the head does not
/// have are 0. The column of 2.1 is that of the whole jaw.
Weights skin_weights(const Head& head);

/// Takes from values of all vertices of the skin what they are at feature points, by the weights of
/// these: they are 0 there then.
void hold_points(const Head& head, const Weights& weights, std::vector<float>& values);

}  // namespace animeme::head::detail
