// Coded sound through containers without coding it again, and files that are ended early.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace mux_sound_test {

struct Copy {
  const char* name;
  AudioCodec codec;
};

class CopySound : public testing::TestWithParam<Copy> {};

TEST_P(CopySound, PacketsComeBackByteForByte) {
  const auto [name, codec] = GetParam();
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000 - 77, {24037, 96011});
  const Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
  ASSERT_TRUE(coded) << coded.error().describe();
  const bool alone =
      std::string(name) != "a.mp4" && std::string(name) != "a.mkv" && std::string(name) != "a.ts";
  const MuxInput input{.face = alone ? nullptr : &face, .encoded = &*coded};
  const Result<MuxResult> written = write_container(dir.file(name), input);
  ASSERT_TRUE(written) << written.error().describe();
  EXPECT_FALSE(written->stopped);
  const Result<EncodedAudio> back = read_encoded_audio(dir.file(name));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->format.codec, codec);
  // ADTS headers have no room for what libavcodec adds behind the first two bytes.
  const std::size_t told = std::string(name) == "a.ts" ? 2 : coded->format.config.size();
  EXPECT_EQ(back->format.config, test::Bytes(coded->format.config.begin(),
                                             coded->format.config.begin() + std::ptrdiff_t(told)));
  ASSERT_EQ(back->packets.size(), coded->packets.size());
  // Where the priming has no place, time 0 is the begin of the first packet.
  const std::int64_t shift = back->packets.front().time - coded->packets.front().time;
  const bool keeps =
      codec == AudioCodec::opus || std::string(name) == "a.mp4" || std::string(name) == "a.m4a";
  EXPECT_EQ(shift, keeps ? 0 : coded->format.priming);
  for (std::size_t i = 0; i < coded->packets.size(); ++i) {
    EXPECT_EQ(back->packets[i].bytes, coded->packets[i].bytes) << i;
    EXPECT_EQ(back->packets[i].time, coded->packets[i].time + shift) << i;
  }
  if (keeps) {
    EXPECT_EQ(*back, *coded);
  }
  const Result<Pcm> decoded = decode_audio(*back);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_NEAR(double(test::find_click(*decoded, 24037 + shift, 2000)), double(24037 + shift), 48);
}

class SoundFile : public testing::TestWithParam<const char*> {};

// Decoded block by block, coded block by block: nothing may be lost or added at the borders.
TEST_P(SoundFile, GivesTheBytesThatItsSamplesGive) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(44100, 4 * 44100 - 77, {24037, 96011});
  const std::string file = dir.file("voice.m4a");
  ASSERT_TRUE(write_container(file, {.audio = &sound}));
  const Result<Pcm> samples = read_audio(file);
  ASSERT_TRUE(samples) << samples.error().describe();
  ASSERT_EQ(samples->samples.size(), sound.samples.size()) << "padding is cut";
  MuxOptions options;
  options.systems = GetParam() == std::string("systems.mp4");
  options.fragmented = GetParam() == std::string("fragments.mp4");
  std::vector<test::Bytes> written;
  for (const MuxInput& input : {MuxInput{.face = &face, .audio = &*samples},
                                MuxInput{.face = &face, .audio_file = &file}}) {
    const Result<MuxResult> done = write_container(dir.file(GetParam()), input, options);
    ASSERT_TRUE(done) << done.error().describe();
    EXPECT_NEAR(done->sound_seconds, sound.duration(), options.systems ? 1e-3 : 1e-9);
    const Result<EncodedAudio> back = read_encoded_audio(dir.file(GetParam()));
    ASSERT_TRUE(back) << back.error().describe();
    test::Bytes all;
    for (const AudioPacket& packet : back->packets) {
      all.insert(all.end(), packet.bytes.begin(), packet.bytes.end());
    }
    written.push_back(std::move(all));
  }
  EXPECT_GT(written[0].size(), 1000u);
  EXPECT_EQ(written[0], written[1]);
}

INSTANTIATE_TEST_SUITE_P(Formats, SoundFile,
                         testing::Values("a.mp4", "fragments.mp4", "systems.mp4", "a.mkv", "a.ts",
                                         "a.m3u8", "a.mpd"));

TEST(SoundFileErrors, NameTheSoundAndLeaveNothing) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const std::string missing = dir.file("voice.wav");
  const auto none =
      write_container(dir.file("a.mp4"), MuxInput{.face = &face, .audio_file = &missing});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::not_found);
  EXPECT_THAT(none.error().describe(), testing::HasSubstr("voice.wav"));
  const Pcm sound = test::make_clicks(8000, 8000, {100});
  const auto twice = write_container(
      dir.file("a.mp4"), MuxInput{.face = &face, .audio = &sound, .audio_file = &missing});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, Code::invalid_argument);
  EXPECT_EQ(dir.count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, CopySound,
    testing::Values(Copy{"a.mp4", AudioCodec::aac}, Copy{"a.mp4", AudioCodec::opus},
                    Copy{"a.mkv", AudioCodec::aac}, Copy{"a.mkv", AudioCodec::opus},
                    Copy{"a.ts", AudioCodec::aac}, Copy{"a.m4a", AudioCodec::aac},
                    Copy{"a.mka", AudioCodec::aac}, Copy{"a.mka", AudioCodec::opus},
                    Copy{"a.webm", AudioCodec::opus}, Copy{"a.weba", AudioCodec::opus},
                    Copy{"a.opus", AudioCodec::opus}),
    [](const auto& copy) {
      std::string text = copy.param.name;
      text[1] = '_';
      return text + "_" + name_of(copy.param.codec);
    });

TEST(MuxSound, CopyAndCodingGiveTheSameFile) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(60);
  const Pcm sound = test::make_clicks(44100, 2 * 44100, {22050});
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    const Result<EncodedAudio> coded = encode_audio(sound, {.codec = codec});
    ASSERT_TRUE(coded);
    const MuxOptions options{.audio = {.codec = codec}};
    ASSERT_TRUE(write_container(dir.file("a.mkv"), {.face = &face, .audio = &sound}, options));
    ASSERT_TRUE(write_container(dir.file("b.mkv"), {.face = &face, .encoded = &*coded}));
    EXPECT_EQ(test::read_bytes(dir.file("a.mkv")), test::read_bytes(dir.file("b.mkv")));
  }
}

TEST(MuxSound, CopyIsCutAtItsLength) {
  const test::TempDir dir;
  const Pcm sound = test::make_clicks(48000, 48000, {24000});
  Result<EncodedAudio> coded = encode_audio(sound);
  ASSERT_TRUE(coded);
  coded->length = 30000;
  ASSERT_TRUE(write_container(dir.file("a.mp4"), {.encoded = &*coded}));
  const Result<Pcm> back = read_audio(dir.file("a.mp4"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->samples.size(), 30000u);
}

TEST(MuxSound, OtherCodecsCannotBeCopied) {
  const test::TempDir dir;
  ASSERT_TRUE(write_wav(dir.file("a.wav"), test::make_clicks(8000, 8000, {100})));
  const Result<EncodedAudio> wav = read_encoded_audio(dir.file("a.wav"));
  ASSERT_FALSE(wav);
  EXPECT_EQ(wav.error().code, Code::unsupported);
  EXPECT_THAT(wav.error().message, testing::HasSubstr("only aac and opus"));
  EXPECT_EQ(read_encoded_audio(dir.file("none")).error().code, Code::not_found);
}

TEST(MuxSound, UsualCodecs) {
  EXPECT_EQ(usual_codec("a.mp4"), AudioCodec::aac);
  EXPECT_EQ(usual_codec("a.MKV"), AudioCodec::aac);
  EXPECT_EQ(usual_codec("a.opus"), AudioCodec::opus);
  EXPECT_EQ(usual_codec("a.webm"), AudioCodec::opus);
  EXPECT_EQ(usual_codec("a"), AudioCodec::aac);
}

// Everything before the stop is in the file, which is as complete as any.
TEST(MuxStop, TheFileHoldsTheBegin) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(500);
  const Pcm sound = test::make_clicks(48000, 20 * 48000, {24037});
  struct Kind {
    const char* name;
    bool fragmented;
  };
  for (const auto& [name, fragmented] :
       {Kind{"a.mp4", false}, Kind{"b.mp4", true}, Kind{"a.mkv", false}, Kind{"a.ts", false}}) {
    SCOPED_TRACE(name);
    int asked = 0;
    MuxOptions options;
    options.fragmented = fragmented;
    options.stop = [&] { return ++asked == 300; };
    const auto written = write_container(dir.file(name), {.face = &face, .audio = &sound}, options);
    ASSERT_TRUE(written) << written.error().describe();
    EXPECT_TRUE(written->stopped);
    EXPECT_GT(written->seconds, 2);
    EXPECT_LT(written->seconds, 8);
    const Result<Container> back = read_container(dir.file(name));
    ASSERT_TRUE(back) << back.error().describe();
    const std::size_t count = back->face.units.size();
    EXPECT_NEAR(double(count) / 25, written->seconds, 0.1);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(back->face.units[i].bytes, face.units[i].bytes) << i;
    }
    const Result<Pcm> decoded = read_audio(dir.file(name));
    ASSERT_TRUE(decoded) << decoded.error().describe();
    EXPECT_NEAR(decoded->duration(), written->seconds, 0.1);
  }
}

TEST(MuxStop, StoppedAtOnceStillGivesAFileThatCanBeRead) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000, {24037});
  for (const char* name : {"a.mp4", "a.mkv", "a.ts"}) {
    const auto written = write_container(dir.file(name), {.face = &face, .audio = &sound},
                                         {.stop = [] { return true; }});
    ASSERT_TRUE(written) << written.error().describe();
    EXPECT_TRUE(written->stopped);
    EXPECT_LT(written->seconds, 0.6);
    const Result<Container> back = read_container(dir.file(name));
    ASSERT_TRUE(back) << name << back.error().describe();
    EXPECT_GE(back->face.units.size(), 1u);
  }
}

}  // namespace mux_sound_test
}  // namespace animeme::media
