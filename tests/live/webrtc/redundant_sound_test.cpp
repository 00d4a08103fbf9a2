// Sound that goes again: what descriptions say of it, its bytes, and how often it does.
#include "tools/live/webrtc/detail/redundant_sound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace animeme::webrtc {
namespace redundant_sound_test {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

// As Chromium 120 offers it, shortened.
const std::string kOffer =
    "v=0\r\no=- 1 2 IN IP4 127.0.0.1\r\ns=-\r\nt=0 0\r\na=group:BUNDLE 0 1\r\n"
    "m=audio 9 UDP/TLS/RTP/SAVPF 111 63 9 0\r\na=mid:0\r\na=rtpmap:111 opus/48000/2\r\n"
    "a=rtcp-fb:111 transport-cc\r\na=fmtp:111 minptime=10;useinbandfec=1\r\n"
    "a=rtpmap:63 red/48000/2\r\na=fmtp:63 111/111\r\na=rtpmap:9 G722/8000\r\n"
    "m=application 9 UDP/DTLS/SCTP webrtc-datachannel\r\na=mid:1\r\n";
const std::string kAnswer =
    "v=0\r\nm=audio 9 UDP/TLS/RTP/SAVPF 111\r\na=mid:0\r\na=rtpmap:111 OPUS/48000/2\r\n"
    "a=sendonly\r\nm=application 9 UDP/DTLS/SCTP webrtc-datachannel\r\na=mid:1\r\n";

TEST(RedundantSound, IsReadFromDescriptions) {
  const SoundTypes types = sound_types(kOffer);
  EXPECT_EQ(types.opus, 111);
  EXPECT_EQ(types.redundant, 63);
  EXPECT_EQ(sound_types(kAnswer).opus, 111);
  EXPECT_EQ(sound_types(kAnswer).redundant, -1);
  EXPECT_TRUE(types.fec);
  EXPECT_FALSE(sound_types(kAnswer).fec);
  for (const auto& [parameters, fec] :
       std::map<std::string, bool>{{"useinbandfec=1", true},
                                   {"minptime=10; useinbandfec=1;stereo=0", true},
                                   {"minptime=10;useinbandfec=0", false},
                                   {"x-useinbandfec=1", false},
                                   {"useinbandfec=10", false}}) {
    const std::string sdp =
        "m=audio 9 X 96\na=rtpmap:96 opus/48000/2\na=fmtp:97 useinbandfec=1\na=fmtp:96 ";
    EXPECT_EQ(sound_types(sdp + parameters + "\n").fec, fec) << parameters;
  }
  // With something else in it, without Opus, of video, and no description at all.
  std::string other = kOffer;
  other.replace(other.find("111/111"), 7, "0/0");
  EXPECT_EQ(sound_types(other).redundant, -1);
  for (const std::string& text :
       {std::string(), std::string("m=audio"), std::string("a=rtpmap:63 red/48000/2"),
        std::string("m=audio 9 X 63\na=rtpmap:63 red/48000/2\na=fmtp:63 111/111\n"),
        std::string("m=video 9 X 63\na=rtpmap:111 opus/48000/2\na=rtpmap:63 red/48000/2\n"),
        std::string("m=audio 9 X\na=rtpmap:\na=rtpmap:999 opus/48000\na=rtpmap:x red/48000\n")}) {
    EXPECT_EQ(sound_types(text).redundant, -1) << text;
    EXPECT_EQ(with_redundant(text, types), text);
  }
}

TEST(RedundantSound, IsAddedToAnswersAndTakenOutAgain) {
  const SoundTypes types = sound_types(kOffer);
  const std::string with = with_redundant(kAnswer, types);
  EXPECT_THAT(with, HasSubstr("m=audio 9 UDP/TLS/RTP/SAVPF 111 63\r\n"));
  EXPECT_THAT(with, HasSubstr("a=rtpmap:63 red/48000/2\r\na=fmtp:63 111/111\r\na=sendonly"));
  EXPECT_EQ(sound_types(with).redundant, 63);
  EXPECT_EQ(with_redundant(with, types), with);
  EXPECT_EQ(without_redundant(with, types), kAnswer);
  EXPECT_EQ(with_redundant(kAnswer, {}), kAnswer);
  EXPECT_EQ(without_redundant(kAnswer, {}), kAnswer);
  EXPECT_EQ(with_redundant(kAnswer, {110, 63}), kAnswer);
}

struct Heard {
  std::map<std::uint32_t, Bytes> packets;  // by their times
};

// A receiver of RFC 2198, section 3.
void read(const Bytes& payload, std::uint32_t time, int type, Heard& heard) {
  std::size_t at = 0;
  struct Block {
    std::uint32_t time;
    std::size_t size;
  };
  std::vector<Block> blocks;
  while (payload.at(at) & 0x80) {
    ASSERT_EQ(payload[at] & 0x7F, type);
    const std::uint32_t bits = std::uint32_t(payload.at(at + 1)) << 16 |
                               std::uint32_t(payload.at(at + 2)) << 8 | payload.at(at + 3);
    blocks.push_back({time - (bits >> 10), bits & 0x3FF});
    at += 4;
  }
  ASSERT_EQ(payload.at(at++), type);
  for (const Block& block : blocks) {
    ASSERT_LE(at + block.size, payload.size());
    heard.packets[block.time] = {payload.begin() + std::ptrdiff_t(at),
                                 payload.begin() + std::ptrdiff_t(at + block.size)};
    at += block.size;
  }
  heard.packets[time] = {payload.begin() + std::ptrdiff_t(at), payload.end()};
}

Bytes packet_of(int number, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = std::uint8_t(std::size_t(number) * 31 + i);
  return bytes;
}

TEST(RedundantSound, LostPacketsAreFoundInThoseAfterThem) {
  RedundantSound sound;
  Heard heard;
  std::map<std::uint32_t, Bytes> sent;
  std::uint32_t time = 0xFFFFFF00;  // times begin anew
  for (int i = 0; i < 200; ++i, time += 960) {
    const Bytes packet = packet_of(i, std::size_t(40 + i));
    sound.push(packet, time);
    sent[time] = packet;
    const int place = i % 10;
    if (place == 4 || place == 7 || place == 8) continue;  // lost
    read(sound.payload(2, 111), time, 111, heard);
  }
  EXPECT_EQ(heard.packets, sent);
}

TEST(RedundantSound, IsAsLargeAsADatagramAndNoOlderThanItsHeaderSays) {
  RedundantSound sound;
  sound.push(packet_of(1, 500), 0);
  EXPECT_EQ(sound.payload(3, 96).size(), 501u);
  sound.push(packet_of(2, 500), 960);
  EXPECT_EQ(sound.payload(3, 96).size(), 1005u);
  sound.push(packet_of(3, 500), 1920);
  EXPECT_EQ(sound.payload(3, 96).size(), 1005u) << "a third does not fit";
  EXPECT_EQ(sound.payload(0, 96).size(), 501u);
  sound.push(packet_of(4, 10), 1920 + 16384);
  EXPECT_EQ(sound.payload(3, 96).size(), 11u) << "14 bits of time";
  sound.push(packet_of(5, 1024), 30000);
  sound.push(packet_of(6, 10), 30960);
  EXPECT_EQ(sound.payload(3, 96).size(), 11u) << "10 bits of length";
  EXPECT_TRUE(RedundantSound().payload(3, 96).empty());
}

TEST(LossGauge, FollowsReportsAndWaitsBeforeItSendsLess) {
  LossGauge gauge;
  EXPECT_EQ(gauge.repeats(0), 0);
  EXPECT_EQ(gauge.repeats(0.01), 1);
  EXPECT_EQ(gauge.repeats(0.05), 2);
  for (int i = 0; i < 1500; ++i) EXPECT_EQ(gauge.repeats(0), 2);
  EXPECT_EQ(gauge.repeats(0), 0);
}

}  // namespace redundant_sound_test
}  // namespace animeme::webrtc
