// After a stall the page is as near to the sender as before, in a few seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/live/web/test_server.h"

namespace animeme::test {
namespace stall_test {

constexpr double kTarget = 0.35;  // page/live.js
constexpr double kNear = 0.3;     // beyond that: a segment, a look of the steering, a busy machine

class PageStall : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
    if (const std::string why = too_busy(); !why.empty()) GTEST_SKIP() << why;
    browser_.emplace(std::vector<std::string>{"--autoplay-policy=no-user-gesture-required"});
    ASSERT_TRUE(browser_->is_open());
    start();
    browser_->open(server_->address(), 500, 500, false);
    EXPECT_LT(settle("at first"), 20);
  }
  void start(const std::string& url = "http://127.0.0.1:0/") {
    const bool sound = GetParam();
    server_.emplace(sound ? std::optional(media::AudioCodec::aac) : std::nullopt, web::WebOptions{},
                    url);
  }
  /// Seconds until it is near for a second and a half; 99: it is not in a minute.
  double settle(const char* what) {
    const auto seen = browser_->evaluate(R"(new Promise(done => {
      const begin = performance.now();
      let near = begin, most = 0;
      (function look() {
        const now = performance.now(), behind = animeme.session.latency();
        most = Math.max(most, behind || 0);
        const good = animeme.state === 'live' && behind > 0 && behind < )" +
                                             std::to_string(kTarget + kNear) + R"( &&
            Math.abs(animeme.time - animeme.session.clock()) < 0.2;
        if (!good) near = now;
        if (now - near > 1500) done({seconds: (near - begin) / 1000, behind, most});
        else if (now - begin > 60000) done({seconds: 99, behind, most});
        else setTimeout(look, 30);
      })();
    }))",
                                         false);
    if (!seen.contains("seconds")) return 99;
    std::printf("%s: %.2f s behind at most, after %.1f s %.2f s\n", what, double(seen["most"]),
                double(seen["seconds"]), double(seen["behind"]));
    return seen["seconds"];
  }
  static void seconds(double count) { usleep(useconds_t(count * 1e6)); }

  std::optional<TestServer> server_;
  std::optional<Chromium> browser_;
};

TEST_P(PageStall, OfTheBrowser) {
  browser_->freeze(true);
  seconds(4);
  browser_->freeze(false);
  EXPECT_LT(settle("browser stopped for 4 s"), 10);
}

TEST_P(PageStall, OfTheSender) {
  server_->hold(true);
  seconds(4);
  server_->hold(false);
  EXPECT_LT(settle("sender stopped for 4 s"), 10);
  for (int i = 0; i < 3; ++i) {
    server_->hold(true);
    seconds(0.9);
    server_->hold(false);
    seconds(0.9);
  }
  EXPECT_LT(settle("sender stopped for 0.9 s, three times"), 30);
}

TEST_P(PageStall, WithALoss) {
  server_->pause(true);
  seconds(3);
  server_->pause(false);
  EXPECT_LT(settle("nothing for 3 s"), 10);
}

TEST_P(PageStall, OfAServerThatBeginsAgain) {
  const std::string address = server_->address();
  server_.reset();
  seconds(1);
  start(address);
  ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live'", 60, false));
  EXPECT_LT(settle("server started again"), 10);
}

INSTANTIATE_TEST_SUITE_P(Sound, PageStall, ::testing::Bool(),
                         [](const auto& each) { return each.param ? "sound" : "silent"; });

}  // namespace stall_test
}  // namespace animeme::test
