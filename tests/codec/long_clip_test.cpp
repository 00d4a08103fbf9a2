// Clips of several windows: every frame is that of the source, for two decoders.
#include "codec/encode/long_clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "fap/receiver.h"
#include "tests/codec/two_decoders.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace long_clip_test {

using test::Random;
using Bytes = std::vector<std::uint8_t>;

fba::ClipSource source_of(const fap::Sequence& face, const std::vector<fba::BodyFrame>& body) {
  return {face.rate, [&face, &body](const fba::TakeInstant& take) {
            auto of_face = face.frames.begin();
            auto of_body = body.begin();
            while (of_face != face.frames.end() || of_body != body.end()) {
              const bool has_face = of_face != face.frames.end() &&
                                    (of_body == body.end() || of_face->number <= of_body->number);
              const bool has_body = of_body != body.end() && (of_face == face.frames.end() ||
                                                              of_body->number <= of_face->number);
              auto done = take(has_face ? &*of_face : nullptr, has_body ? &*of_body : nullptr);
              if (!done) return done;
              if (has_face) ++of_face;
              if (has_body) ++of_body;
            }
            return Result<void>();
          }};
}

constexpr std::size_t kWindow = 6'000;

struct Coded {
  Bytes stream;
  fba::EncodeReport report;
};

Coded coded(const fap::Sequence& face, const fba::EncodeOptions& options,
            const std::vector<fba::BodyFrame>& body = {}) {
  Coded coded;
  const auto take = [&](std::span<const std::uint8_t> bytes) {
    coded.stream.insert(coded.stream.end(), bytes.begin(), bytes.end());
    return Result<void>();
  };
  const auto report = fba::encode_long(source_of(face, body), options, take, kWindow);
  EXPECT_TRUE(report) << report.error().describe();
  if (report) coded.report = *report;
  return coded;
}

// A few FAPs that walk, each of which rests for long, some at 0; FAP 52 equals FAP 4 most of the
// time; FAP 60 (right) follows FAP 59 (left) except in the middle.
fap::Sequence long_clip(int frames, bool gaps) {
  Random random(11);
  fap::Sequence clip{{25, 1}, {}, "long"};
  const std::vector<int> faps = {1, 3, 4, 14, 31, 32, 48, 59, 60};
  std::array<std::int32_t, 69> value{};
  std::int64_t number = 7;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = number;
    number += gaps && i % 2003 == 1999 ? random.range(2, 300) : 1;
    for (const int fap : faps) {
      const int third = i / (frames / 3 + 1);
      // Rests in one third of the clip, at 0 or where it stopped.
      if (fap % 4 == third) {
        if (fap % 3 != 0) value[std::size_t(fap)] = 0;
      } else {
        value[std::size_t(fap)] =
            std::clamp(value[std::size_t(fap)] + random.range(-9, 9), -500, 500);
      }
      if (fap == 60 && third != 1) value[60] = value[59];
      if (fap == 1) {
        if (i % 50 > 0) continue;  // held in between
        frame.mask.set(1);
        frame.viseme = {random.range(0, 14), 0, 63, i % 100 == 0};
      } else if (i % 7 > 0 || fap != 48) {
        frame.set(fap, value[std::size_t(fap)]);
      }
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

fap::FillOptions everything() {
  fap::FillOptions options;
  options.keep_high_level = options.complete = true;
  return options;
}

// At each number of the source, what a receiver shows is what the source has.
void expect_shown(const Coded& coded, const fap::Sequence& clip) {
  const auto stream = fba::decode(coded.stream);
  ASSERT_TRUE(stream) << stream.error().describe();
  EXPECT_TRUE(stream->warnings.empty());
  EXPECT_EQ(stream->planes.size(), coded.report.planes);
  const auto shown = fba::fill(*stream, everything());
  ASSERT_TRUE(shown) << shown.error().describe();
  fap::Receiver receiver(everything());
  const std::int64_t first = clip.frames.front().number;
  fap::Mask used;
  for (const fap::Frame& frame : clip.frames) used |= frame.mask;
  std::size_t at = 0;
  for (const fap::Frame& frame : clip.frames) {
    const fap::Frame& want = receiver.receive(frame);
    at = std::min(std::size_t(frame.number - first), shown->frames.size() - 1);
    const fap::Frame& got = shown->frames[at];
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!used[fap]) continue;
      ASSERT_EQ(got.value[fap], want.value[fap]) << "frame " << frame.number << " FAP " << fap;
    }
    // What a frame defines happens once.
    ASSERT_EQ(got.viseme, want.viseme) << frame.number;
  }
}

constexpr int kThreeWindows = int(2.3 * double(kWindow));

TEST(LongClip, OfOneWindowAsEncode) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const fap::Sequence clip = test::random_clip(seed, 300, true);
    for (const bool file : {false, true}) {
      fba::EncodeOptions options = file ? fba::file_options() : fba::live_options();
      options.kept_ranges = file;
      const auto whole = fba::encode(clip, options);
      ASSERT_TRUE(whole);
      EXPECT_EQ(coded(clip, options).stream, *whole);
    }
  }
}

TEST(LongClip, WindowsShowTheSource) {
  for (const bool gaps : {false, true}) {
    const fap::Sequence clip = long_clip(kThreeWindows, gaps);
    for (fba::EncodeOptions options :
         {fba::EncodeOptions(), fba::file_options(), fba::live_options()}) {
      options.fap_quant = 0;
      const Coded stream = coded(clip, options);
      expect_shown(stream, clip);
      EXPECT_TRUE(test::both_read(stream.stream));
      EXPECT_EQ(stream.report.planes, clip.frames.size());
      EXPECT_EQ(stream.report.hazards, 0U);
      EXPECT_EQ(stream.report.rms, 0);
      if (!options.leave_out && options.intra_seconds == 0) {
        EXPECT_EQ(stream.report.intra_planes, 3U);
      }
    }
    fba::EncodeOptions options = fba::file_options();
    options.fap_quant = 0;
    options.skip_still = true;
    options.stream.plane_start_codes = fba::PlaneStartCodes::all;
    const Coded stream = coded(clip, options);
    expect_shown(stream, clip);
    EXPECT_TRUE(test::both_read(stream.stream));
  }
}

TEST(LongClip, WindowsHardlyCostAnything) {
  const fap::Sequence clip = long_clip(kThreeWindows, false);
  for (const fba::EncodeOptions& options : {fba::EncodeOptions(), fba::live_options()}) {
    const auto whole = fba::encode(clip, options);
    ASSERT_TRUE(whole);
    EXPECT_LT(double(coded(clip, options).stream.size()), 1.01 * double(whole->size()));
  }
}

// With intra periods, windows end where a period does.
TEST(LongClip, PeriodsStay) {
  const fap::Sequence clip = long_clip(kThreeWindows, false);
  fba::EncodeOptions options;
  options.intra_seconds = 4;
  const Coded stream = coded(clip, options);
  EXPECT_EQ(stream.report.intra_planes, (clip.frames.size() + 99) / 100);
}

TEST(LongClip, LimitOfTheError) {
  const fap::Sequence clip = long_clip(int(kWindow) + 900, false);
  fba::EncodeOptions options = fba::file_options();
  options.max_rms = 2;
  const Coded stream = coded(clip, options);
  EXPECT_TRUE(test::both_read(stream.stream));
  EXPECT_LE(stream.report.rms, 2.0);
  EXPECT_GT(stream.report.rms, 1.0);
}

TEST(LongClip, FaceAndBody) {
  Random random(5);
  const int frames = int(kWindow / 4) + 700;
  const fap::Sequence face = long_clip(frames, false);
  std::vector<fba::BodyFrame> body;
  for (int i = 0; i < frames; i += 3) {
    fba::BodyFrame frame;
    frame.number = i + 5;  // some of them without a face, and some of the faces without a body
    for (const std::size_t bap : {std::size_t(4), std::size_t(40), std::size_t(181)}) {
      frame.mask.set(bap);
      frame.value[bap] = random.range(-300, 300);
    }
    body.push_back(frame);
  }
  fba::EncodeOptions options = fba::file_options();
  options.fap_quant = options.bap_quant = 0;
  const Coded coded_both = coded(face, options, body);
  const auto stream = fba::decode(coded_both.stream);
  ASSERT_TRUE(stream);
  EXPECT_TRUE(test::both_read(coded_both.stream));
  std::array<std::int32_t, fba::kBapCount + 1> want{};
  std::size_t next = 0;
  for (const fba::Plane& plane : stream->planes) {
    const std::int64_t number = plane.number + 5;
    if (next < body.size() && body[next].number == number) want = body[next++].value;
    ASSERT_TRUE(plane.body);
    ASSERT_EQ(plane.body->value, want) << number;
  }
  EXPECT_EQ(next, body.size());
}

TEST(LongClip, Errors) {
  fap::Sequence clip = long_clip(int(kWindow) + 10, false);
  const auto error_of = [&clip](const fba::EncodeOptions& options) {
    const auto report = fba::encode_long(
        source_of(clip, {}), options, [](std::span<const std::uint8_t>) { return Result<void>(); });
    EXPECT_FALSE(report);
    return report ? std::string() : report.error().message;
  };
  fba::EncodeOptions wrong;
  wrong.fap_quant = 32;
  EXPECT_NE(error_of(wrong).find("quant"), std::string::npos);
  for (std::size_t i = kWindow; i < clip.frames.size(); ++i) {
    clip.frames[i].number += 2'000'000;
  }
  EXPECT_NE(error_of({}).find("more than a million frames"), std::string::npos);
  clip.frames.clear();
  EXPECT_NE(error_of({}).find("no frames"), std::string::npos);
}

}  // namespace long_clip_test
}  // namespace animeme
