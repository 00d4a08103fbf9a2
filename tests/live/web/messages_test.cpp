// Bytes and numbers that the server sends: /face, /faps, the segments of sound.
#include "tools/live/web/detail/messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "tests/support/live_loop.h"
#include "tests/support/reference_streams.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/live/web/detail/values.h"

namespace animeme::test {
namespace messages_test {

using Bytes = std::vector<std::uint8_t>;

TEST(WebMessages, HelloByteForByte) {
  const web::Hello hello{0x61, true, 25000, {0, 0, 1, 0xB0}};
  const Bytes bytes = {'A', 1, 0x61, 1, 0, 0, 0x61, 0xA8, 0, 4, 0, 0, 1, 0xB0};
  EXPECT_EQ(web::write_hello(hello), bytes);
  EXPECT_EQ(*web::read_hello(bytes), hello);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(web::read_hello(std::span(bytes).first(size)));
  }
  Bytes newer = bytes;
  newer[1] = 2;
  EXPECT_EQ(web::read_hello(newer).error().code, Code::unsupported);
}

TEST(WebMessages, UnitByteForByte) {
  const web::UnitMessage unit{0x0102030405060708, 1000, web::kIntra, {0, 0, 1, 0xBB, 0x55}};
  const Bytes bytes = {1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 3, 0xE8, 1, 0, 0, 1, 0xBB, 0x55};
  EXPECT_EQ(web::write_unit(unit), bytes);
  EXPECT_EQ(*web::read_unit(bytes), unit);
  EXPECT_FALSE(web::read_unit(std::span(bytes).first(13)));
}

// What /faps sends is what the decoder and its rules of filling say, plane by plane.
TEST(WebMessages, ValuesAreThoseOfTheDecoder) {
  int compared = 0;
  for (const auto& base : reference_streams()) {
    SCOPED_TRACE(base.filename());
    const auto bytes = read_bytes(with(base, ".fba"));
    const auto units = fba::split_access_units(bytes);
    const auto stream = fba::decode(bytes);
    if (!units || !stream) continue;
    const auto filled = fba::fill(*stream, {.keep_high_level = true});
    ASSERT_TRUE(filled);
    web::Values values;
    std::size_t plane = 0;
    for (const fba::AccessUnit& unit : units->units) {
      const auto face = values.push(unit.bytes);
      ASSERT_LT(plane, stream->planes.size());
      const fba::Plane& decoded = stream->planes[plane++];
      ASSERT_EQ(face.has_value(), has_face(decoded.object_mask)) << plane;
      if (!face) continue;
      const fap::Frame& want = filled->frames[std::size_t(decoded.face.number)];
      for (std::size_t fap = 3; fap < face->value.size(); ++fap) {
        if (!want.mask[fap]) continue;
        ASSERT_EQ(face->value[fap], want.value[fap]) << "plane " << plane << " FAP " << fap;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(WebMessages, ValuesAreJson) {
  fap::Frame face;
  face.set(3, -250);
  face.mask.set(1);
  face.viseme = {2, 5, 40, false};
  const auto json = nlohmann::json::parse(web::write_values({1.25, 0.04, true, 99}, face));
  EXPECT_EQ(json["time"], 1.25);
  EXPECT_EQ(json["values"]["3"], -250);
  EXPECT_EQ(json["values"]["1"]["blend"], 40);
  EXPECT_EQ(json["values"].size(), 2u);
  const auto hello = nlohmann::json::parse(web::values_hello(25000));
  EXPECT_EQ(hello["faps"]["3"]["name"], "open_jaw");
  EXPECT_EQ(hello["faps"]["3"]["unit"], "MNS");
  EXPECT_EQ(hello["faps"].size(), 68u);
  EXPECT_EQ(hello["timescale"], 25000);
}

TEST(WebMessages, AValueFeedSurvivesJoiningInTheMiddle) {
  const Presentation show = live_presentation(40, 10);
  web::Values whole, late;
  for (std::size_t i = 0; i < show.units.size(); ++i) {
    const auto all = whole.push(show.units[i].bytes);
    if (i < 13) continue;
    const auto some = late.push(show.units[i].bytes);
    EXPECT_EQ(some.has_value(), i >= 20) << i;
    EXPECT_TRUE(!some || some->value == all->value) << i;
  }
}

std::vector<media::AudioPacket> packets() {
  return {{{1, 2, 3}, 47000, 1024}, {{4}, 48024, 1024}, {Bytes(300, 7), 49048, 1024}};
}

TEST(AudioSegments, ComeBack) {
  for (media::AudioFormat format : {aac_format(), opus_format()}) {
    const auto init = media::write_audio_init(format);
    ASSERT_TRUE(init);
    auto back = media::read_audio_init(*init);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(back->priming, 0);
    media::set_priming(*back, format.priming);
    EXPECT_EQ(*back, format);
  }
  auto segment = media::write_audio_segment(5, packets());
  ASSERT_TRUE(segment);
  EXPECT_EQ(*media::read_audio_segment(*segment), packets());
  media::set_segment_time(*segment, 12);
  EXPECT_EQ(media::read_audio_segment(*segment)->front().time, 12);
  EXPECT_EQ(media::audio_mime(opus_format()), "audio/mp4; codecs=\"opus\"");
  EXPECT_FALSE(media::write_audio_segment(1, {}));
  EXPECT_FALSE(media::write_audio_init({}));
}

TEST(AudioSegments, DamageIsFound) {
  const auto init = media::write_audio_init(aac_format());
  const auto segment = media::write_audio_segment(5, packets());
  for (std::size_t size = 0; size < segment->size(); ++size) {
    EXPECT_FALSE(media::read_audio_segment(std::span(*segment).first(size)));
  }
  std::mt19937 random(1);
  for (int round = 0; round < 4000; ++round) {
    Bytes a = *init, b = *segment;
    for (int i = 0; i < 3; ++i) {
      a[random() % a.size()] = std::uint8_t(random());
      b[random() % b.size()] = std::uint8_t(random());
    }
    (void)media::read_audio_init(a);
    const auto read = media::read_audio_segment(b);
    EXPECT_TRUE(!read || read->size() <= b.size());
  }
}

}  // namespace messages_test
}  // namespace animeme::test
