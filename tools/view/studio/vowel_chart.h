/// @file
/// The vowels of the IPA chart as a model speaks them, on a head: a sheet to look at.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dam/model/model.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/view/studio/head_view.h"

namespace animeme::studio {

/// A vowel of the chart, spoken alone.
struct ChartVowel {
  std::string ipa;     ///< the letter; empty: the resting mouth
  std::string name;    ///< "close front rounded vowel"; "rest"
  std::string phones;  ///< what the model is given for it (dam/script/ipa.h): "UW"
  int row = 0;         ///< 0 (close) to 6 (open), as on the chart
  int column = 0;      ///< front, central, back: 0, 2, 4; the rounded ones: 1, 3, 5
  fap::Frame frame;    ///< in its middle, filled
  double gap = 0;      ///< between the inner lips, -(FAP 4 + FAP 5), FAP units
  double width = 0;    ///< of the mouth, FAP 6 + FAP 7, FAP units beyond neutral
  double forward = 0;  ///< of the lips, mean of FAP 16 and FAP 17, FAP units
};

inline constexpr int kChartRows = 7;     ///< values of ChartVowel::row
inline constexpr int kChartColumns = 6;  ///< values of ChartVowel::column

/// The resting mouth and the 28 vowels, row by row. Each is held for 0.3 s between pauses, with
/// Model::articulation. Errors: not_found (the controls of the model are neither FAPs nor ARKit
/// shapes), those of dam::synthesise().
Result<std::vector<ChartVowel>> chart_vowels(const dam::Model& model);

/// A picture of each at its place, with its letter, phones, gap and width.
/// `look`: head and camera; its width and height are pixels of one picture. SVG, for
/// plot::drawing_bytes(). Errors: those of HeadView::make() and render::png_of().
Result<std::string> vowel_chart_svg(const HeadLook& look, std::span<const ChartVowel> vowels,
                                    const tools::Log& log = {});

}  // namespace animeme::studio
