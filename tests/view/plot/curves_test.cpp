// Curves as SVG, and rows of FAPs.
#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <cmath>

#include "tools/view/plot/clips.h"
#include "tools/view/plot/curves.h"

namespace animeme {
namespace plot_test {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

plot::Panel panel_of(std::vector<plot::Row> rows, double seconds) {
  plot::Panel panel;
  panel.seconds = seconds;
  panel.rows = std::move(rows);
  return panel;
}

plot::TimedClip clip_of(std::initializer_list<int> jaw, double start = 0) {
  plot::TimedClip timed{{{25, 1}, {}, "clip"}, start};
  for (const int value : jaw) {
    fap::Frame frame;
    frame.number = std::int64_t(timed.clip.frames.size());
    frame.set(3, value);
    timed.clip.frames.push_back(frame);
  }
  return timed;
}

TEST(PlotCurves, EveryCurveIsALineInItsColour) {
  const std::string svg = plot::curves_svg(
      {panel_of({{"jaw & lip", "a < b", "mm", {{{0, 0}, {1, 5}}, {{0, 1}, {1, 2}}}}}, 1)},
      {"first", "second"});
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, EndsWith("</svg>\n"));
  EXPECT_EQ(count(svg, "<polyline"), 2u);
  // Each colour once in the curve and once in the legend; the second one is dashed in both.
  EXPECT_EQ(count(svg, "#0072b2"), 2u);
  EXPECT_EQ(count(svg, "#d55e00\" stroke-dasharray=\"7 3\""), 2u);
  EXPECT_THAT(svg, HasSubstr(">jaw &amp; lip<"));
  EXPECT_THAT(svg, HasSubstr(">a &lt; b<"));
  EXPECT_THAT(svg, HasSubstr(">second<"));
}

TEST(PlotCurves, APointLiesAtItsTimeAndValue) {
  // One second is at least 600 pixels wide; it begins at 150. The row is 110 high with 12 free at
  // either end and begins at 8: 0 is at 106, the largest value at 20.
  const std::string svg =
      plot::curves_svg({panel_of({{"a", "", "", {{{0, 0}, {0.5, 40}, {1, 20}}}}}, 1)}, {});
  EXPECT_THAT(svg, HasSubstr("points=\"150.0,106.0 450.0,20.0 750.0,63.0 \""));
  EXPECT_THAT(svg, HasSubstr(">40</text>"));
}

TEST(PlotCurves, WhatLiesOutsideIsNotDrawn) {
  plot::Panel panel = panel_of({{"a", "", "", {{{0, 1}, {1, 2}, {2, 900}}}}}, 1.5);
  panel.begin = 0.5;
  const std::string svg = plot::curves_svg({panel}, {});
  EXPECT_THAT(svg, HasSubstr("points=\"450.0,20.0 \""));  // 1 of the three, and no scale up to 900
  EXPECT_THAT(svg, Not(HasSubstr(">900<")));
}

TEST(PlotCurves, TicksAreRoundAndRowsOfAUnitShareThem) {
  const std::string svg = plot::curves_svg(
      {panel_of({{"a", "", "mm", {{{0, -38}, {1, 195}}}}, {"b", "", "mm", {{{0, 5}, {1, 10}}}}},
                1)},
      {});
  for (const char* tick : {">-50<", ">0<", ">50<", ">100<", ">200<"}) {
    EXPECT_EQ(count(svg, tick), 2u) << tick << " in both rows";
  }
  EXPECT_THAT(svg, Not(HasSubstr(">195<")));
  EXPECT_THAT(svg, HasSubstr(">Time (s)<"));
  const std::string degrees =
      plot::curves_svg({panel_of({{"yaw", "", "degrees", {{{0, 0.1}, {1, 1.3}}}}}, 1)}, {});
  for (const char* tick : {">0.0<", ">0.5<", ">1.0<", ">1.5<"}) {
    EXPECT_EQ(count(degrees, tick) >= 1, true) << tick;
  }
}

TEST(PlotCurves, WhatIsAbsentIsNotDrawn) {
  const double absent = std::nan("");
  const std::string svg = plot::curves_svg(
      {panel_of({{"a", "", "", {{{0, 1}, {0.2, absent}, {0.4, absent}, {0.6, 2}, {0.8, 1}}}}}, 1)},
      {});
  EXPECT_EQ(count(svg, "<polyline"), 2u) << "a line on either side of the gap";
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  fap::Sequence clip;
  clip.frames.resize(2);
  clip.frames[1].number = 1;
  clip.frames[0].set(3, 100);
  clip.frames[1].set(48, 100000);
  const plot::Row jaw = plot::fap_row(3, {{clip}}), head = plot::fap_row(48, {{clip}});
  EXPECT_EQ(jaw.curves[0][0].second, 100);
  EXPECT_TRUE(std::isnan(jaw.curves[0][1].second));
  EXPECT_NEAR(head.curves[0][1].second, 57.29578, 1e-4) << "a radian in degrees";
}

TEST(PlotCurves, PhonesAreBandsAndClosuresStandOut) {
  dam::Script script;
  script.phones = {{0, 0.4, "P"}, {0.4, 0.8, "AA"}, {0.8, 1, std::string(dam::kSilence)}};
  plot::Panel panel = panel_of({{"a", "", "", {{{0, 1}}}}}, 1);
  panel.script = &script;
  const std::string svg = plot::curves_svg({panel}, {});
  EXPECT_EQ(count(svg, "#ffd9b3"), 1u);
  EXPECT_EQ(count(svg, "#eef3fa"), 1u);
  EXPECT_THAT(svg, HasSubstr(">AA<"));
}

TEST(PlotCurves, TheNameOfAFileTellsItsKind) {
  EXPECT_TRUE(plot::is_drawing("a.svg"));
  EXPECT_TRUE(plot::is_drawing("b.PNG"));
  EXPECT_TRUE(plot::is_drawing("-"));
  EXPECT_FALSE(plot::is_drawing("a.pdf"));
  const std::string svg = plot::curves_svg({panel_of({}, 1)}, {});
  const auto same = plot::drawing_bytes("a.svg", svg);
  ASSERT_TRUE(same);
  EXPECT_EQ(std::string(same->begin(), same->end()), svg);
  const auto png = plot::drawing_bytes("a.png", svg);
  if (!png && png.error().code == Code::unsupported) GTEST_SKIP() << "no SVG renderer";
  ASSERT_TRUE(png) << png.error().describe();
  EXPECT_EQ(std::string(png->begin(), png->begin() + 4), "\x89PNG");
  const auto bad = plot::drawing_bytes("bad.png", "no drawing");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where.file, "bad.png");
}

TEST(PlotClips, RowsHaveACurveAClip) {
  const plot::Row row = plot::fap_row(3, {clip_of({1, 2}), clip_of({7}, 0.5)});
  EXPECT_EQ(row.title, "FAP 3");
  EXPECT_EQ(row.subtitle, "open_jaw");
  EXPECT_EQ(row.unit, "1/1024 MNS");
  ASSERT_EQ(row.curves.size(), 2u);
  EXPECT_THAT(row.curves[0], ElementsAre(Pair(0, 1), Pair(0.04, 2)));
  EXPECT_THAT(row.curves[1], ElementsAre(Pair(0.5, 7)));
  EXPECT_EQ(plot::fap_row(48, {}).unit, "degrees");
}

TEST(PlotClips, DifferencesAreSecondLessFirst) {
  const plot::Row row = plot::difference_row(3, clip_of({10, 20, 30}), clip_of({1, 5}, 0.04));
  EXPECT_EQ(row.first_colour, 2u);
  ASSERT_EQ(row.curves.size(), 1u);
  // b shows 1 before it begins and holds 5 behind its end.
  EXPECT_THAT(row.curves[0], ElementsAre(Pair(0, -9), Pair(0.04, -19), Pair(0.08, -25)));
  EXPECT_THAT(plot::difference_row(3, clip_of({1}), clip_of({})).curves[0], IsEmpty());
}

}  // namespace plot_test
}  // namespace animeme
