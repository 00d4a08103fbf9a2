// The page of the server over WebRTC in a real browser: face and sound, together and over a bad
// network. Timed values are printed; what is asked of them leaves room for a busy machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/web/http.h"
#include "tests/webrtc/relay.h"
#include "tests/webrtc/station.h"

namespace animeme::test {
namespace webrtc_page_test {

using Json = nlohmann::json;

/// Counts what comes, and lets the test put a relay between browser and server.
constexpr const char* kWatch = R"(
  window.rtc = {};
  const real = RTCPeerConnection.prototype.setRemoteDescription;
  RTCPeerConnection.prototype.setRemoteDescription = async function(description) {
    rtc.peer = this;
    rtc.log = [['answer', performance.now()]];
    const note = () => rtc.log.push([`${this.iceConnectionState} ${this.connectionState}`, performance.now()]);
    this.addEventListener('iceconnectionstatechange', note);
    this.addEventListener('connectionstatechange', note);
    let sdp = description.sdp;
    if (rtc.relayed) {
      const line = sdp.match(/a=candidate:\S+ 1 UDP \d+ 127\.0\.0\.1 (\d+) typ host\r\n/);
      const port = await new Promise(done => { rtc.relayTo = done; rtc.port = Number(line[1]); });
      sdp = sdp.replace(/a=candidate:.*\r\n/g, '').replace(
          /a=mid:0\r\n/, all => all + line[0].replace(` ${line[1]} `, ` ${port} `));
    }
    return real.call(this, {type: description.type, sdp});
  };
)";

/// When tones and mouths began, as they come out of the browser.
constexpr const char* kListen = R"(new Promise(async done => {
    const context = new AudioContext();
    const tap = context.createAnalyser();
    tap.fftSize = 512;
    context.createMediaStreamSource(audio.srcObject).connect(tap);
    await context.resume();
    const wave = new Float32Array(512), tones = [], mouths = [];
    let loud = false, open = false, begin = performance.now();
    animeme.onFrame = (values) => {
      if ((values[3] > 300) !== open) {
        open = !open;
        if (open) mouths.push(performance.now() / 1000);
      }
    };
    const timer = setInterval(() => {
      tap.getFloatTimeDomainData(wave);
      const level = Math.sqrt(wave.reduce((sum, x) => sum + x * x, 0) / wave.length);
      if ((level > 0.1) !== loud) {
        loud = !loud;
        if (loud) tones.push(performance.now() / 1000);
      }
      if (performance.now() - begin > 8000) {
        clearInterval(timer);
        done({tones, mouths, latency: context.outputLatency, base: context.baseLatency});
      }
    }, 4);
  }))";

class WebRtcPage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
    if (const auto there = webrtc::load(); !there) GTEST_SKIP() << there.error().message;
    double load = 0;
    const double cores = std::max(1u, std::thread::hardware_concurrency());
    if (std::getenv("ANIMEME_BUSY") == nullptr && getloadavg(&load, 1) == 1 && load > 5 * cores) {
      GTEST_SKIP() << "this machine is too busy to play in real time: load " << load;
    }
    browser_.emplace();
    ASSERT_TRUE(browser_->is_open()) << "Chromium does not start";
  }

  void serve(const std::string& url = "webrtc://127.0.0.1:0", const web::WebOptions& options = {}) {
    auto sink = webrtc::make_webrtc_sink(url, options);
    ASSERT_TRUE(sink);
    web_ = sink->get();
    station_.emplace(std::move(*sink));
    ASSERT_TRUE(station_->started()) << station_->started().error().message;
  }

  /// Opens the page and clicks. A relay with this loss stands in between if it is not negative.
  void start(double loss = -1, double jitter = 0, const std::string& query = "") {
    browser_->call("Page.addScriptToEvaluateOnNewDocument", {{"source", kWatch}});
    browser_->open(web_->address() + query, 800, 600, true);
    const bool relayed = loss >= 0;
    browser_->evaluate(std::string("rtc.relayed = ") + (relayed ? "true" : "false") +
                       "; rtc.clicked = performance.now(); (function look() { if (animeme.shown) "
                       "rtc.first = performance.now() - rtc.clicked; else setTimeout(look, 2); "
                       "})(); document.getElementById('start').click()");
    if (!relayed) return;
    ASSERT_TRUE(wait_for(*browser_, "rtc.relayTo"));
    relay_.emplace(int(browser_->evaluate("rtc.port")), loss, jitter);
    browser_->evaluate("rtc.relayTo(" + std::to_string(relay_->port()) + ")");
  }

  void expect_webrtc() {
    ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live' && animeme.shown > 20"))
        << browser_->evaluate("(async () => JSON.stringify([...(await rtc.peer.getStats()).values()].filter(s => s.type === 'inbound-rtp')))()") << browser_->evaluate("JSON.stringify([animeme.state, animeme.shown, rtc.log, "
                              "animeme.session.frames.length, animeme.session.clock(), "
                              "document.getElementById('message').textContent, animeme.session.connected, audio.paused, audio.readyState, animeme.session.receiver.track.readyState, animeme.session.receiver.track.muted, animeme.session.receiver.getSynchronizationSources(), "
                              "animeme.session.channel && animeme.session.channel.readyState])");
    EXPECT_EQ(browser_->evaluate("animeme.session.peer instanceof RTCPeerConnection"), true);
    EXPECT_EQ(web_->stats().receivers, 1);
  }

  /// Milliseconds that mouths open behind their tones, ascending.
  std::vector<double> distances() {
    const Json seen = browser_->evaluate(kListen);
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

  std::optional<Chromium> browser_;
  web::WebSink* web_ = nullptr;
  std::optional<Station> station_;
  std::optional<Relay> relay_;
};

TEST_F(WebRtcPage, ShowsFaceAndSoundTogether) {
  serve();
  start();
  expect_webrtc();
  const double first = browser_->evaluate("rtc.first");
  std::printf("first picture after %.0f ms\n", first);
  EXPECT_LT(first, 3000); 
  std::printf("%s\n", browser_->evaluate("JSON.stringify([rtc.log.map(([a, t]) => [a, t - rtc.clicked]), performance.getEntriesByType('resource').map(r => [r.name, r.startTime - rtc.clicked, r.responseEnd - rtc.clicked])])").dump().c_str());
  if (getenv("SHORT")) return;
  const auto late = distances();
  ASSERT_GE(late.size(), 6u);
  EXPECT_LT(std::abs(late[late.size() / 2]), 40);
  EXPECT_THAT(browser_->complaints(), ::testing::IsEmpty());
}

TEST_F(WebRtcPage, SurvivesLossAndJitter) {
  serve();
  start(0.05, 0.03);
  expect_webrtc();
  std::printf("first picture after %.0f ms\n", double(browser_->evaluate("rtc.first")));
  const int before = browser_->evaluate("animeme.session.frames.length"), begin = browser_->evaluate("performance.now()");
  (void)before; (void)begin;
  const auto late = distances();
  ASSERT_GE(late.size(), 6u);
  EXPECT_LT(std::abs(late[late.size() / 2]), 40);
  const Json sound = browser_->evaluate(
      "(async () => { for (const one of (await rtc.peer.getStats()).values()) if (one.type === "
      "'inbound-rtp') return one; })()");
  std::printf("relay: %d passed, %d lost; sound: %d packets, %d lost, %.1f %% concealed\n",
              relay_->passed(), relay_->lost(), int(sound["packetsReceived"]),
              int(sound["packetsLost"]),
              100.0 * double(sound["concealedSamples"]) / double(sound["totalSamplesReceived"]));
  EXPECT_GT(relay_->lost(), 20);
  EXPECT_GT(int(sound["packetsReceived"]), 300);
}

}  // namespace webrtc_page_test
}  // namespace animeme::test
