// The page of the server over WebRTC in a real browser: face and sound, together and over a bad
// network. Timed values are printed; what is asked of them leaves room for a busy machine.
#include "tests/live/webrtc/browser.h"

namespace animeme::test {
namespace webrtc_page_test {

class WebRtcPage : public WebRtcBrowser {
 protected:
  /// Milliseconds that mouths open behind their tones, ascending.
  std::vector<double> distances() {
    const Json seen = browser_->evaluate(
        tones_and_mouths("context.createMediaStreamSource(audio.srcObject).connect(tap)", 8000));
    std::vector<double> found;
    if (!seen.contains("tones")) return found;
    for (const double mouth : seen["mouths"]) {
      double nearest = 1;
      for (const double tone : seen["tones"]) {
        if (std::abs(mouth - tone) < std::abs(nearest)) nearest = mouth - tone;
      }
      found.push_back(1000 * nearest);
    }
    std::sort(found.begin(), found.end());
    if (found.empty()) return found;
    std::printf("mouth behind tone: %.0f ms (%.0f .. %.0f), of %zu; %s\n", found[found.size() / 2],
                found.front(), found.back(), found.size(), seen["latency"].dump().c_str());
    return found;
  }
};

TEST_F(WebRtcPage, ShowsFaceAndSoundTogether) {
  serve();
  start();
  expect_webrtc();
  const double first = browser_->evaluate("rtc.first");
  std::printf("first picture after %.0f ms\n", first);
  EXPECT_LT(first, quiet_ ? 1000 : 6000);
  const auto late = distances();
  ASSERT_GE(late.size(), 6u);
  EXPECT_LT(std::abs(late[late.size() / 2]), quiet_ ? 40 : 120);
  std::printf("behind the newest plane by %.0f ms, sound held for %.0f ms\n",
              1000 * double(browser_->evaluate("animeme.session.latency()")),
              1000 * double(browser_->evaluate("animeme.session.held")));
  EXPECT_THAT(browser_->complaints(), ::testing::IsEmpty());
}

TEST_F(WebRtcPage, SurvivesLossAndJitter) {
  serve();
  start(0.05, 0.03);
  expect_webrtc();
  std::printf("first picture after %.0f ms: %s\n", double(browser_->evaluate("rtc.first")),
              browser_
                  ->evaluate("rtc.log.map(([what, at]) => `${what} ${Math.round(at - "
                             "rtc.clicked)}`).join(', ')")
                  .dump()
                  .c_str());
  const auto late = distances();
  ASSERT_GE(late.size(), 6u);
  EXPECT_LT(std::abs(late[late.size() / 2]), quiet_ ? 40 : 120);
  const Json sound = browser_->evaluate(
      "(async () => [...(await rtc.peer.getStats()).values()].find(one => one.type === "
      "'inbound-rtp'))()");
  std::printf("relay: %d passed, %d lost; sound: %d packets, %d lost, %.1f %% concealed\n",
              relay_->passed(), relay_->lost(), int(sound["packetsReceived"]),
              int(sound["packetsLost"]),
              100.0 * double(sound["concealedSamples"]) / double(sound["totalSamplesReceived"]));
  EXPECT_GT(relay_->lost(), 20);
  EXPECT_GT(int(sound["packetsReceived"]), 300);
  EXPECT_GT(int(sound["packetsLost"]), 0) << "nobody sends them again";
}

TEST_F(WebRtcPage, HttpHasItToo) {
  run(web::make_web_sink("http://127.0.0.1:0", {.make_peer_connections = [] {
                           return webrtc::make_peer_connections();
                         }}));
  start();
  expect_webrtc();
}

TEST_F(WebRtcPage, EndsWithThePresentation) {
  serve();
  start();
  expect_webrtc();
  server_->stop();
  EXPECT_TRUE(wait_for(*browser_, "animeme.state === 'ended'"))
      << browser_->evaluate("animeme.state");
}

TEST_F(WebRtcPage, TakesWebSocketsWhereUdpDoesNotPass) {
  serve();
  start(1);
  ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live' && animeme.shown > 20"));
  EXPECT_NE(browser_->evaluate("animeme.session.connected"), true);
  const double first = browser_->evaluate("rtc.first");
  std::printf("first picture by WebSockets after %.0f ms\n", first);
  EXPECT_GT(first, 2000);
}

TEST_F(WebRtcPage, TakesWebSocketsIfAsked) {
  serve();
  start(-1, 0, "?transport=ws");
  ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live' && animeme.shown > 20"));
  EXPECT_EQ(browser_->evaluate("animeme.session.peer"), Json());
  EXPECT_EQ(browser_->evaluate("rtc.peer"), Json());
}

TEST_F(WebRtcPage, StopsAndStartsAgain) {
  serve();
  start();
  expect_webrtc();
  browser_->evaluate("document.getElementById('start').click()");
  EXPECT_EQ(browser_->evaluate("animeme.state"), "idle");
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (web_->stats().receivers > 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(web_->stats().receivers, 0) << "the page says that it goes";
  browser_->evaluate("animeme.shown = 0; document.getElementById('start').click()");
  expect_webrtc();
}

// A browser that is switched off says nothing.
TEST_F(WebRtcPage, WhoIsHeardOfNoMoreIsDropped) {
  serve();
  start(0, 0);
  expect_webrtc();
  relay_->cut();
  const auto begin = std::chrono::steady_clock::now(), end = begin + std::chrono::seconds(60);
  while (web_->stats().receivers > 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::printf("dropped after %.1f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  EXPECT_EQ(web_->stats().receivers, 0);
  // The page notices, too, and comes back.
  browser_->evaluate("rtc.first = rtc.peer; rtc.relayed = false");
  EXPECT_TRUE(wait_for(*browser_,
                       "animeme.session.connected && rtc.peer !== rtc.first && animeme.state === "
                       "'live'",
                       60));
}

}  // namespace webrtc_page_test
}  // namespace animeme::test
