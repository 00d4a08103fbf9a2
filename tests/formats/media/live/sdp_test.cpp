#include "tools/formats/media/rtp/sdp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::media {
namespace sdp_test {

using test::Bytes;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Bytes kConfig = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47};

RtpSession some_session(const AudioFormat& format, const char* address = "192.0.2.7") {
  LiveInfo info{kConfig, 25000, 0x61, format};
  RtpOptions options;
  options.bundle = 4;
  options.ttl = 16;
  return RtpSender(info, options, address, 5004, 1, 0).session();
}

AudioFormat opus_format() {
  return {AudioCodec::opus,
          48000,
          2,
          960,
          312,
          {'O', 'p', 'u', 's', 'H', 'e', 'a', 'd', 1, 2, 56, 1, 0x80, 0xBB, 0, 0, 0, 0, 0}};
}

TEST(Sdp, ComesBackAsItWas) {
  for (const AudioFormat& format : {test::aac_format(), opus_format()}) {
    RtpSession session = some_session(format, "233.252.0.7");
    const auto read = read_sdp(write_sdp(session));
    ASSERT_TRUE(read) << read.error().describe();
    EXPECT_EQ(*read, session) << write_sdp(session);
    session.audio.reset();
    session.face->rtcp_port = 7001;
    EXPECT_EQ(*read_sdp(write_sdp(session)), session);
  }
}

TEST(Sdp, HasTheLinesOfTheStandards) {
  const std::string text = write_sdp(some_session(test::aac_format()));
  EXPECT_THAT(text, ::testing::StartsWith("v=0\r\no=- "));
  for (const char* line :
       {"m=video 5004 RTP/AVP 96\r\n", "c=IN IP4 192.0.2.7\r\n", "a=rtpmap:96 MP4V-ES/90000\r\n",
        "a=fmtp:96 profile-level-id=97; config=000001B061000001B58947\r\n",
        "a=rtcp-fb:96 nack pli\r\n", "a=rtcp-fb:96 ccm fir\r\n", "m=audio 5006 RTP/AVP 97\r\n",
        "a=rtpmap:97 mpeg4-generic/48000/1\r\n",
        "a=fmtp:97 streamType=5; profile-level-id=41; mode=AAC-hbr; sizelength=13; indexlength=3; "
        "indexdeltalength=3; config=1188\r\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
  // A time to live is for multicast alone (RFC 8866, 5.7).
  EXPECT_THAT(write_sdp(some_session(opus_format(), "233.252.0.7")),
              HasSubstr("c=IN IP4 233.252.0.7/16\r\n"));
  EXPECT_THAT(write_sdp(some_session(opus_format(), "ff15::7")), HasSubstr("c=IN IP6 ff15::7\r\n"));
  EXPECT_THAT(write_sdp(some_session(opus_format())),
              HasSubstr("a=rtpmap:97 opus/48000/2\r\na=fmtp:97 sprop-stereo=1\r\n"));
}

TEST(Sdp, NamesCannotBringLinesAlong) {
  RtpSession session = some_session(test::aac_format());
  session.name = "a\r\nm=video 1 RTP/AVP 96";
  session.cname = "b\nc=IN IP4 203.0.113.1";
  const auto read = read_sdp(write_sdp(session));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->face->port, 5004);
  EXPECT_EQ(read->face->address, "192.0.2.7");
}

TEST(Sdp, ReadsThatOfFfmpeg) {
  const std::string text =
      "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=No Name\nt=0 0\na=tool:libavformat 59.27.100\n"
      "m=video 25004 RTP/AVP 96\nc=IN IP4 127.0.0.1\na=rtpmap:96 MP4V-ES/90000\n"
      "a=fmtp:96 profile-level-id=1; config=000001B062000001B58947\n"
      "m=audio 25006 RTP/AVP 97\nc=IN IP4 127.0.0.1\nb=AS:6\na=rtpmap:97 MPEG4-GENERIC/48000/1\n"
      "a=fmtp:97 profile-level-id=1;mode=AAC-hbr;sizelength=13;indexlength=3;indexdeltalength=3; "
      "config=118856E500\n";
  const auto session = read_sdp(text);
  ASSERT_TRUE(session) << session.error().describe();
  ASSERT_TRUE(session->face);
  EXPECT_EQ(session->face->port, 25004);
  EXPECT_EQ(session->face->rtcp_port, 25005);
  EXPECT_EQ(session->face->visual_profile, 0x62);
  EXPECT_EQ(session->face->timescale, 0u);
  ASSERT_TRUE(session->audio);
  EXPECT_EQ(session->audio->format.sample_rate, 48000);
  EXPECT_EQ(session->audio->format.channels, 1);
  EXPECT_EQ(session->audio->format.frame_samples, 1024);
  EXPECT_EQ(session->audio->format.config, (Bytes{0x11, 0x88, 0x56, 0xE5, 0x00}));
}

TEST(Sdp, ReadsTheExampleOfTheReferenceData) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "reference data is not there";
  const auto session =
      read_sdp(test::slurp(test::shared_dir() / "examples" / "containers" / "fba_rtp.sdp"));
  ASSERT_TRUE(session) << session.error().describe();
  EXPECT_EQ(session->face->config, kConfig);
  EXPECT_EQ(session->face->visual_profile, 97);
  EXPECT_TRUE(session->audio);
}

// As GStreamer and VLC write: session address, several formats, keys in other cases, no blanks.
TEST(Sdp, ReadsOtherStyles) {
  const std::string text =
      "v=0\r\no=- 1188340656180883 1 IN IP4 127.0.0.1\r\ns=Session streamed with GStreamer\r\n"
      "i=rtsp-server\r\nt=0 0\r\na=tool:GStreamer\r\na=type:broadcast\r\na=control:*\r\n"
      "a=range:npt=now-\r\nc=IN IP6 ff15::1234\r\na=charset:UTF-8\r\n"
      "m=application 9 TCP/WSA 50\r\n"
      "m=video 5000/2 RTP/AVP 96 33\r\nb=RR:0\r\na=rtpmap:33 MP2T/90000\r\n"
      "a=rtpmap:96 mp4v-es/90000\r\na=fmtp:96 PROFILE-LEVEL-ID=98;CONFIG=000001b523 ;foo\r\n"
      "a=rtcp:5011 IN IP4 192.0.2.1\r\n"
      "m=audio 5002 RTP/AVP 111\r\nc=IN IP4 239.255.1.1/8\r\na=rtpmap:111 OPUS/48000/2\r\n"
      "a=fmtp:111 maxplaybackrate=16000; sprop-stereo=1\r\n"
      "m=audio 5008 RTP/AVP 0\r\n";
  const auto session = read_sdp(text);
  ASSERT_TRUE(session) << session.error().describe();
  EXPECT_EQ(session->face->address, "ff15::1234");
  EXPECT_EQ(session->face->rtcp_port, 5011);
  EXPECT_EQ(session->face->config, (Bytes{0, 0, 1, 0xB5, 0x23}));
  EXPECT_EQ(session->face->visual_profile, 98);
  EXPECT_EQ(session->audio->address, "239.255.1.1");
  EXPECT_EQ(session->audio->ttl, 8);
  EXPECT_EQ(session->audio->format.codec, AudioCodec::opus);
  EXPECT_EQ(session->audio->format.channels, 2);
  EXPECT_EQ(session->audio->format.config.size(), 19u);
  EXPECT_THAT(session->ignored, SizeIs(2));
}

TEST(Sdp, AFilmIsNoFace) {
  const std::string text =
      "v=0\nm=video 5000 RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n"
      "a=fmtp:96 profile-level-id=1;config=000001b001000001b50900000100\n";
  const auto session = read_sdp(text);
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().code, Code::unsupported);
  EXPECT_THAT(session.error().message, HasSubstr("film"));
}

TEST(Sdp, OtherSoundsAreNamedAndLeftOut) {
  const std::string face = "v=0\nm=video 5000 RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n";
  for (const char* sound :
       {"a=rtpmap:97 MP4A-LATM/48000\n", "a=rtpmap:97 mpeg4-generic/48000\n",
        "a=rtpmap:97 mpeg4-generic/48000\na=fmtp:97 mode=AAC-hbr;sizelength=13;config=\n",
        "a=rtpmap:97 mpeg4-generic/48000\na=fmtp:97 mode=AAC-hbr;sizelength=99;config=1188\n",
        "a=rtpmap:97 mpeg4-generic/48000\n"
        "a=fmtp:97 mode=AAC-hbr;sizelength=13;ctsdeltalength=3;config=1188\n",
        "a=rtpmap:97 opus/16000\n"}) {
    const auto session = read_sdp(face + "m=audio 5002 RTP/AVP 97\n" + sound);
    ASSERT_TRUE(session) << sound;
    EXPECT_FALSE(session->audio) << sound;
    EXPECT_THAT(session->ignored, SizeIs(1));
  }
}

TEST(Sdp, WhatIsNoDescriptionIsRefusedWithItsLine) {
  EXPECT_EQ(read_sdp("").error().code, Code::syntax);
  EXPECT_EQ(read_sdp("hello").error().code, Code::syntax);
  EXPECT_EQ(read_sdp("v=0\n").error().code, Code::syntax);
  EXPECT_EQ(read_sdp(std::string(70000, 'a')).error().code, Code::syntax);
  const auto port = read_sdp("v=0\ns=x\nm=video 70000 RTP/AVP 96\n");
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().where.line, 3);
  EXPECT_FALSE(read_sdp("v=0\nm=video x RTP/AVP 96\n"));
  EXPECT_FALSE(read_sdp("v=0\nm=video 1 RTP/AVP 96\na=rtpmap:96 MP4V-ES/0\n"));
  EXPECT_FALSE(read_sdp("v=0\nm=video 1 RTP/AVP 96\na=rtcp:99999\n"));
}

TEST(Sdp, DamagedTextIsReadOrRefusedAndNothingElse) {
  const std::string good = write_sdp(some_session(opus_format()));
  test::Random random(3);
  int readable = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = good.substr(0, std::size_t(random.range(0, int(good.size()))));
    for (int i = random.range(0, 4); i > 0 && !text.empty(); --i) {
      text[std::size_t(random.range(0, int(text.size()) - 1))] = char(random.range(0, 255));
    }
    const auto session = read_sdp(text);
    if (!session) continue;
    ++readable;
    const auto again = read_sdp(write_sdp(*session));
    ASSERT_TRUE(again) << write_sdp(*session);
    EXPECT_EQ(again->face.has_value(), session->face.has_value());
  }
  EXPECT_GT(readable, 100);
}

}  // namespace sdp_test
}  // namespace animeme::media
