#include "fap/shape_fit.h"

#include <algorithm>

#include "fap/detail/face_fit.h"

namespace animeme::fap {
namespace {

// Teeth that show in a P are seen at once. On the built-in woman with ARKit's shapes the lips of
// one sentence stay apart in closures by 1.4 mm at 0, 1.0 at 3, 0.8 at 6, where a head that has
// visemes alone shows some of them at less than half their weight.
constexpr double kLipsCount = 3;

std::vector<std::vector<internal::ShapeWeight>> weights_of(std::span<const Frame> shapes) {
  std::vector<std::vector<internal::ShapeWeight>> weights;
  for (const Frame& shape : shapes) {
    std::vector<internal::ShapeWeight>& out = weights.emplace_back();
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      const auto f = std::size_t(fap);
      if (shape.mask[f] && shape.value[f] != 0) out.push_back({fap, shape.value[f]});
    }
  }
  return weights;
}

// Shapes that were added after the measuring count as those that leave the lips where they are.
internal::Lips lips_of(const LipMeasures& measures, std::size_t shapes) {
  internal::Lips lips{kLipsCount, {}, {}};
  std::copy(measures.at_rest.begin(), measures.at_rest.end(), lips.at_rest.begin());
  for (const LipDistances& c : measures.closing) lips.closing.push_back({c[0], c[1], c[2]});
  if (!lips.closing.empty()) lips.closing.resize(shapes);
  return lips;
}

}  // namespace

struct ShapeFitter::Impl {
  internal::FaceFit fit;
};

ShapeFitter::ShapeFitter(std::span<const Frame> shapes, const LipMeasures& lips, double ridge,
                         std::span<const std::optional<int>> arkit)
    : impl_(new Impl{{weights_of(shapes),
                      arkit.size() == shapes.size() ? arkit : std::span<const std::optional<int>>(),
                      {ridge, 0, arkit.size() == shapes.size() ? 1.0 : 0.0},
                      lips_of(lips, shapes.size())}}) {}
ShapeFitter::ShapeFitter(ShapeFitter&&) noexcept = default;
ShapeFitter& ShapeFitter::operator=(ShapeFitter&&) noexcept = default;
ShapeFitter::~ShapeFitter() = default;

const std::vector<double>& ShapeFitter::fit(const Frame& frame) {
  impl_->fit.restart();
  return impl_->fit.fit(frame, internal::target_of(frame));
}

}  // namespace animeme::fap
