// Encoder parameter files: what the reader refuses, and how frames are found and held.
#include "codec/text/epf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/text/bap_text.h"
#include "tests/support/body_frame.h"

namespace animeme::fba {
namespace epf_test {

using test::body_frame;
using testing::ElementsAre;
using testing::HasSubstr;

std::string numbers(int count, const char* value) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::string(" ") + value;
  return text;
}

// An intra plane of all BAPs with the widest ranges, or a predictive one.
std::string body_plane(bool intra, int number) {
  std::string text = "FBM 2\nBFR " + std::to_string(number) + "\nISI " + (intra ? "1\n" : "0\n");
  if (!intra) return text;
  return text + "BRR 25 0 0\nBTC 1 2 1 3\nBSK 4\nBMT" + numbers(kBodyGroupCount, "3") +
         "\nBQU 0\nBIX" + numbers(kBapCount, "1860") + "\nBIN" + numbers(kBapCount, "-1860") +
         "\nBPX" + numbers(kBapCount, "1860") + "\nBPN" + numbers(kBapCount, "-1860") + "\n";
}

TEST(Epf, BodyTagsAreRead) {
  auto planes = read_epf(body_plane(true, 7));
  ASSERT_TRUE(planes) << planes.error().describe();
  ASSERT_EQ(planes->size(), 1u);
  const EpfPlane& plane = planes->front();
  EXPECT_EQ(plane.object_mask, ObjectMask::body);
  EXPECT_EQ(plane.body_frame, 7);
  EXPECT_EQ(plane.temporal.rate, (CodedRate{25, 0, false}));
  EXPECT_EQ(plane.temporal.time_code, (TimeCode{1, 2, 3}));
  EXPECT_EQ(plane.temporal.skip, 4u);
  EXPECT_EQ(plane.body.mask.count(), std::size_t(kBapCount));
  EXPECT_EQ(plane.body.bap_quant, 0);
  EXPECT_THAT(plane.body.send_range, testing::Each(true));
  EXPECT_EQ(plane.body.range[kPredictiveMin][296], 31);
}

TEST(Epf, FramesAreFoundByNumberAndLeftOutBapsAreHeld) {
  auto planes = read_epf(body_plane(true, 10) + body_plane(false, 12) + body_plane(false, 11));
  ASSERT_TRUE(planes) << planes.error().describe();
  const std::vector<BodyFrame> bodies = {body_frame(12, {{2, 5}}), body_frame(10, {{1, 9}, {2, 3}}),
                                         body_frame(11, {{1, -4}})};
  auto bytes = encode_epf({}, bodies, *planes);
  ASSERT_TRUE(bytes) << bytes.error().describe();
  auto decoded = decode(*bytes);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  const BodySequence got = body_sequence(*decoded);
  ASSERT_EQ(got.frames.size(), 3u);
  std::vector<std::pair<int, int>> values;
  for (const BodyFrame& frame : got.frames) values.push_back({frame.value[1], frame.value[2]});
  EXPECT_THAT(values, ElementsAre(std::pair(9, 3), std::pair(9, 5), std::pair(-4, 5)));
}

TEST(Epf, FramesThatDoNotExist) {
  auto planes = read_epf(body_plane(true, 3));
  ASSERT_TRUE(planes);
  auto bytes = encode_epf({}, {}, *planes);
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, Code::not_found);
  EXPECT_EQ(bytes.error().message, "the EPF asks for body frame 3, but there is no BAP file");
  bytes = encode_epf(
      {}, {body_frame(0, {}), body_frame(1, {}), body_frame(2, {}), body_frame(4, {})}, *planes);
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().message,
            "the EPF asks for body frame 3, which the BAP file does not have");
}

TEST(Epf, WhatTheReaderRefuses) {
  const auto says = [](const std::string& text, Code code, const char* message) {
    auto planes = read_epf(text);
    ASSERT_FALSE(planes) << text;
    EXPECT_EQ(planes.error().code, code) << planes.error().describe();
    EXPECT_THAT(planes.error().describe(), HasSubstr(message));
  };
  const std::string first = "FBM 1\nFFR 0\nISI 1\n";
  says(first + "CDM 1\n", Code::unsupported, "line 4:6: CDM 1 selects DCT mode");
  says(first + "FIX" + numbers(66, "60") + "\nFQU 2\n", Code::syntax,
       "line 5:4: FQU must precede the ranges");
  says("FBM 2\nISI 1\nBPN" + numbers(296, "-60") + "\nBQU 2\n", Code::syntax,
       "line 4:4: BQU must precede the ranges");
  says(first + "FBM 1\nFFR 1\nISI 0\nFQU 2\n", Code::syntax,
       "line 7: FQU belongs in a plane with ISI 1");
  says(first + "FBM 1\nBTC 0 0 1 0\nISI 0\n", Code::syntax,
       "line 5: BTC belongs in a plane with ISI 1");
  says("FBM 2\nISI 1\nBMT 2\n", Code::out_of_range, "body mask type 2 is not allowed");
  says("FBM 2\nISI 1\nBIX 1 2 3\n", Code::syntax, "a number is missing");
  says("FBM 2\nISI 1\nBIN" + numbers(296, "5") + "\n", Code::out_of_range, "-1860..0");
  says("FBM 2\nISI 0\n", Code::syntax, "the first plane must be intra");
  says("BFR 1\n", Code::syntax, "a plane begins with FBM");
}

}  // namespace epf_test
}  // namespace animeme::fba
