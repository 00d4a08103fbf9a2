// Cuts and joins: every frame of the result is the frame of its source, for two decoders.
#include "codec/encode/splice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "tests/codec/two_decoders.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace splice_test {

using test::Random;
using Bytes = std::vector<std::uint8_t>;

struct Piece {
  const fba::DecodedStream* source = nullptr;
  std::int64_t first = 0, end = 0;  // frames
};

// Frames that players show, all FAPs.
std::vector<fap::Frame> shown(const fba::DecodedStream& stream) {
  fap::FillOptions options;
  options.keep_high_level = true;
  options.complete = true;
  const auto clip = fba::fill(stream, options);
  EXPECT_TRUE(clip) << clip.error().describe();
  if (!clip || clip->frames.empty()) return {fap::Frame()};  // a body alone
  return clip->frames;
}

// With the frames that the last plane skips, which fill() leaves out.
std::int64_t length(const fba::DecodedStream& stream) {
  const fba::Plane& last = stream.planes.back();
  return last.number + 1 + std::int64_t(last.temporal.skip.value_or(0));
}

fba::DecodedStream decoded(const Bytes& stream) {
  auto all = fba::decode(stream);
  EXPECT_TRUE(all) << all.error().describe();
  return all ? std::move(*all) : fba::DecodedStream();
}

// Values of the body in each frame, held where a plane has none.
std::vector<std::array<std::int32_t, fba::kBapCount + 1>> bodies(const fba::DecodedStream& stream) {
  std::vector<std::array<std::int32_t, fba::kBapCount + 1>> all;
  for (const fba::Plane& plane : stream.planes) {
    auto values = all.empty() ? std::array<std::int32_t, fba::kBapCount + 1>() : all.back();
    all.resize(std::size_t(plane.number), values);
    for (std::size_t bap = 1; plane.body && bap < values.size(); ++bap) {
      if (plane.body->mask[bap]) values[bap] = plane.body->value[bap];
    }
    all.push_back(values);
  }
  all.resize(std::size_t(length(stream)), all.back());
  return all;
}

struct Spliced {
  Bytes stream;
  fba::SpliceReport report;
};

Spliced splice(const std::vector<Piece>& pieces, fba::PlaneStartCodes start_codes) {
  fba::Splicer splicer({start_codes, false});
  for (const Piece& piece : pieces) {
    splicer.begin_source();
    for (const fba::Plane& plane : piece.source->planes) {
      const auto more = splicer.copy_frames(plane, piece.first, piece.end);
      EXPECT_TRUE(more) << more.error().describe();
      if (!more || !*more) break;
    }
  }
  Spliced spliced;
  spliced.stream = splicer.finish();
  spliced.report = splicer.report();
  return spliced;
}

// Values and looks; the flags def and init_face are events of a frame.
testing::AssertionResult same(const fap::Frame& a, const fap::Frame& b) {
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (a.value[fap] != b.value[fap]) {
      return testing::AssertionFailure()
             << "FAP " << fap << ": " << a.value[fap] << " in place of " << b.value[fap];
    }
  }
  fap::Viseme v = a.viseme, w = b.viseme;
  v.def = w.def = false;
  if (!(v == w)) {
    return testing::AssertionFailure()
           << "blend of FAP 1: " << v.blend << " in place of " << w.blend;
  }
  fap::Expression e = a.expression, f = b.expression;
  e.def = f.def = e.init_face = f.init_face = false;
  if (!(e == f)) return testing::AssertionFailure() << "FAP 2";
  return testing::AssertionSuccess();
}

void expect_pieces(const Spliced& spliced, const std::vector<Piece>& pieces) {
  ASSERT_TRUE(test::both_read(spliced.stream));
  const fba::DecodedStream result = decoded(spliced.stream);
  const std::vector<fap::Frame> frames = shown(result);
  const auto body = bodies(result);
  std::int64_t at = 0;
  for (const Piece& piece : pieces) {
    const auto source_body = bodies(*piece.source);
    const std::vector<fap::Frame> source = shown(*piece.source);
    const std::int64_t end = std::min(piece.end, length(*piece.source));
    for (std::int64_t frame = piece.first; frame < end; ++frame, ++at) {
      const auto last = std::int64_t(source.size()) - 1;
      const auto shown_at = std::min<std::int64_t>(at, std::int64_t(frames.size()) - 1);
      ASSERT_TRUE(same(frames[std::size_t(shown_at)], source[std::size_t(std::min(frame, last))]))
          << "frame " << at << ", " << frame << " of its source";
      ASSERT_EQ(body[std::size_t(at)], source_body[std::size_t(frame)]) << "body, frame " << at;
    }
  }
  EXPECT_EQ(length(result), at);
  EXPECT_EQ(spliced.report.planes, result.planes.size());
}

class Cuts : public testing::TestWithParam<int> {};

TEST_P(Cuts, AndJoinsKeepEveryFrame) {
  std::size_t changed = 0, recoded = 0, planes = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed + std::uint64_t(GetParam()) * 1000);
    std::vector<fba::DecodedStream> sources;
    for (int i = random.range(1, 3); i > 0; --i) {
      fap::Sequence clip = random.chance(50)
                               ? test::quiet_clip(random)
                               : test::random_clip(random.next(), 40, random.chance(30));
      clip.rate = {25, 1};
      const auto body =
          random.chance(20) ? test::quiet_body(random, clip) : std::vector<fba::BodyFrame>();
      fba::EncodeOptions options = test::some_options(random);
      options.fap_quant = std::max(options.fap_quant, 1);
      const auto stream = fba::encode(clip, options, body);
      ASSERT_TRUE(stream) << stream.error().describe();
      sources.push_back(decoded(*stream));
    }
    std::vector<Piece> pieces;
    for (int i = random.range(1, 4); i > 0; --i) {
      Piece piece;
      piece.source = &sources[std::size_t(random.range(0, int(sources.size()) - 1))];
      const int most = int(length(*piece.source));
      piece.first = random.range(0, most - 1);
      piece.end = random.range(int(piece.first) + 1, most + 5);
      pieces.push_back(piece);
    }
    const Spliced spliced = splice(pieces, fba::PlaneStartCodes(random.range(0, 2)));
    changed += spliced.report.changed;
    recoded += spliced.report.recoded;
    planes += spliced.report.planes;
    if (spliced.report.changed == 0) expect_pieces(spliced, pieces);
  }
  EXPECT_EQ(changed, 0u);
  EXPECT_GT(recoded, planes / 10);
}

INSTANTIATE_TEST_SUITE_P(Random, Cuts, testing::Range(0, 4));

// The bits of a plane.
std::vector<bool> bits(const Bytes& stream, const fba::Plane& plane) {
  std::vector<bool> all;
  for (std::int64_t bit = plane.bit_begin; bit < plane.bit_end; ++bit) {
    all.push_back((stream[std::size_t(bit / 8)] >> (7 - bit % 8) & 1) != 0);
  }
  return all;
}

TEST(Splicer, BehindTheNextIntraPlaneBitsAreKept) {
  fap::Sequence clip = test::random_clip(5, 100);
  clip.rate = {25, 1};
  fba::EncodeOptions options;
  options.intra_seconds = 0.4;  // planes 0, 10, 20 ...
  const auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream);
  const fba::DecodedStream source = decoded(*stream);
  for (const int first : {20, 23}) {
    const Spliced spliced = splice({{&source, first, 100}}, fba::PlaneStartCodes::none);
    const fba::DecodedStream result = decoded(spliced.stream);
    const int from = first == 20 ? 20 : 30;
    EXPECT_LE(spliced.report.recoded,
              std::size_t(from - first));  // jumps make further intra planes
    for (int i = from; i < 100; ++i) {
      ASSERT_EQ(bits(spliced.stream, result.planes[std::size_t(i - first)]),
                bits(*stream, source.planes[std::size_t(i)]))
          << i;
    }
  }
}

TEST(Splicer, CopiesReferenceStreamsByteForByteAndCutsThem) {
  int count = 0, beyond = 0;
  for (const auto& base : test::reference_streams()) {
    const Bytes stream = test::read_bytes(test::with(base, ".fba"));
    const auto ours = fba::decode(stream);
    if (!ours || ours->planes.size() < 8) continue;
    SCOPED_TRACE(base.string());
    const std::int64_t end = length(*ours);
    const Spliced whole = splice({{&*ours, 0, end}}, fba::PlaneStartCodes::none);
    // Planes without face and body get lost where a start code follows, so they get a face.
    const auto nothing = std::count_if(
        ours->planes.begin(), ours->planes.end(),
        [](const fba::Plane& plane) { return plane.object_mask == fba::ObjectMask::nothing; });
    EXPECT_EQ(whole.report.recoded == 0, nothing == 0);
    if (nothing > 0) continue;
    const fba::DecodedStream copy = decoded(whole.stream);
    for (std::size_t i = 0; i < ours->planes.size(); ++i) {
      ASSERT_EQ(bits(whole.stream, copy.planes[i]), bits(stream, ours->planes[i])) << i;
    }
    const std::vector<Piece> pieces = {{&*ours, end / 3, end / 2}, {&*ours, 1, end / 4}};
    const Spliced cut = splice(pieces, fba::PlaneStartCodes::all);
    // Values beyond the largest range, in made-up cases: the intra plane of a cut cannot hold them.
    if (cut.report.changed > 0) {
      ++beyond;
      continue;
    }
    expect_pieces(cut, pieces);
    ++count;
  }
  EXPECT_GT(count, 20);
  EXPECT_LT(beyond, count / 10) << count;
}

// An intra plane without face and body takes three bits, which a start code behind them turns into
// stuffing.
TEST(Splicer, IntraPlanesWithoutFaceAndBodyAreNotLost) {
  fba::Encoder encoder({fba::PlaneStartCodes::none, false});
  fba::FaceSettings settings;
  settings.mask.set(3);
  settings.mask_type[1] = fba::MaskType::hold;
  settings.send_range = {true, true, true, true};
  fap::Frame frame;
  fba::PlaneInput plane;
  plane.intra = true;
  plane.face = &frame;
  plane.face_settings = &settings;
  ASSERT_TRUE(encoder.write(plane)) << encoder.write(plane).error().describe();
  plane.object_mask = fba::ObjectMask::nothing;
  // Each place of the plane in its byte.
  for (int i = 0; i < 40; ++i) {
    plane.intra = i % 3 != 0;
    ASSERT_TRUE(encoder.write(plane));
  }
  plane.object_mask = fba::ObjectMask::face;
  plane.intra = true;
  ASSERT_TRUE(encoder.write(plane));
  const fba::DecodedStream source = decoded(encoder.finish());
  ASSERT_EQ(source.planes.size(), 42u);
  for (std::int64_t end = 1; end <= 42; ++end) {
    for (const std::int64_t first : {std::int64_t(0), end / 2, end - 1}) {
      for (const auto codes : {fba::PlaneStartCodes::none, fba::PlaneStartCodes::intra}) {
        const Spliced cut = splice({{&source, first, end}, {&source, 0, end}}, codes);
        EXPECT_EQ(decoded(cut.stream).planes.size(), std::size_t(end - first + end));
      }
    }
  }
}

TEST(JoinedStreams, AreFoundByTheirEndCodes) {
  Random random(9);
  fap::Sequence quiet = test::quiet_clip(random), lively = test::random_clip(4, 30);
  quiet.rate = lively.rate = {25, 1};
  const auto a = fba::encode(quiet), b = fba::encode(lively);
  ASSERT_TRUE(a && b);
  EXPECT_FALSE(fba::join_streams(*a));
  Bytes trailing = *a;
  trailing.resize(trailing.size() + 10, 7);
  EXPECT_FALSE(fba::join_streams(trailing));
  Bytes both = *a;
  both.insert(both.end(), b->begin(), b->end());
  both.insert(both.end(), a->begin(), a->end());
  const auto joined = fba::join_streams(both);
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->count, 3u);
  const fba::DecodedStream first = decoded(*a), second = decoded(*b);
  Spliced spliced;
  spliced.stream = joined->stream;
  spliced.report.planes = 2 * first.planes.size() + second.planes.size();
  expect_pieces(
      spliced,
      {{&first, 0, length(first)}, {&second, 0, length(second)}, {&first, 0, length(first)}});
  both[a->size() + 60] ^= 0xFF;
  EXPECT_FALSE(fba::join_streams(std::span(both).first(a->size() + 80)));  // damaged
}

TEST(Splicer, NeedsAnIntraPlaneFirst) {
  const auto stream = fba::encode(test::random_clip(3, 10));
  ASSERT_TRUE(stream);
  fba::Splicer splicer;
  const auto copied = splicer.copy(decoded(*stream).planes[1]);
  ASSERT_FALSE(copied);
  EXPECT_EQ(copied.error().code, Code::invalid_argument);
}

}  // namespace splice_test
}  // namespace animeme
