// Offers that no browser makes: each is answered or refused, the process lives, and nothing of them
// stays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <thread>

#include "tests/live/webrtc/test_broadcast.h"

namespace animeme::test {
namespace hostile_offer_test {

/// What Chromium offers, without what is of no account here.
constexpr std::string_view kOffer =
    "v=0\r\no=- 7254892659752563005 2 IN IP4 127.0.0.1\r\ns=-\r\nt=0 0\r\na=group:BUNDLE 0 1\r\n"
    "a=extmap-allow-mixed\r\na=msid-semantic: WMS\r\nm=audio 9 UDP/TLS/RTP/SAVPF 111 0\r\n"
    "c=IN IP4 0.0.0.0\r\na=rtcp:9 IN IP4 0.0.0.0\r\na=ice-ufrag:/LnA\r\n"
    "a=ice-pwd:gLE1gIt3oHRsp2uwDmtCKKug\r\na=ice-options:trickle\r\n"
    "a=fingerprint:sha-256 69:A1:11:43:92:62:E5:60:88:33:BE:F5:44:8A:E8:3E:F6:FC:BB:A4:E7:12:A1:47:"
    "82:C6:35:93:8E:D7:37:BB\r\na=setup:actpass\r\na=mid:0\r\n"
    "a=extmap:4 urn:ietf:params:rtp-hdrext:sdes:mid\r\na=recvonly\r\na=rtcp-mux\r\n"
    "a=rtpmap:111 opus/48000/2\r\na=rtcp-fb:111 transport-cc\r\n"
    "a=fmtp:111 minptime=10;useinbandfec=1\r\na=rtpmap:0 PCMU/8000\r\n"
    "m=application 9 UDP/DTLS/SCTP webrtc-datachannel\r\nc=IN IP4 0.0.0.0\r\na=ice-ufrag:/LnA\r\n"
    "a=ice-pwd:gLE1gIt3oHRsp2uwDmtCKKug\r\n"
    "a=fingerprint:sha-256 69:A1:11:43:92:62:E5:60:88:33:BE:F5:44:8A:E8:3E:F6:FC:BB:A4:E7:12:A1:47:"
    "82:C6:35:93:8E:D7:37:BB\r\na=setup:actpass\r\na=mid:1\r\na=sctp-port:5000\r\n"
    "a=max-message-size:262144\r\n";

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find("\r\n", at) + 2;
    lines.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

int threads() {
  const std::filesystem::directory_iterator all("/proc/self/task");
  return int(std::distance(begin(all), end(all)));
}

class HostileOffer : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto there = webrtc::load(); !there) GTEST_SKIP() << there.error().message;
    peer_connections_ = webrtc::make_peer_connections({}, true);
    media::AudioFormat opus;
    opus.codec = media::AudioCodec::opus;
    ASSERT_TRUE(
        peer_connections_->start({.face_config = {0, 0, 1, 0xB0, 0x61}, .audio = opus}, 1000, 0));
  }

  /// The status of the answer, 0: none came.
  unsigned offer(const std::string& sdp) {
    std::unique_lock lock(mutex_);
    answered_ = false;
    peer_connections_->offer(sdp, "x", [this](web::PeerAnswer answer) {
      const std::lock_guard inner(mutex_);
      answer_ = std::move(answer);
      answered_ = true;
      changed_.notify_all();
    });
    if (!changed_.wait_for(lock, std::chrono::seconds(20), [this] { return answered_; })) return 0;
    return answer_.status;
  }
  /// The same, and its connection is ended.
  void expect_an_answer(const std::string& sdp) {
    const unsigned status = offer(sdp);
    EXPECT_TRUE(status == 201 || status == 400) << status << " for\n" << sdp;
    ++(status == 201 ? taken_ : refused_);
    if (status != 201) return;
    EXPECT_THAT(answer_.text, ::testing::StartsWith("v=0"));
    for (int i = 0; i < 1000 && !peer_connections_->end(answer_.id); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::unique_ptr<web::PeerConnections> peer_connections_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool answered_ = false;
  web::PeerAnswer answer_;
  int taken_ = 0, refused_ = 0;
};

TEST_F(HostileOffer, IsAnsweredOrRefused) {
  expect_an_answer(std::string(kOffer));
  EXPECT_EQ(taken_, 1);
  const int before = threads();
  const auto lines = lines_of(kOffer);
  for (const std::string bad :
       {"", "garbage", "v=0\r\n", "v=0\r\nm=", "\r\n\r\n", "m=audio 9\r\n"}) {
    expect_an_answer(bad);
  }
  expect_an_answer(std::string(60000, 'a'));
  expect_an_answer(std::string(1000, '\0'));
  for (std::size_t i = 0; i < lines.size(); ++i) {  // without a line, with one twice, up to one
    std::string without, twice, cut;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (k != i) without += lines[k];
      twice += k == i ? lines[k] + lines[k] : lines[k];
      if (k < i) cut += lines[k];
    }
    for (const std::string& offer : {without, twice, cut}) expect_an_answer(offer);
  }
  for (std::size_t size = 7; size < kOffer.size(); size += 61) {
    expect_an_answer(std::string(kOffer.substr(0, size)));
  }
  std::printf("%d answered, %d refused\n", taken_, refused_);
  EXPECT_GT(taken_, 20);
  EXPECT_GT(refused_, 20);
  // The threads of connections go with them.
  for (int i = 0; i < 500 && threads() > before + 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_LE(threads(), before + 5);
}

}  // namespace hostile_offer_test
}  // namespace animeme::test
