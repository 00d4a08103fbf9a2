// Coded pictures, decoded again by FFmpeg.
#include "tools/formats/media/video.h"

#include <gtest/gtest.h>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <array>
#include <cstring>
#include <memory>
#include <string>

namespace animeme::media {
namespace video_test {

constexpr int kWidth = 96;
constexpr int kHeight = 64;

// Four plain fields; the upper left one gets lighter with each picture.
std::vector<std::uint8_t> picture(int number) {
  std::vector<std::uint8_t> rgba(std::size_t(kWidth) * kHeight * 4);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      std::uint8_t* pixel = &rgba[std::size_t(y * kWidth + x) * 4];
      const bool right = x >= kWidth / 2;
      const bool low = y >= kHeight / 2;
      pixel[0] = right ? 255 : low ? 0 : std::uint8_t(40 + 4 * number);
      pixel[1] = right && !low ? 0 : low && !right ? 255 : std::uint8_t(40 + 4 * number);
      pixel[2] = right ? 0 : low ? 0 : std::uint8_t(40 + 4 * number);
      pixel[3] = 255;
    }
  }
  return rgba;
}

Result<EncodedVideo> encode(VideoCodec codec, int count, int quality = 12) {
  Result<VideoEncoder> encoder = VideoEncoder::open(
      {.codec = codec, .width = kWidth, .height = kHeight, .rate = {10, 1}, .quality = quality});
  if (!encoder) return encoder.error();
  for (int i = 0; i < count; ++i) {
    if (auto pushed = encoder->push(picture(i)); !pushed) return pushed.error();
  }
  return encoder->finish();
}

struct FreeCodec {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};

// Luma and chroma in the middle of each field, picture by picture: field * 3 + component.
std::vector<std::array<int, 12>> decode(const EncodedVideo& video) {
  constexpr std::array kIds = {AV_CODEC_ID_H264, AV_CODEC_ID_VP9, AV_CODEC_ID_MPEG4};
  const AVCodec* codec = avcodec_find_decoder(kIds[std::size_t(video.codec)]);
  const std::unique_ptr<AVCodecContext, FreeCodec> context(avcodec_alloc_context3(codec));
  if (!video.config.empty()) {
    context->extradata =
        static_cast<std::uint8_t*>(av_mallocz(video.config.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    std::memcpy(context->extradata, video.config.data(), video.config.size());
    context->extradata_size = int(video.config.size());
  }
  context->thread_count = 1;
  EXPECT_GE(avcodec_open2(context.get(), codec, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  std::vector<std::array<int, 12>> pictures;
  const auto drain = [&] {
    while (avcodec_receive_frame(context.get(), frame) >= 0) {
      EXPECT_EQ(frame->width, kWidth);
      EXPECT_EQ(frame->height, kHeight);
      std::array<int, 12> seen = {};
      for (int field = 0; field < 4; ++field) {
        const int x = field % 2 == 0 ? kWidth / 4 : 3 * kWidth / 4;
        const int y = field / 2 == 0 ? kHeight / 4 : 3 * kHeight / 4;
        for (int c = 0; c < 3; ++c) {
          const int half = c == 0 ? 1 : 2;
          seen[std::size_t(field * 3 + c)] =
              frame->data[c][y / half * frame->linesize[c] + x / half];
        }
      }
      pictures.push_back(seen);
    }
  };
  for (const VideoPacket& coded : video.packets) {
    EXPECT_GE(av_new_packet(packet, int(coded.bytes.size())), 0);
    std::memcpy(packet->data, coded.bytes.data(), coded.bytes.size());
    EXPECT_GE(avcodec_send_packet(context.get(), packet), 0);
    av_packet_unref(packet);
    drain();
  }
  avcodec_send_packet(context.get(), nullptr);
  drain();
  av_packet_free(&packet);
  av_frame_free(&frame);
  return pictures;
}

class Video : public testing::TestWithParam<VideoCodec> {};

TEST_P(Video, PicturesComeBackInOrderAndColour) {
  const Result<EncodedVideo> video = encode(GetParam(), 25);
  if (!video && video.error().code == Code::unsupported) GTEST_SKIP() << video.error().message;
  ASSERT_TRUE(video) << video.error().message;
  ASSERT_EQ(video->packets.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(video->packets[i].time, std::int64_t(i));
    EXPECT_TRUE(video->packets[i].key || i % 10 != 0) << i;
  }
  const auto seen = decode(*video);
  ASSERT_EQ(seen.size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) {
    const int grey = 40 + 4 * int(i);
    EXPECT_NEAR(seen[i][0], 16 + grey * 219 / 255, 3) << i;  // limited range
    EXPECT_NEAR(seen[i][1], 128, 3);
    EXPECT_NEAR(seen[i][2], 128, 3);
    // BT.709: pure red and pure green.
    EXPECT_NEAR(seen[i][3], 63, 4) << i;
    EXPECT_NEAR(seen[i][4], 102, 4) << i;
    EXPECT_NEAR(seen[i][5], 240, 4) << i;
    EXPECT_NEAR(seen[i][6], 173, 4) << i;
    EXPECT_NEAR(seen[i][7], 42, 4) << i;
    EXPECT_NEAR(seen[i][8], 26, 4) << i;
  }
}

TEST_P(Video, SamePicturesGiveTheSameBytesAndQualityCostsThem) {
  const Result<EncodedVideo> once = encode(GetParam(), 12);
  if (!once && once.error().code == Code::unsupported) GTEST_SKIP() << once.error().message;
  const Result<EncodedVideo> again = encode(GetParam(), 12);
  const Result<EncodedVideo> small = encode(GetParam(), 12, 45);
  ASSERT_TRUE(once && again && small);
  EXPECT_EQ(once->packets, again->packets);
  EXPECT_EQ(once->config, again->config);
  const auto size = [](const EncodedVideo& video) {
    std::size_t bytes = 0;
    for (const VideoPacket& packet : video.packets) bytes += packet.bytes.size();
    return bytes;
  };
  EXPECT_LT(size(*small), size(*once));
}

INSTANTIATE_TEST_SUITE_P(Codecs, Video,
                         testing::Values(VideoCodec::h264, VideoCodec::vp9, VideoCodec::mpeg4),
                         [](const auto& suite) { return std::string(name_of(suite.param)); });

TEST(VideoErrors, SettingsOutOfBoundsAreNamed) {
  for (const VideoSettings& bad : {VideoSettings{.width = 15}, VideoSettings{.height = 101},
                                   VideoSettings{.rate = {0, 1}}, VideoSettings{.rate = {5000, 1}},
                                   VideoSettings{.quality = 52}, VideoSettings{.threads = 0}}) {
    const Result<VideoEncoder> encoder = VideoEncoder::open(bad);
    ASSERT_FALSE(encoder);
    EXPECT_EQ(encoder.error().code, Code::invalid_argument);
  }
}

TEST(VideoErrors, PicturesOfAnotherSizeAndNoPictures) {
  Result<VideoEncoder> encoder =
      VideoEncoder::open({.codec = VideoCodec::mpeg4, .width = 32, .height = 32});
  ASSERT_TRUE(encoder);
  const std::vector<std::uint8_t> wrong(32 * 31 * 4);
  EXPECT_EQ(encoder->push(wrong).error().code, Code::invalid_argument);
  EXPECT_EQ(encoder->finish().error().code, Code::invalid_argument);
  EXPECT_EQ(encoder->finish().error().code, Code::invalid_argument);
}

TEST(VideoCodecFor, ExtensionsThatHoldVideo) {
  EXPECT_TRUE(video_codec_for(".mp4"));
  const Result<VideoCodec> webm = video_codec_for(".webm");
  EXPECT_TRUE(!webm || *webm == VideoCodec::vp9);
  const Result<VideoCodec> mov = video_codec_for(".mov");
  EXPECT_TRUE(!mov || *mov == VideoCodec::prores);
  EXPECT_EQ(video_codec_for(".ts").error().code, Code::unsupported);
}

}  // namespace video_test
}  // namespace animeme::media
