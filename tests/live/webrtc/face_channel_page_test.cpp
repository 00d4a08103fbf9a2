// The data channel of access units, as a page of somebody else would use it, over a network that
// loses 5 %: read by JavaScript of the tests alone, and compared with what was sent.
#include <algorithm>
#include <climits>
#include <string>

#include "tests/live/webrtc/browser.h"

namespace animeme::test {
namespace face_channel_page_test {

/// Joins by WHEP and keeps every unit by its number. `options`: of the channel.
constexpr const char* kJoin = R"(((options) => {
    rtc.relayed = true;
    const peer = new RTCPeerConnection(), units = rtc.units = {};
    rtc.messages = 0;
    peer.addTransceiver('audio', {direction: 'recvonly'});
    const channel = peer.createDataChannel('animeme.face', options);
    channel.binaryType = 'arraybuffer';
    channel.onmessage = (event) => {
      const view = new DataView(event.data);
      if (view.getUint8(0) === 0x45) rtc.ended = true;
      if (view.getUint8(0) !== 0x42) return;
      ++rtc.messages;
      let at = 9;
      const hello = view.getUint16(7);
      if (hello) rtc.hello = new Uint8Array(event.data, at, hello).join(' ');
      at += hello;
      for (let i = 0; i < view.getUint8(6); ++i) {
        const size = view.getUint16(at);
        units[view.getUint32(2) + i] ??= {
          time: Number(view.getBigUint64(at + 2)), late: i + 1 < view.getUint8(6),
          intra: (view.getUint8(at + 14) & 1) === 1,
          bytes: [...new Uint8Array(event.data, at + 15, size - 13)]};
        at += 2 + size;
      }
    };
    rtc.joined = (async () => {
      await peer.setLocalDescription();
      const answer = await fetch('whep', {method: 'POST', body: peer.localDescription.sdp,
                                          headers: {'Content-Type': 'application/sdp'}});
      await peer.setRemoteDescription({type: 'answer', sdp: await answer.text()});
    })();
  }))";
constexpr const char* kLossy = "({ordered: false, maxRetransmits: 0})";

class FaceChannelPage : public WebRtcBrowser {
 protected:
  void join(const char* options) {
    browser_->call("Page.addScriptToEvaluateOnNewDocument", {{"source", kWatch}});
    browser_->open(web_->address() + "?transport=ws", 800, 600, true);
    browser_->evaluate(std::string(kJoin) + options);
  }
};

/// What browsers open by themselves loses nothing: one unit a message, and no more intra planes
/// than that which it begins with and those where the source changes its ranges.
TEST_F(FaceChannelPage, ReliableChannelsHaveAnEncoderOfTheirOwn) {
  serve();
  join("({})");
  relay(0, 0, true);
  ASSERT_TRUE(wait_for(*browser_, "Object.keys(rtc.units).length > 120", 60));
  server_->stop();
  const Json units = browser_->evaluate("rtc.units");
  EXPECT_EQ(int(browser_->evaluate("rtc.messages")), int(units.size()));
  EXPECT_EQ(browser_->evaluate("rtc.hello.startsWith('65 1 97 1 ')"), true);
  int least = INT_MAX, most = 0, intra_planes = 0;
  for (const auto& [key, unit] : units.items()) {
    least = std::min(least, std::stoi(key));
    most = std::max(most, std::stoi(key));
    intra_planes += int(bool(unit["intra"]));
  }
  EXPECT_EQ(most - least + 1, int(units.size())) << "nothing is missing";
  EXPECT_EQ(units[std::to_string(least)]["intra"], true);
  EXPECT_LE(intra_planes, 3);
}

TEST_F(FaceChannelPage, LosesNothingAtFivePercent) {
  serve();
  join(kLossy);
  relay(0.05, 0.03, true);
  ASSERT_TRUE(wait_for(*browser_, "Object.keys(rtc.units).length > 250", 60));
  server_->stop();
  EXPECT_TRUE(wait_for(*browser_, "rtc.ended", 5));
  EXPECT_EQ(browser_->evaluate("rtc.hello.startsWith('65 1 97 1 ')"), true);
  const Json units = browser_->evaluate("rtc.units");
  const auto sent = server_->sent();
  int number = -1, late = 0;
  for (const auto& [key, unit] : std::map<int, Json>([&] {
         std::map<int, Json> sorted;
         for (const auto& [name, value] : units.items()) sorted[std::stoi(name)] = value;
         return sorted;
       }())) {
    if (number < 0 && unit["intra"] != true) continue;  // a decoder cannot begin
    EXPECT_TRUE(number < 0 || key == number + 1) << key << " follows " << number;
    number = key;
    late += int(bool(unit["late"]));
    const auto own = sent.find(std::int64_t(unit["time"]) - 25000);
    ASSERT_NE(own, sent.end());
    EXPECT_EQ(unit["bytes"].get<std::vector<std::uint8_t>>(), own->second.bytes);
    EXPECT_EQ(unit["intra"], own->second.intra);
  }
  std::printf("%zu units in %d messages; relay lost %d of %d; %d units came with a later message\n",
              units.size(), int(browser_->evaluate("rtc.messages")), relay_->lost(),
              relay_->lost() + relay_->passed(), late);
  EXPECT_GT(number, 230);
  EXPECT_LT(int(browser_->evaluate("rtc.messages")), int(units.size()));
  EXPECT_GT(late, 0) << "what was lost came by repetition";
}

}  // namespace face_channel_page_test
}  // namespace animeme::test
