// The page in a real browser: sound, face and both together. Pictures of it lie in
// <build>/screenshots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <thread>

#include "fap/head/model.h"
#include "fap/head/rig.h"
#include "tests/live/web/test_server.h"
#include "tests/support/folders.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::test {
namespace page_test {

using Json = nlohmann::json;

constexpr const char* kSample =
    "({time: audio.currentTime, wall: performance.now() / 1000, shown: animeme.shown, "
    "offset: animeme.offset, face: animeme.time, latency: animeme.session.latency(), "
    "gaps: animeme.session.gaps, state: animeme.state})";

class Page : public ::testing::TestWithParam<media::AudioCodec> {
 protected:
  void SetUp() override {
    if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
    if (const std::string why = too_busy(); !why.empty()) GTEST_SKIP() << why;
    browser_.emplace();
    ASSERT_TRUE(browser_->is_open()) << "Chromium does not start";
  }
  void start(const TestServer& server, int width, int height, bool dark) {
    browser_->open(server.address(), width, height, dark);
    ASSERT_TRUE(wait_for(*browser_, "animeme.blocked", 60, false)) << "no sound without a click";
    EXPECT_EQ(browser_->evaluate("audio.muted", false), true);
    browser_->evaluate("document.getElementById('sound').click()");
    EXPECT_EQ(browser_->evaluate("audio.muted"), false);
    ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live' && animeme.shown > 20"));
  }
  void expect_no_complaints() { EXPECT_THAT(browser_->complaints(), ::testing::IsEmpty()); }
  std::optional<Chromium> browser_;
};

TEST_P(Page, PlaysSoundAndFaceTogether) {
  TestServer server(GetParam());
  start(server, 1100, 800, false);
  const Json a = browser_->evaluate(kSample);
  ASSERT_TRUE(wait_for(*browser_, "animeme.shown > " + std::to_string(int(a["shown"]) + 50)));
  const Json b = browser_->evaluate(kSample);
  const double wall = double(b["wall"]) - double(a["wall"]);
  const double played = double(b["time"]) - double(a["time"]);
  RecordProperty("played_per_second", std::to_string(played / wall));
  EXPECT_GT(played, 0);
  EXPECT_EQ(b["gaps"], 0);
  // A busy machine may stutter for a while, but it has to come back.
  EXPECT_TRUE(wait_for(*browser_,
                       "animeme.state === 'live' && animeme.offset >= 0 && animeme.offset < 0.1 && "
                       "Math.abs(animeme.time - audio.currentTime) < 0.1 && "
                       "animeme.session.latency() < 2.5"));
  expect_no_complaints();
  const std::string name = std::string("web_desktop_") + media::name_of(GetParam()) + ".png";
  browser_->save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots" / name);
}

// The sound that comes out of the element, sample by sample, against the mouth that is shown.
TEST_P(Page, TheMouthOpensWithTheTone) {
  TestServer server(GetParam());
  start(server, 800, 600, true);
  const Json seen = browser_->evaluate(tones_and_mouths(
      "context.createMediaElementSource(audio).connect(tap).connect(context.destination)", 5000));
  ASSERT_TRUE(seen.contains("tones"));
  std::vector<double> distances;
  for (const double mouth : seen["mouths"]) {
    double nearest = 1;
    for (const double tone : seen["tones"]) {
      if (std::abs(mouth - tone) < std::abs(nearest)) nearest = mouth - tone;
    }
    distances.push_back(nearest);
  }
  ASSERT_GE(distances.size(), 4u);
  std::sort(distances.begin(), distances.end());
  const double middle = distances[distances.size() / 2];
  std::printf("mouth behind tone: %.0f ms (%.0f .. %.0f)\n", 1000 * middle,
              1000 * distances.front(), 1000 * distances.back());
  EXPECT_LT(std::abs(middle), 0.12);
  expect_no_complaints();
}

INSTANTIATE_TEST_SUITE_P(Codecs, Page,
                         ::testing::Values(media::AudioCodec::aac, media::AudioCodec::opus),
                         [](const auto& each) { return media::name_of(each.param); });

using PageOnce = Page;

TEST_P(PageOnce, FitsAPhoneAndSurvivesAPause) {
  TestServer server(GetParam());
  start(server, 360, 740, true);
  EXPECT_EQ(browser_->evaluate("document.documentElement.scrollWidth <= innerWidth"), true)
      << "nothing sticks out";
  EXPECT_EQ(browser_->evaluate("[...document.querySelectorAll('canvas')].every(c => "
                               "c.getAttribute('aria-label'))"),
            true);
  browser_->save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots" /
                         "web_phone.png");
  server.pause(true);
  ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'waiting'"));
  server.pause(false);
  ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live'"));
  const Json a = browser_->evaluate(kSample);
  ASSERT_TRUE(wait_for(*browser_, "animeme.shown > " + std::to_string(int(a["shown"]) + 20)));
  expect_no_complaints();
  browser_->evaluate("document.getElementById('start').click()");
  EXPECT_EQ(browser_->evaluate("animeme.state"), "idle");
}

TEST_P(PageOnce, ShowsAHead) {
  const auto head = head::make_head();
  ASSERT_TRUE(head);
  web::WebOptions options;
  options.head_script = viewer::head_script();
  options.head_model = viewer::pack_head(*head, head::make_rig(*head));
  TestServer server(GetParam(), options);
  start(server, 1100, 800, false);
  ASSERT_TRUE(wait_for(*browser_, "animeme.head")) << "WebGL2 in software";
  EXPECT_EQ(browser_->evaluate("document.getElementById('face')"), Json());
  // The mouth of the head moves: points of the lips come apart and together again.
  const Json moves = browser_->evaluate(R"(new Promise(done => {
    let low = 1e9, high = -1e9;
    const end = performance.now() + 4000, at = (id) => animeme.head.points().find(p => p.id === id);
    (function look() {
      const gap = at('2.3').y - at('2.2').y;
      low = Math.min(low, gap);
      high = Math.max(high, gap);
      if (performance.now() < end) requestAnimationFrame(look);
      else done(high - low);
    })();
  }))");
  ASSERT_TRUE(moves.is_number());
  EXPECT_GT(double(moves), 3) << "pixels";
  EXPECT_EQ(browser_->evaluate("animeme.session.gaps"), 0);
  wait_for(*browser_, "Face.opening(animeme.session.due(animeme.session.clock()).values) > 0.5");
  browser_->save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots" /
                         "web_head.png");
  expect_no_complaints();
}

INSTANTIATE_TEST_SUITE_P(Aac, PageOnce, ::testing::Values(media::AudioCodec::aac),
                         [](const auto& each) { return media::name_of(each.param); });

}  // namespace page_test
}  // namespace animeme::test
