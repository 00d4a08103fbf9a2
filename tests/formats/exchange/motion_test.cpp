// Motion out of any bytes: kinds of files, what each reader gives, tables of curves.
#include "tools/formats/exchange/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/encode/encode.h"
#include "dam/corpus/corpus.h"
#include "fap/text.h"
#include "tests/support/landmark_tables.h"
#include "tests/support/shared.h"
#include "tools/formats/exchange/curves.h"

namespace animeme::exchange {
namespace motion_test {

using test::data_file;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::uint8_t> bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(ExchangeMotion, KindsOfFiles) {
  using namespace std::string_literals;
  const struct {
    std::string text;
    FileKind kind;
  } cases[] = {
      {data_file("fap/plain.fap"), FileKind::fap_text},
      {data_file("fap/headerless.fap"), FileKind::fap_text},
      {"# a comment\n\n3.1 body 25 1\n", FileKind::bap_text},
      {"\0\0\1\xBA"s, FileKind::fba_stream},
      {"ANIMEDAM", FileKind::model},
      {data_file("scripts/corpus.tsv"), FileKind::script},
      {data_file("scripts/long.TextGrid"), FileKind::script},
      {data_file("scripts/short_utf16le.TextGrid"), FileKind::script},
      {data_file("grid_s1_sample/fap/bbbf9a.csv"), FileKind::curves},
      {"Timecode,BlendShapeCount,JawOpen,JawLeft\n", FileKind::curves},
      {test::openface(1), FileKind::curves},
      {data_file("containers/std_aac.mp4"), FileKind::media},
      {"#EXTM3U\n", FileKind::media},
      {"<?xml version=\"1.0\"?><MPD>", FileKind::media},
      {"\0"s, FileKind::media},
      {"", FileKind::unknown},
      {"\n \t\n# nothing\n", FileKind::unknown},
  };
  for (const auto& one : cases) {
    EXPECT_EQ(kind_of(bytes(one.text)), one.kind) << one.text.substr(0, 60);
    const bool playlist = one.text.starts_with("#EXTM3U") || one.text.starts_with("<");
    EXPECT_EQ(is_playlist(bytes(one.text)), playlist) << one.text.substr(0, 60);
  }
}

TEST(ExchangeMotion, TextKeepsItsNumbersOrNot) {
  const std::string text = data_file("fap/plain.fap");
  const auto motion = read_motion(bytes(text));
  ASSERT_TRUE(motion) << motion.error().describe();
  const auto clip = fap::read_text(text);
  ASSERT_TRUE(clip);
  EXPECT_EQ(fap::write_text(motion->face), fap::write_text(*clip));
  EXPECT_TRUE(motion->body.frames.empty());
  EXPECT_TRUE(motion->stream.empty());
  fap::Sequence late = *clip;
  for (fap::Frame& frame : late.frames) frame.number += 100;
  const auto kept = read_motion(bytes(fap::write_text(late)), FrameNumbers::keep);
  ASSERT_TRUE(kept) << kept.error().describe();
  EXPECT_EQ(kept->face.frames[0].number, late.frames[0].number);
}

TEST(ExchangeMotion, StreamsAreDecoded) {
  const auto clip = fap::read_text(data_file("fap/plain.fap"));
  ASSERT_TRUE(clip);
  const auto stream = fba::encode(*clip, {});
  ASSERT_TRUE(stream) << stream.error().describe();
  const auto motion = read_motion(*stream);
  ASSERT_TRUE(motion) << motion.error().describe();
  EXPECT_EQ(motion->kind, FileKind::fba_stream);
  EXPECT_EQ(motion->stream, *stream);
  EXPECT_EQ(motion->face.frames.size(), clip->frames.size());
  EXPECT_EQ(motion->decoded.planes.size(), clip->frames.size());
}

TEST(ExchangeMotion, TablesAreToldByTheirHeader) {
  const auto faps = read_any_table(data_file("grid_s1_sample/fap/bbbf9a.csv"));
  ASSERT_TRUE(faps) << faps.error().describe();
  EXPECT_EQ(faps->clip.rate, (fap::Rate{25, 1}));
  const auto shapes = read_any_table("time_s,jawOpen,x,jawLeft\n0,0,0,0\n0.04,1,0,0\n");
  ASSERT_TRUE(shapes) << shapes.error().describe();
  EXPECT_EQ(shapes->clip.frames[1].value[3], 1360);
  EXPECT_THAT(shapes->warnings, ElementsAre(HasSubstr("ignored: x")));
  const auto points = read_any_table(test::openface(4));
  ASSERT_TRUE(points) << points.error().describe();
  EXPECT_EQ(points->clip.frames.size(), 4U);
  const auto motion = read_motion(bytes(test::openface(4)));
  ASSERT_TRUE(motion) << motion.error().describe();
  EXPECT_EQ(fap::write_text(motion->face), fap::write_text(points->clip));
}

TEST(ExchangeMotion, CurvesAreReadBack) {
  const auto signal = dam::read_curves(data_file("grid_s1_sample/fap/bbbf9a.csv"));
  ASSERT_TRUE(signal);
  std::string text = write_curve_header(signal->names);
  for (std::size_t i = 0; i < signal->frames(); ++i) text += write_curve_row(*signal, i);
  const auto back = dam::read_curves(text);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->names, signal->names);
  ASSERT_EQ(back->frames(), signal->frames());
  EXPECT_NEAR(back->at(3, 0), signal->at(3, 0), 1e-3);
}

TEST(ExchangeMotion, WhatHoldsNoMotion) {
  const struct {
    std::string text;
    Code code;
    const char* what;
  } cases[] = {
      {"", Code::truncated, "empty"},
      {"ANIMEDAM", Code::syntax, "contains no face"},
      {"start_s\tend_s\tphone\n0\t1\tAA\n", Code::syntax, "contains no face"},
      {"#EXTM3U\n", Code::unsupported, "container"},
      {"time_s\n", Code::not_found, "no control"},
  };
  for (const auto& one : cases) {
    const auto motion = read_motion(bytes(one.text));
    ASSERT_FALSE(motion) << one.text;
    EXPECT_EQ(motion.error().code, one.code) << one.text << motion.error().describe();
    EXPECT_THAT(motion.error().message, HasSubstr(one.what)) << one.text;
  }
  EXPECT_FALSE(decode_motion({}));
}

}  // namespace motion_test
}  // namespace animeme::exchange
