// The fixture of tests with a browser: what is served, the page, and a bad network in between.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/live/webrtc/relay.h"
#include "tests/live/webrtc/test_broadcast.h"

namespace animeme::test {

/// Counts what comes, and lets the test put a relay between browser and server.
constexpr const char* kWatch = R"(
  window.rtc ??= {};
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

class WebRtcBrowser : public ::testing::Test {
 protected:
  using Json = nlohmann::json;

  void SetUp() override {
    if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
    if (const auto there = webrtc::load(); !there) GTEST_SKIP() << there.error().message;
    double load = 0;
    const double cores = std::max(1u, std::thread::hardware_concurrency());
    if (getloadavg(&load, 1) == 1 && load > 5 * cores && std::getenv("ANIMEME_BUSY") == nullptr) {
      GTEST_SKIP() << "this machine is too busy to play in real time: load " << load;
    }
    quiet_ = load < cores;
    browser_.emplace();
    ASSERT_TRUE(browser_->is_open()) << "Chromium does not start";
  }

  void serve() { run(webrtc::make_webrtc_sink("webrtc://127.0.0.1:0")); }
  void run(Result<std::unique_ptr<web::WebSink>> sink,
           std::optional<media::EncodedAudio> sound = std::nullopt) {
    if (!sound) sound = make_sound(8, media::AudioCodec::opus);
    run(std::move(sink), std::make_unique<media::ClipInput>(make_mouth(8), std::move(*sound),
                                                            media::ClipOptions{.loop = true}));
  }
  void run(Result<std::unique_ptr<web::WebSink>> sink, std::unique_ptr<media::LiveInput> input) {
    ASSERT_TRUE(sink);
    web_ = sink->get();
    server_.emplace(std::move(*sink), std::move(input));
    ASSERT_TRUE(server_->started()) << server_->started().error().message;
  }

  /// Opens the page and, if it waits for that, clicks. A relay with this loss stands in between if
  /// it is not negative.
  void start(double loss = -1, double jitter = 0, const std::string& query = "") {
    const bool relayed = loss >= 0;
    const std::string before =
        std::string("window.rtc = {clicked: performance.now(), relayed: ") +
        (relayed ? "true" : "false") +
        "}; (function look() { if (window.animeme?.shown) rtc.first = performance.now() - "
        "rtc.clicked; else setTimeout(look, 2); })();";
    browser_->call("Page.addScriptToEvaluateOnNewDocument", {{"source", before + kWatch}});
    browser_->open(web_->address() + query, 800, 600, true);
    // It may begin by itself.
    browser_->evaluate(
        "if (animeme.state === 'idle') { rtc.clicked = performance.now(); "
        "document.getElementById('start').click(); }");
    if (relayed) relay(loss, jitter);
  }
  /// Once the answer is there.
  void relay(double loss, double jitter, bool overtake = false) {
    ASSERT_TRUE(wait_for(*browser_, "rtc.relayTo"));
    relay_.emplace(int(browser_->evaluate("rtc.port")), loss, jitter, overtake);
    browser_->evaluate("rtc.relayTo(" + std::to_string(relay_->port()) + ")");
  }

  void expect_webrtc() {
    ASSERT_TRUE(wait_for(*browser_, "animeme.state === 'live' && animeme.shown > 20"))
        << browser_->evaluate(
               "JSON.stringify([animeme.state, animeme.shown, rtc.log, "
               "animeme.session.connected, animeme.session.frames.length])");
    EXPECT_EQ(browser_->evaluate("animeme.session.connected"), true);
    EXPECT_EQ(web_->stats().receivers, 1);
  }

  bool quiet_ = false;  // nobody else wants this machine: times are what they are said to be
  std::optional<Chromium> browser_;
  web::WebSink* web_ = nullptr;
  std::optional<Broadcast> server_;
  std::optional<Relay> relay_;
};

}  // namespace animeme::test
