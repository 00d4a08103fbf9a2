#include "fap/viseme.h"

#include <algorithm>
#include <cstdint>

#include "fap/detail/bounded_fit.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

constexpr int kMostBlend = 63;

// FAPs of the columns below; those of the left side stand for both.
constexpr std::array<int, 13> kColumns = {3, 4, 5, 6, 8, 10, 12, 51, 52, 53, 55, 57, 59};

// See viseme.h. tests/app/program/viseme_table_test.cpp measures it again.
constexpr std::array<std::array<std::int16_t, 13>, kVisemeCount> kTable = {{
    {},                                                                       // sil
    {161, 119, -104, -22, 104, -86, -56, 94, -133, -27, 82, -103, -50},       // PP
    {146, -87, -41, -8, -75, -18, 47, -50, -60, -4, -51, -30, 50},            // FF
    {91, -7, -22, -25, 3, -13, -17, -19, -67, -22, -8, -50, -20},             // TH
    {211, -85, -256, -13, -54, -227, -74, -41, -276, -5, -19, -238, -74},     // DD
    {177, -108, -240, -9, -76, -210, -48, -49, -246, -1, -30, -209, -46},     // kk
    {180, -160, -258, -27, -118, -227, -54, -86, -278, -16, -57, -238, -56},  // CH
    {145, -149, -184, -9, -111, -157, -22, -81, -203, 3, -59, -170, -22},     // SS
    {177, -41, -208, -15, -17, -182, -67, -16, -238, -9, 1, -201, -65},       // nn
    {112, 63, -79, -25, 70, -72, -76, 32, -126, -23, 44, -110, -78},          // RR
    {212, -91, -249, -27, -57, -214, -66, -40, -285, -17, -18, -238, -66},    // aa
    {256, -114, -349, -16, -74, -308, -91, -51, -363, -7, -24, -311, -89},    // E
    {190, -129, -261, -12, -92, -229, -56, -72, -272, -2, -46, -233, -55},    // ih
    {200, 6, -206, -61, 27, -172, -77, 23, -256, -55, 38, -205, -75},         // oh
    {144, 71, -131, -48, 79, -112, -89, 38, -201, -45, 52, -164, -89},        // ou
}};

std::array<Frame, kVisemeCount> all_shapes() {
  std::array<Frame, kVisemeCount> shapes;
  for (std::size_t viseme = 0; viseme < shapes.size(); ++viseme) {
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const int other = info(kColumns[i]).mirror;
      shapes[viseme].set(kColumns[i], kTable[viseme][i]);
      if (other != 0) shapes[viseme].set(other, kTable[viseme][i]);
    }
  }
  return shapes;
}

// Of all visemes but silence, which is what is left.
std::vector<std::vector<internal::ShapeWeight>> viseme_shapes() {
  std::vector<std::vector<internal::ShapeWeight>> shapes;
  for (int viseme = 1; viseme < kVisemeCount; ++viseme) {
    shapes.emplace_back();
    const Frame& shape = viseme_shape(viseme);
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (!shape.mask[std::size_t(fap)]) continue;
      shapes.back().push_back({fap, shape.value[std::size_t(fap)]});
    }
  }
  return shapes;
}

}  // namespace

VisemeWeights coded_viseme(const Viseme& viseme) {
  VisemeWeights weights{};
  const double share = double(std::clamp(viseme.blend, 0, kMostBlend)) / kMostBlend;
  const auto number = [](std::int32_t select) {
    return select >= 0 && select < kVisemeCount ? std::size_t(select) : std::size_t(0);
  };
  weights[number(viseme.select1)] += share;
  weights[number(viseme.select2)] += 1 - share;
  return weights;
}

const Frame& viseme_shape(int viseme) {
  static const std::array<Frame, kVisemeCount> shapes = all_shapes();
  return shapes[viseme > 0 && viseme < kVisemeCount ? std::size_t(viseme) : 0];
}

struct VisemeFitter::Impl {
  internal::BoundedFit fit;
};

VisemeFitter::VisemeFitter(const VisemeFitOptions& options)
    : impl_(new Impl{{viseme_shapes(), options.ridge, options.steadiness, 1.0}}) {}
VisemeFitter::VisemeFitter(VisemeFitter&&) noexcept = default;
VisemeFitter& VisemeFitter::operator=(VisemeFitter&&) noexcept = default;
VisemeFitter::~VisemeFitter() = default;

VisemeWeights VisemeFitter::fit(const Frame& frame) {
  if (frame.mask[1]) return coded_viseme(frame.viseme);
  VisemeWeights weights{};
  const std::vector<double>& found = impl_->fit.fit(frame.mask, internal::target_of(frame));
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    weights[i + 1] = found[i];
    sum += found[i];
  }
  weights[0] = std::max(0.0, 1 - sum);
  return weights;
}

}  // namespace animeme::fap
