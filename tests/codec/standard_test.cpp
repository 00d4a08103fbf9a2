// Every stream that our encoders write is read plane for plane by a decoder that follows the rule
// of stuffing to the letter, shares no code with ours, and checks nothing that the standard does
// not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/decode/repair.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "tests/codec/two_decoders.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"
#include "tests/support/standard_decoder.h"

namespace animeme {
namespace standard_test {

using test::Random;
using test::StandardDecoder;
using Bytes = std::vector<std::uint8_t>;
using test::both_read;
using test::face_values;
using test::quiet_body;
using test::quiet_clip;
using test::some_options;

class Clips : public testing::TestWithParam<int> {};

// Ten times 250 clips, each once in a preset and once live.
TEST_P(Clips, QuietOnesAreReadByBoth) {
  Random random(std::uint64_t(GetParam()) * 7919);
  for (int i = 0; i < 250; ++i) {
    SCOPED_TRACE("clip " + std::to_string(i));
    const fap::Sequence clip = quiet_clip(random);
    const auto body = random.chance(10) ? quiet_body(random, clip) : std::vector<fba::BodyFrame>();
    const auto stream = fba::encode(clip, some_options(random), body);
    ASSERT_TRUE(stream) << stream.error().describe();
    ASSERT_TRUE(both_read(*stream));
    const auto units = fba::split_access_units(*stream);
    ASSERT_TRUE(units) << units.error().describe();
    ASSERT_TRUE(both_read(fba::join_access_units(*units, random.chance(50))));
  }
}

TEST_P(Clips, LiveOnesAreReadByBoth) {
  Random random(std::uint64_t(GetParam()) * 104729);
  for (int i = 0; i < 25; ++i) {
    SCOPED_TRACE("clip " + std::to_string(i));
    const fap::Sequence clip = quiet_clip(random);
    fba::LiveOptions options;
    options.rate = clip.rate;
    options.fap_quant = random.range(0, 31);
    options.intra_seconds = random.range(0, 30) / 25.0;
    options.old_codes = random.chance(20);
    options.plane_start_codes = fba::PlaneStartCodes(random.range(0, 2));
    fba::LiveEncoder encoder(options);
    Bytes stream;
    for (const fap::Frame& frame : clip.frames) {
      const auto unit = encoder.write(frame);
      ASSERT_TRUE(unit) << unit.error().describe();
      stream.insert(stream.end(), unit->begin(), unit->end());
    }
    const Bytes end = encoder.finish();
    stream.insert(stream.end(), end.begin(), end.end());
    ASSERT_TRUE(both_read(stream));
  }
}

TEST_P(Clips, BusyOnesAreReadByBoth) {
  Random random(std::uint64_t(GetParam()) * 15485863);
  for (int i = 0; i < 5; ++i) {
    const fap::Sequence clip = test::random_clip(random.next(), 20, true);
    fba::EncodeOptions options = some_options(random);
    options.max_rms = options.max_bits_per_second = 0;
    const auto stream = fba::encode(clip, options);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_TRUE(both_read(*stream));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Clips, testing::Range(1, 11));

fap::Sequence still_clip(int frames) {
  fap::Sequence clip;
  fap::Frame frame;
  frame.mask.set(3).set(4);
  frame.value[3] = frame.value[4] = 40;
  for (; frame.number < frames; ++frame.number) clip.frames.push_back(frame);
  return clip;
}

// The last plane has 6 bits: at some lengths it lies whole in the byte in front of the end code.
TEST(ShortPlanes, OfAStillFaceAreAllThere) {
  for (int frames = 1; frames <= 40; ++frames) {
    SCOPED_TRACE(frames);
    for (const auto where : {fba::PlaneStartCodes::none, fba::PlaneStartCodes::intra}) {
      fba::EncodeOptions options;
      options.stream.plane_start_codes = where;
      options.intra_seconds = (where == fba::PlaneStartCodes::intra ? 11 : 0) / 25.0;
      const auto stream = fba::encode(still_clip(frames), options);
      ASSERT_TRUE(stream) << stream.error().describe();
      EXPECT_TRUE(both_read(*stream));
      EXPECT_EQ(StandardDecoder::decode(*stream).size(), std::size_t(frames));
    }
  }
}

// What take() gave away in between does not hide the plane from its end.
TEST(ShortPlanes, AreLengthenedWhereverBytesWereTaken) {
  int longer = 0;
  for (int frames = 1; frames <= 20; ++frames) {
    fba::FaceSettings settings;
    settings.mask.set(3);
    settings.mask_type[1] = fba::MaskType::hold;
    settings.send_range = {true, true, true, true};
    fap::Frame face;
    fba::Encoder encoder, other;
    Bytes taken;
    for (int i = 0; i < frames; ++i) {
      fba::PlaneInput plane;
      plane.intra = i == 0;
      plane.face = &face;
      plane.face_settings = &settings;
      ASSERT_TRUE(encoder.write(plane));
      ASSERT_TRUE(other.write(plane));
      const Bytes bytes = encoder.take();
      taken.insert(taken.end(), bytes.begin(), bytes.end());
    }
    const Bytes bytes = encoder.finish();
    taken.insert(taken.end(), bytes.begin(), bytes.end());
    EXPECT_EQ(taken, other.finish());
    EXPECT_TRUE(both_read(taken));
    const auto ours = fba::decode(taken);
    ASSERT_TRUE(ours);
    longer += ours->planes.back().temporal.skip.has_value() ? 1 : 0;
  }
  EXPECT_GT(longer, 2);
  EXPECT_LT(longer, 18);
}

// What others wrote without the rule: read as the standard says, and told.
TEST(ShortPlanes, OfOtherEncodersAreLostWithAWarning) {
  fba::FaceSettings settings;
  fap::Frame face;
  fba::PlaneInput plane;
  plane.intra = true;
  plane.face = &face;
  plane.face_settings = &settings;
  fba::Encoder encoder;
  ASSERT_TRUE(encoder.write(plane));
  plane.intra = false;
  std::size_t planes = 1;
  // Planes of 6 bits, and one of 3 where an odd number is needed.
  for (; encoder.bits() % 8 != 0; ++planes) {
    fba::PlaneInput nothing;
    nothing.object_mask = fba::ObjectMask::nothing;
    ASSERT_TRUE(encoder.write(encoder.bits() % 2 != 0 ? nothing : plane));
  }
  Bytes stream = encoder.take();
  // One more plane, 0 01 0 01, and the stuffing 01.
  stream.insert(stream.end(), {0b00100101, 0x00, 0x00, 0x01, 0xB1});
  const auto ours = fba::decode(stream);
  ASSERT_TRUE(ours) << ours.error().describe();
  EXPECT_EQ(ours->planes.size(), planes);
  EXPECT_EQ(StandardDecoder::decode(stream).size(), planes);
  ASSERT_EQ(ours->warnings.size(), 1u);
  EXPECT_THAT(ours->warnings[0], testing::HasSubstr("taken for stuffing"));
}

// The plain decoder is one that others' streams agree with.
TEST(StandardDecoder, HasTheValuesOfTheReferenceStreams) {
  int count = 0;
  for (const auto& base : test::reference_streams()) {
    const Bytes stream = test::read_bytes(test::with(base, ".fba"));
    const auto ours = fba::decode(stream);
    if (!ours) continue;                                      // a part of it can be decoded
    if (base.filename() == "end_without_stuffing") continue;  // ours is tolerant there
    std::vector<StandardDecoder::Plane> theirs;
    ASSERT_NO_THROW(theirs = StandardDecoder::decode(stream)) << base;
    ASSERT_EQ(theirs.size(), ours->planes.size()) << base;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
      ASSERT_EQ(theirs[i].face, face_values(ours->planes[i].face)) << base << " plane " << i;
    }
    ++count;
  }
  EXPECT_GT(count, 100);
}

TEST(Standard, RepairedStreamsAreReadByBoth) {
  std::size_t damaged = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    fba::EncodeOptions options;
    options.intra_seconds = 0.4;
    const auto encoded = fba::encode(quiet_clip(random), options);
    ASSERT_TRUE(encoded) << encoded.error().describe();
    const auto units = fba::split_access_units(*encoded);
    ASSERT_TRUE(units) << units.error().describe();
    Bytes stream = fba::join_access_units(*units);
    stream[std::size_t(random.range(0, int(stream.size()) - 1))] ^=
        std::uint8_t(1 << random.range(0, 7));
    const auto repaired = fba::repair_stream(stream);
    if (!repaired || repaired->damage.empty()) continue;
    ++damaged;
    const auto ours = fba::decode(repaired->stream);
    ASSERT_TRUE(ours) << ours.error().describe();
    if (!ours->warnings.empty()) continue;  // no intra plane is beyond doubt
    EXPECT_TRUE(both_read(repaired->stream)) << seed;
  }
  EXPECT_GT(damaged, 60u);
}

}  // namespace standard_test
}  // namespace animeme
