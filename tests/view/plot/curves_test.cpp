// Curves as SVG, and rows of FAPs.
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

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
  EXPECT_TRUE(plot::is_drawing("a.pdf"));
  EXPECT_FALSE(plot::is_drawing("a.gif"));
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

// The number behind `key` in the first element that has `what`.
double number_of(const std::string& svg, const std::string& what, const std::string& key) {
  const std::size_t at = svg.find(key + "=\"", svg.rfind('<', svg.find(what)));
  return at == std::string::npos ? -1 : std::stod(svg.substr(at + key.size() + 2));
}

plot::Row row_named(const std::string& name, double low, double high) {
  return {"FAP 3", name, "1/1024 MNS", {{{0, low}, {0.5, high}, {4, low}}}};
}

TEST(PlotLayout, PrintHasTheWidthOfAColumn) {
  plot::Layout layout;
  layout.width = 85 * 96 / 25.4;
  layout.shown_width = "85mm";
  layout.title = "Jaw & lips";
  const std::string svg = plot::curves_svg(
      {panel_of({row_named("open_jaw", -38, 195), row_named("stretch_l_cornerlip_o", 0, 7)}, 4)},
      {"measured.fap", "made.fap"}, layout);
  EXPECT_THAT(svg, HasSubstr("width=\"85mm\""));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 321.3 "));
  EXPECT_THAT(svg, HasSubstr(">Jaw &amp; lips<"));
  EXPECT_THAT(svg, HasSubstr(">stretch_l_cornerlip_o (1/1024 MNS)<"));
  EXPECT_THAT(svg, Not(HasSubstr("font-size=\"12\" font-weight=\"bold\">FAP")));
  // Letters are 8 points high: 10.67 of 96 pixels an inch.
  EXPECT_THAT(svg, HasSubstr("font-size=\"10.67\""));
}

// Ticks of values are a letter's height apart, those of time a number's width.
TEST(PlotLayout, LabelsKeepApart) {
  for (const double millimetres : {40.0, 85.0, 178.0}) {
    for (const double seconds : {0.7, 4.0, 45.0, 599.0}) {
      plot::Layout layout;
      layout.width = millimetres * 96 / 25.4;
      const std::string svg = plot::curves_svg(
          {panel_of({row_named("open_jaw", -380, 1950), row_named("raise_b_midlip", -3, 4)},
                    seconds)},
          {}, layout);
      std::map<std::string, std::vector<double>> ticks;  // ends of words by their line or column
      for (std::size_t at = svg.find("<text"); at != std::string::npos;
           at = svg.find("<text", at + 1)) {
        const std::string tag = svg.substr(at, svg.find("</text>", at) - at);
        const std::string text = tag.substr(tag.find('>') + 1);
        const double x = number_of(tag, "<text", " x"), y = number_of(tag, "<text", " y");
        if (tag.find("\"end\"") != std::string::npos && x < 60)
          ticks["values"].push_back(y);
        else if (tag.find("\"middle\"") != std::string::npos && text.find('s') == text.npos)
          ticks["times"].push_back(x);
      }
      std::sort(ticks["values"].begin(), ticks["values"].end());
      EXPECT_GE(ticks["values"].size(), 4u);
      for (std::size_t i = 1; i < ticks["values"].size(); ++i)
        EXPECT_GE(ticks["values"][i] - ticks["values"][i - 1], 8) << millimetres;
      for (std::size_t i = 1; i < ticks["times"].size(); ++i)
        EXPECT_GE(ticks["times"][i] - ticks["times"][i - 1], 30) << millimetres << " " << seconds;
    }
  }
}

TEST(PlotLayout, SizeIsKept) {
  plot::Layout layout;
  layout.width = 640;
  layout.height = 300;
  const std::vector<plot::Panel> panels = {
      panel_of({row_named("a", 0, 1), row_named("b", 0, 1)}, 4)};
  const std::string svg = plot::curves_svg(panels, {"x"}, layout);
  EXPECT_THAT(svg, HasSubstr("width=\"640.0\" height=\"300.0\""));
  const double least = plot::least_height(panels, {"x"}, layout);
  layout.height = least;
  EXPECT_NEAR(number_of(plot::curves_svg(panels, {"x"}, layout), "<svg", "height"), least, 0.06);
}

// Rows as low as they may be, of values on both sides of 0: a scale that has no room for three
// ticks grew without an end.
TEST(PlotLayout, LowRowsHaveScalesOfTheirValues) {
  plot::Layout layout;
  layout.width = 640;
  layout.own_scales = true;
  const std::vector<plot::Panel> panels = {
      panel_of({row_named("a", -120, 310), row_named("b", -0.7, 2.4), row_named("c", 0, 90)}, 4)};
  layout.height = plot::least_height(panels, {"x"}, layout);
  const std::string svg = plot::curves_svg(panels, {"x"}, layout);
  EXPECT_THAT(svg, HasSubstr(">500<"));
  EXPECT_THAT(svg, HasSubstr(">-500<"));
  EXPECT_THAT(svg, Not(HasSubstr("00000")));
}

TEST(PlotLayout, ARowMayHaveAScaleOfItsOwn) {
  plot::Layout layout;
  layout.own_scales = true;
  const std::string svg =
      plot::curves_svg({panel_of({row_named("a", 0, 900), row_named("b", 0, 4)}, 4)}, {}, layout);
  EXPECT_EQ(count(svg, ">800<"), 1u);
  EXPECT_EQ(count(svg, ">3<"), 1u);
  // Long names have room beside the ticks.
  const std::string named =
      plot::curves_svg({panel_of({row_named("stretch_l_cornerlip_o", 0, 900)}, 4)}, {});
  EXPECT_GT(number_of(named, ">800<", "x") - 4 * 11 * 0.64, 8 + 11 * 0.55 * 21);
}

TEST(PlotClips, SpectraShowTheFrequencyOfAMotion) {
  plot::TimedClip clip{{{25, 1}, {}, "clip"}, 0};
  for (int i = 0; i < 250; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, int(std::lround(100 * std::sin(2 * 3.14159265 * 3 * i / 25.0))));
    frame.set(5, 7);
    clip.clip.frames.push_back(frame);
  }
  const plot::Row row = plot::spectrum_row(3, {clip}, 12.5);
  ASSERT_EQ(row.curves.size(), 1u);
  const auto peak = std::max_element(row.curves[0].begin(), row.curves[0].end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  EXPECT_NEAR(peak->first, 3, 0.01);
  // The power of the sine is 5000; its density is what it has a hertz.
  double power = 0;
  for (const auto& [hertz, level] : row.curves[0]) power += std::pow(10, level / 10) * 0.25;
  EXPECT_NEAR(power, 5000, 150);
  const plot::Row still = plot::spectrum_row(5, {clip}, 12.5);
  for (const auto& [hertz, level] : still.curves[0]) EXPECT_EQ(level, -20) << hertz;
  clip.clip.frames.resize(2);
  EXPECT_THAT(plot::spectrum_row(3, {clip}, 12.5).curves[0], IsEmpty());
}

TEST(PlotPdf, HasTheLinesAndTextsOfTheDrawing) {
  plot::Layout layout;
  layout.width = 85 * 96 / 25.4;
  layout.shown_width = "85mm";
  const std::string svg = plot::curves_svg({panel_of({row_named("open_jaw", 0, 195)}, 4)},
                                           {"a (b) \xC3\xA9 \xE2\x82\xAC"}, layout);
  const auto bytes = plot::drawing_bytes("a.pdf", svg);
  ASSERT_TRUE(bytes) << bytes.error().describe();
  const std::string pdf(bytes->begin(), bytes->end());
  EXPECT_THAT(pdf, StartsWith("%PDF-1.4\n"));
  EXPECT_THAT(pdf, EndsWith("%%EOF\n"));
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 240.94 "));  // 85 mm in points
  EXPECT_THAT(pdf, HasSubstr("(open_jaw \\(1/1024 MNS\\)) Tj"));
  EXPECT_THAT(pdf, HasSubstr("(a \\(b\\) \xE9 ?) Tj"));
  EXPECT_EQ(count(pdf, " Tj"), count(svg, "<text"));
  EXPECT_EQ(count(pdf, " S\n"), count(svg, "<line") + count(svg, "<polyline"));
  // The table at the end has the place of each object.
  const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  ASSERT_EQ(pdf.substr(table, 5), "xref\n");
  for (int i = 1; i <= 6; ++i) {
    const std::size_t at = std::stoul(pdf.substr(table + 9 + 20 * std::size_t(i), 10));
    EXPECT_EQ(pdf.substr(at, 7), std::to_string(i) + " 0 obj") << i;
  }
  EXPECT_FALSE(plot::drawing_bytes("a.pdf", "no drawing"));
  EXPECT_FALSE(plot::drawing_bytes("a.pdf", "<svg width=\"3\" height=\"4\"></svg>"));
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
