// Publishing by WHIP: a server of the tests hands the offer to a browser, whose answer it gives
// back.
#include <future>
#include <mutex>

#include "tests/live/webrtc/browser.h"
#include "tests/live/webrtc/whip_server.h"

namespace animeme::test {
namespace whip_page_test {

/// Answers an offer and counts what comes.
constexpr const char* kAnswer = R"((async (sdp) => {
    const peer = window.peer = new RTCPeerConnection();
    window.got = {messages: 0, ended: false};
    peer.ondatachannel = (event) => {
      got.label = event.channel.label;
      got.ordered = event.channel.ordered;
      got.again = event.channel.maxRetransmits;
      event.channel.binaryType = 'arraybuffer';
      event.channel.onmessage = (message) => {
        const kind = new Uint8Array(message.data)[0];
        if (kind === 0x42) ++got.messages;
        if (kind === 0x45) got.ended = true;
      };
    };
    peer.ontrack = (event) => { got.kind = event.track.kind; };
    await peer.setRemoteDescription({type: 'offer', sdp});
    await peer.setLocalDescription();
    return peer.localDescription.sdp;
  }))";

class WhipPage : public WebRtcBrowser {};

TEST_F(WhipPage, PublishesToAServer) {
  WhipServer server("secret");
  auto sink = webrtc::make_whip_sink("whip://secret@127.0.0.1:" + std::to_string(server.port()) +
                                     "/whip/ada");
  ASSERT_TRUE(sink);
  browser_->open("about:blank", 800, 600, true);
  auto starting =
      std::async(std::launch::async, [&] { return std::make_unique<Broadcast>(std::move(*sink)); });
  const std::string offer = server.offer();
  ASSERT_NE(offer, "");
  const Json answer = browser_->evaluate(std::string(kAnswer) + "(" + Json(offer).dump() + ")");
  ASSERT_TRUE(answer.is_string()) << Json(browser_->complaints()).dump() << offer;
  server.answer(answer);
  const auto running = starting.get();
  ASSERT_TRUE(running->started()) << running->started().error().message;
  ASSERT_TRUE(wait_for(*browser_, "got.messages > 50"));
  EXPECT_EQ(browser_->evaluate("got.label"), "animeme.face");
  EXPECT_EQ(browser_->evaluate("got.ordered"), false);
  EXPECT_EQ(browser_->evaluate("got.again"), 0);
  EXPECT_EQ(browser_->evaluate("got.kind"), "audio");
  EXPECT_GT(int(browser_->evaluate("(async () => [...(await peer.getStats()).values()].find(one => "
                                   "one.type === 'inbound-rtp').packetsReceived)()")),
            50);
  EXPECT_EQ(running->sink().stats().receivers, 1);
  running->stop();
  EXPECT_TRUE(wait_for(*browser_, "got.ended", 5));
  EXPECT_EQ(server.deleted(), "/whip/ada/1");
}

// Without a browser.
TEST(Whip, WhatAServerRefusesIsSaid) {
  if (const auto there = webrtc::load(); !there) GTEST_SKIP() << there.error().message;
  WhipServer server("secret");
  const std::string at = "127.0.0.1:" + std::to_string(server.port()) + "/whip/ada";
  const media::LiveInfo info{.face_config = {0, 0, 1, 0xB0, 0x61}};
  for (const std::string& address : {"whip://" + at, "whip://wrong@" + at}) {
    auto sink = webrtc::make_whip_sink(address);
    ASSERT_TRUE(sink);
    const auto started = (*sink)->start(info);
    ASSERT_FALSE(started);
    EXPECT_EQ(started.error().code, Code::io);
    EXPECT_THAT(started.error().message, ::testing::HasSubstr("refuses with 401"));
  }
  auto nobody = webrtc::make_whip_sink("whip://127.0.0.1:1/whip");
  ASSERT_TRUE(nobody);
  const auto started = (*nobody)->start(info);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, Code::io);
  EXPECT_THAT(started.error().message, ::testing::HasSubstr("does not answer"));
}

}  // namespace whip_page_test
}  // namespace animeme::test
