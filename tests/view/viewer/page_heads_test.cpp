// Heads of the page in headless Chromium: the same vertices as in C++, a mouth that moves, another
// head; and what axe-core says of a page that has all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/view/viewer/page_support.h"

namespace animeme::test {
namespace page_heads_test {

std::vector<head::Vec3> read_vertices(const std::string& path) {
  const Bytes bytes = read_bytes(path);
  std::vector<head::Vec3> out(bytes.size() / sizeof(head::Vec3));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(head::Vec3));
  return out;
}

// The largest distance of the page's vertices from those of C++, cm.
double parity(const fap::Frame& frame, std::size_t number, const TempDir& dir,
              const head::Rig& rig = test_head().rig) {
  const head::Pose pose = head::pose(rig, frame);
  double largest = 0;
  for (std::size_t i = 0; i < head::kPartCount; ++i) {
    const auto& places = pose.positions[i].empty() ? rig.parts[i].positions : pose.positions[i];
    const auto shown = read_vertices(
        dir.file(std::string(head::kPartNames[i]) + "_" + std::to_string(number) + ".f32"));
    EXPECT_EQ(shown.size(), places.size()) << head::kPartNames[i];
    for (std::size_t v = 0; v < std::min(shown.size(), places.size()); ++v) {
      const head::Vec3 d = shown[v] - pose.transforms[i](places[v]);
      largest = std::max(largest, double(length(d)));
    }
  }
  return largest;
}

TEST(Page, MovesTheHeadAsTheRigDoes) {
  NEEDS_BROWSER();
  const TempDir dir;
  fap::Sequence clip = moving_clip();
  const std::size_t folded = 6;  // but for the share that is shown
  clip.frames[folded] = frame_of({{6, 1200}, {12, 1200}, {23, 9000}});
  clip.frames[folded].number = folded;
  const Json report = report_of("looks", make({{clip, 0, "clip"}}), dir);
  ASSERT_TRUE(report.contains("state"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  EXPECT_EQ(report["state"]["head"], true);
  EXPECT_GT(report["mouth"], 8.0);
  EXPECT_LT(report["forehead"], 0.05);
  EXPECT_EQ(report["specks"], Json::array());
  for (std::size_t i = 0; i < 8; ++i) {
    const double apart = parity(clip.frames[i], i, dir);
    EXPECT_LT(apart, 0.02) << "frame " << i;
    RecordProperty("parity_" + std::to_string(i), std::to_string(apart));
  }
}

TEST(Page, MovesAHeadWithoutSeamsAsTheRigDoes) {
  NEEDS_BROWSER();
  const TempDir dir;
  fap::Sequence clip = moving_clip();
  const std::size_t shut = 3;
  clip.frames[shut] = frame_of({{4, 10}, {5, -30}, {8, -20}, {10, 5}, {9, 0}, {11, -45}, {12, 80}});
  clip.frames[shut].number = shut;
  const TestHead& foreign = foreign_head();
  viewer::Page page{&test_head().head, &test_head().rig, {{clip, 0, "clip"}}};
  page.head_name = "woman";
  page.others.push_back({&foreign.head, &foreign.rig, "</script>me"});
  const auto html = viewer::make_page(page);
  ASSERT_TRUE(html) << html.error().describe();
  const Json report = report_of("other", *html, dir);
  ASSERT_TRUE(report.contains("state"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  EXPECT_EQ(report["list"], Json::parse(R"(["woman", "</script>me"])"));
  EXPECT_EQ(report["state"]["whose"], "</script>me");
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_LT(parity(clip.frames[i], i, dir, foreign.rig), 0.02) << "frame " << i;
  }
}

// People side by side: each head moves by its own clip, and nothing is wrong with the page.
TEST(Page, PeopleHaveHeadsOfTheirOwn) {
  NEEDS_BROWSER();
  NEEDS_NPM("axe-core");
  const TempDir dir;
  fap::Sequence still = moving_clip();
  for (fap::Frame& frame : still.frames) frame = frame_of({{49, 100}});
  for (std::size_t i = 0; i < still.frames.size(); ++i) still.frames[i].number = std::int64_t(i);
  viewer::Page page;
  page.title = "talk.mp4";
  page.people.push_back({&test_head().head, &test_head().rig, -20, {moving_clip(), 0, "Ann"}});
  page.people.push_back({&foreign_head().head, &foreign_head().rig, 20, {still, 0, "Bob"}});
  page.scripts = {{{{0, 1, "SIL", ""}, {1, 1.5, "AA", "hello"}}},
                  {{{0, 2, "SIL", ""}, {2, 2.5, "AA", "yes"}}}};
  page.script.phones = {{0, 1, "SIL", ""}, {1, 1.5, "AA", "hello"}, {2, 2.5, "AA", "yes"}};
  const auto html = viewer::make_page(page);
  ASSERT_TRUE(html) << html.error().describe();
  const Json report = report_of("people", *html, dir);
  ASSERT_TRUE(report.contains("names"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  EXPECT_EQ(report["names"], Json::parse(R"(["Ann", "Bob"])"));
  EXPECT_EQ(report["title"], "talk.mp4");
  // Between a frame at rest and one with an open mouth only the first one moves.
  EXPECT_GT(report["moved"][0].get<double>(), 0.3);
  EXPECT_EQ(report["moved"][1].get<double>(), 0);
  // Chins are in the middles of the halves, and noses point to the other one.
  EXPECT_LT(report["chin"][0].get<double>(), 0.5);
  EXPECT_GT(report["chin"][1].get<double>(), 0.5);
  EXPECT_GT(report["nose"][0].get<double>(), report["chin"][0].get<double>() + 0.01);
  EXPECT_LT(report["nose"][1].get<double>(), report["chin"][1].get<double>() - 0.01);
  EXPECT_EQ(report["said"], Json::parse(R"(["hello", "yes"])"));
  const Json axe = report_of("axe", *html, dir);
  EXPECT_EQ(axe["violations"], Json::array());
  page.people[1].rig = nullptr;
  EXPECT_EQ(viewer::make_page(page).error().code, Code::invalid_argument);
}

// With two clips, two heads and a script, so that all of it is there.
TEST(Page, AxeFindsNoViolations) {
  NEEDS_BROWSER();
  NEEDS_NPM("axe-core");
  const TempDir dir;
  fap::Sequence other = moving_clip();
  other.frames[2].set(48, 100);
  const TestHead& h = test_head();
  viewer::Page page{&h.head, &h.rig, {{moving_clip(), 0, "a.fap"}, {other, 0, "b.fap"}}};
  page.script.phones.push_back({0, 0.5, "AH", "word"});
  page.head_name = "woman";
  page.others.push_back({&foreign_head().head, &foreign_head().rig, "me"});
  const auto html = viewer::make_page(page);
  ASSERT_TRUE(html) << html.error().describe();
  const Json report = report_of("axe", *html, dir);
  ASSERT_TRUE(report.contains("checked"));
  EXPECT_EQ(report["violations"], Json::array());
  EXPECT_THAT(report["checked"], testing::SizeIs(6));
  for (const Json& checked : report["checked"]) EXPECT_GT(checked, 20);
}

}  // namespace page_heads_test
}  // namespace animeme::test
