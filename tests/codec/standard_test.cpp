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
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"
#include "tests/support/standard_decoder.h"

namespace animeme {
namespace standard_test {

using test::Random;
using test::StandardDecoder;
using Bytes = std::vector<std::uint8_t>;

StandardDecoder::Values face_values(const fap::Frame& face) {
  StandardDecoder::Values out;
  for (int n = fap::kFirstLowLevel; n <= fap::kFapCount; ++n) {
    if (face.mask[std::size_t(n)]) out[n] = face.value[std::size_t(n)];
  }
  const auto add = [&](int first, std::initializer_list<int> values) {
    for (const int value : values) out[first++] = value;
  };
  if (face.mask[1]) {
    const fap::Viseme& v = face.viseme;
    add(100, {v.select1, v.select2, v.blend, v.def});
  }
  if (face.mask[2]) {
    const fap::Expression& e = face.expression;
    add(200, {e.select1, e.intensity1, e.select2, e.intensity2, e.init_face, e.def});
  }
  return out;
}

StandardDecoder::Values body_values(const fba::BodyFrame& body) {
  StandardDecoder::Values out;
  for (std::size_t n = 1; n <= std::size_t(fba::kBapCount); ++n) {
    if (body.mask[n]) out[int(n)] = body.value[n];
  }
  return out;
}

/// Does the plain decoder have every plane that ours has? Says in what they differ.
testing::AssertionResult both_read(const Bytes& stream) {
  auto ours = fba::decode(stream);
  if (!ours) return testing::AssertionFailure() << ours.error().describe();
  if (!ours->warnings.empty()) return testing::AssertionFailure() << ours->warnings.front();
  std::vector<StandardDecoder::Plane> theirs;
  try {
    theirs = StandardDecoder::decode(stream);
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "the plain decoder: " << error.what();
  }
  if (theirs.size() != ours->planes.size()) {
    return testing::AssertionFailure()
           << ours->planes.size() << " planes, the plain decoder has " << theirs.size();
  }
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const fba::Plane& plane = ours->planes[i];
    const bool same =
        theirs[i].intra == plane.intra && theirs[i].object_mask == int(plane.object_mask) &&
        theirs[i].skip == long(plane.temporal.skip.value_or(0)) &&
        theirs[i].bit == std::size_t(plane.bit_begin) &&
        theirs[i].face == face_values(plane.face) &&
        theirs[i].body == (plane.body ? body_values(*plane.body) : StandardDecoder::Values());
    if (!same) return testing::AssertionFailure() << "plane " << i << " differs";
  }
  return testing::AssertionSuccess();
}

/// A face at rest most of the time: a few FAPs, some of which move now and then by little.
fap::Sequence quiet_clip(Random& random) {
  constexpr fap::Rate kRates[] = {{25, 1}, {30, 1}, {60, 1}, {30000, 1001}, {12, 1}};
  fap::Sequence clip;
  clip.rate = kRates[random.range(0, 4)];
  std::vector<std::size_t> faps;
  for (int i = random.range(1, 5); i > 0; --i) faps.push_back(std::size_t(random.range(3, 68)));
  fap::Frame frame;
  for (const std::size_t fap : faps) frame.value[fap] = random.range(-60, 60), frame.mask.set(fap);
  if (random.chance(10)) frame.mask.set(1);
  if (random.chance(5)) frame.mask.set(2);
  const int activity = random.range(0, 30);
  const int frames = random.range(1, 60);
  for (int i = 0; i < frames; ++i) {
    if (random.chance(activity)) {
      frame.value[faps[std::size_t(random.range(0, int(faps.size()) - 1))]] +=
          random.range(-30, 30);
    }
    if (frame.mask[1] && random.chance(activity)) frame.viseme.select1 = random.range(0, 14);
    clip.frames.push_back(frame);
    frame.number += random.chance(3) ? random.range(2, 40) : 1;
  }
  return clip;
}

std::vector<fba::BodyFrame> quiet_body(Random& random, const fap::Sequence& face) {
  std::vector<fba::BodyFrame> body;
  fba::BodyFrame frame;
  const std::size_t bap = std::size_t(random.range(1, fba::kBapCount));
  frame.mask.set(bap);
  for (const fap::Frame& other : face.frames) {
    frame.number = other.number;
    if (random.chance(10)) frame.value[bap] = random.range(-1800, 1800);
    body.push_back(frame);
  }
  return body;
}

fba::EncodeOptions some_options(Random& random) {
  fba::EncodeOptions options = random.chance(50) ? fba::file_options() : fba::EncodeOptions{};
  options.fap_quant = random.chance(60) ? random.range(1, 4) : random.range(0, 31);
  options.bap_quant = random.range(0, 31);
  if (random.chance(50)) options.intra_seconds = random.range(1, 30) / 25.0;
  options.stream.plane_start_codes = fba::PlaneStartCodes(random.range(0, 2));
  options.stream.old_codes = random.chance(20);
  options.skip_still = random.chance(20);
  options.kept_ranges = options.intra_seconds == 0 && random.chance(50);
  // These search, which takes long.
  if (random.chance(2)) options.max_bits_per_second = random.range(100, 1000);
  if (random.chance(2)) options.max_rms = random.range(1, 5);
  return options;
}

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
    EXPECT_TRUE(both_read(repaired->stream)) << seed;
  }
  EXPECT_GT(damaged, 60u);
}

}  // namespace standard_test
}  // namespace animeme
