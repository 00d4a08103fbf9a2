// Addresses of WebRTC, and what their options may be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/live/webrtc/webrtc.h"

namespace animeme::test {
namespace webrtc_address_test {

using ::testing::HasSubstr;

TEST(WebRtcAddress, TellsWhatAddressesAre) {
  EXPECT_TRUE(webrtc::is_webrtc("webrtc://127.0.0.1:8080"));
  EXPECT_FALSE(webrtc::is_webrtc("http://127.0.0.1:8080"));
  EXPECT_TRUE(webrtc::is_whip("whip://host/a"));
  EXPECT_TRUE(webrtc::is_whip("whips://host/a"));
  EXPECT_EQ(webrtc::page_of("webrtc://0.0.0.0:80?stun=a:1"), "http://0.0.0.0:80");
  EXPECT_EQ(webrtc::page_of("http://a:1/"), "http://a:1/");
}

TEST(WebRtcAddress, OptionsThatDoNotFitAreNamed) {
  for (const std::string good : {"", "?repeat=0", "?repeat=30", "?stun=a:1&turn=u:p@b:2&repeat=3",
                                 "?audio-repeat=0", "?repeat=1&audio-repeat=3"}) {
    EXPECT_TRUE(webrtc::make_webrtc_sink("webrtc://127.0.0.1:0" + good)) << good;
    EXPECT_TRUE(webrtc::make_whip_sink("whip://127.0.0.1:1/path" + good)) << good;
  }
  for (const std::string bad :
       {"?repeat=31", "?repeat=-1", "?repeat=x", "?repeat=1x", "?audio-repeat=4",
        "?audio-repeat=", "?audio-repeat=auto", "?stun=", "?turn=host", "?", "?a=b"}) {
    for (const auto& error : {webrtc::make_webrtc_sink("webrtc://127.0.0.1:0" + bad).error(),
                              webrtc::make_whip_sink("whip://127.0.0.1:1/path" + bad).error()}) {
      EXPECT_EQ(error.code, Code::invalid_argument);
      EXPECT_THAT(error.message, HasSubstr("repeat=0..30")) << bad;
    }
  }
  for (const std::string bad : {"whip://", "whip:///path", "whip://token@/path"}) {
    EXPECT_EQ(webrtc::make_whip_sink(bad).error().code, Code::invalid_argument) << bad;
  }
}

TEST(WebRtcAddress, ServersThatHelp) {
  webrtc::WebRtcOptions options;
  EXPECT_TRUE(webrtc::add_ice_server("stun:stun.example.org:3478", options));
  EXPECT_TRUE(webrtc::add_ice_server("turn:me:p@ss:word@[2001:db8::1]:3478", options));
  EXPECT_EQ(options.stun, "stun.example.org:3478");
  EXPECT_EQ(options.turn, "me:p@ss:word@[2001:db8::1]:3478");
  EXPECT_FALSE(webrtc::add_ice_server("stun:other.example.org:3478", options));
  for (const char* wrong :
       {"", "stun:", "stun:host", "stun:host:", "stun::1", "stun:host:0", "stun:host:65536",
        "stun:host:1x", "turn:host:1", "turn:user@host:1", "turn::p@host:1", "stun:a/b:1",
        "turns:u:p@host:1", "host:1", "stun:a b:1"}) {
    webrtc::WebRtcOptions none;
    EXPECT_FALSE(webrtc::add_ice_server(wrong, none)) << wrong;
  }
}

}  // namespace webrtc_address_test
}  // namespace animeme::test
