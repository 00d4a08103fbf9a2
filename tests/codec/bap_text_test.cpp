// BAP text: what is written reads back, what real programs write is understood, damage is an error
// with a place, and the reference files read like a plain reader reads them.
#include "codec/text/bap_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/decode/decoder.h"
#include "tests/support/body_frame.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme::fba {
namespace bap_text_test {

using test::body_frame;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kStandard = 186;

std::string mask(std::initializer_list<int> baps, int flags = kStandard) {
  std::string line;
  for (int bap = 1; bap <= flags; ++bap) {
    const bool set = std::find(baps.begin(), baps.end(), bap) != baps.end();
    line += (bap == 1 ? "" : " ") + std::string(set ? "1" : "0");
  }
  return line;
}

struct Read {
  BodySequence body;
  std::vector<std::string> warnings;
};
Read read(const std::string& text) {
  Read out;
  auto body = read_bap_text(text, &out.warnings);
  EXPECT_TRUE(body) << body.error().describe();
  if (body) out.body = *body;
  return out;
}

Error refuses(const std::string& text) {
  auto body = read_bap_text(text);
  EXPECT_FALSE(body) << text;
  return body ? Error{} : body.error();
}

TEST(BapText, PlainFile) {
  const auto [body, warnings] =
      read("3.1 clip 25 2\n" + mask({1, 186}) + "\n0 100 -7\n" + mask({181}) + "\n1 2147483647\n");
  EXPECT_EQ(body.name, "clip");
  EXPECT_EQ(body.rate, (fap::Rate{25, 1}));
  EXPECT_THAT(body.frames, ElementsAre(body_frame(0, {{1, 100}, {186, -7}}),
                                       body_frame(1, {{181, 2147483647}})));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(BapText, WritesTheShorterMaskWhereItCan) {
  const BodySequence standard{{25, 1}, {body_frame(3, {{186, -5}})}, "a b"};
  EXPECT_EQ(write_bap_text(standard), "3.1 a_b 25 1\n" + mask({186}) + "\n3 -5\n");
  const BodySequence extended{{25, 2}, {body_frame(0, {{187, 5}}), body_frame(1, {})}, ""};
  EXPECT_EQ(write_bap_text(extended),
            "3.2 clip 12.5 2\n" + mask({187}, 296) + "\n0 5\n" + mask({}, 296) + "\n1\n");
}

TEST(BapText, ReadsBackEqual) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    test::Random random(seed);
    BodySequence body{random.chance(50) ? fap::Rate{25, 1} : fap::Rate{30000, 1001}, {}, "random"};
    const int highest = random.chance(50) ? kStandard : kBapCount;
    std::int64_t number = random.range(0, 3);
    for (int i = random.range(0, 20); i > 0; --i) {
      BodyFrame& one = body.frames.emplace_back();
      one.number = number;
      number += random.chance(20) ? random.range(1, 1000) : 1;
      const int density = random.range(0, 100);
      for (int bap = 1; bap <= highest; ++bap) {
        if (!random.chance(density)) continue;
        one.mask.set(std::size_t(bap));
        one.value[std::size_t(bap)] = random.range(-100000, 100000);
      }
    }
    const std::string text = write_bap_text(body);
    const auto [again, warnings] = read(text);
    ASSERT_EQ(again, body) << text;
    ASSERT_THAT(warnings, IsEmpty()) << text;
    ASSERT_EQ(write_bap_text(again), text);
  }
}

TEST(BapText, CommentsTabsLineEndsAndBlanksInTheName) {
  std::string flags = mask({2});
  std::replace(flags.begin(), flags.end(), ' ', '\t');
  const auto [body, warnings] = read("# one\r\n\r\n3.1 my body clip 12.5 1\r\n# two\r\n" + flags +
                                     "\t\r\n#three\r\n\t0 \t 42 # four");
  EXPECT_EQ(body.name, "my body clip");
  EXPECT_EQ(body.rate, (fap::Rate{25, 2}));
  EXPECT_THAT(body.frames, ElementsAre(body_frame(0, {{2, 42}})));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("line 3: the name contains blanks")));
}

TEST(BapText, QuirksAreToldWithTheirLine) {
  // Wrong count, a rounded value, a repeated number, and numbers that go back.
  const std::string m = mask({1}) + "\n";
  const auto [body, warnings] =
      read("3.1 x 25 9\n" + m + "5 1.5\n" + m + "5 7\n" + m + "8 3\n" + m + "2 4\n");
  EXPECT_THAT(body.frames, ElementsAre(body_frame(5, {{1, 7}}), body_frame(8, {{1, 3}}),
                                       body_frame(9, {{1, 4}})));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("line 1: the header says 9 frames, the text has 4"),
                                    HasSubstr("line 3: the value '1.5' is rounded"),
                                    HasSubstr("line 5: frame number 5 comes again"),
                                    HasSubstr("line 9: frame number 2 comes after 8")));
}

TEST(BapText, TheFirstMaskTellsTheLength) {
  for (const bool is_long : {false, true}) {
    const int flags = is_long ? kBapCount : kStandard;
    const std::string rows = mask({2}, flags) + "\n0 42\n" + mask({}, flags) + "\n1\n";
    const auto [body, warnings] = read((is_long ? "3.1 x 25 2\n" : "3.2 x 25 2\n") + rows);
    EXPECT_THAT(body.frames, ElementsAre(body_frame(0, {{2, 42}}), body_frame(1, {})));
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("line 2: a mask has " + std::to_string(flags))));
    // Another version and no header at all.
    EXPECT_EQ(read("4.0 x 25 2\n" + rows).body.frames, body.frames);
    EXPECT_EQ(read(rows).body.frames, body.frames);
  }
}

TEST(BapText, MasksAndValuesWhereverTheLinesEnd) {
  const auto want = ElementsAre(body_frame(0, {{1, 4}, {2, 5}}), body_frame(1, {{1, 6}, {2, 7}}));
  const std::string m = mask({1, 2});
  // A flag too many, all in one line, wrapped masks and values.
  EXPECT_THAT(read("3.1 x 25 2\n" + m + " 0\n0 4 5\n" + m + " 0\n1 6 7\n").body.frames, want);
  EXPECT_THAT(read("3.1 x 25 2\n" + m + " 0 4 5\n" + m + " 1 6 7\n").body.frames, want);
  const std::string wrapped = m.substr(0, 100) + "\n" + m.substr(100);
  EXPECT_THAT(read("3.1 x 25 2\n" + wrapped + "\n0 4\n5\n" + wrapped + "\n1\n6 7\n").body.frames,
              want);
}

TEST(BapText, WhatIsNoBapText) {
  const auto says = [](const std::string& text, Code code, const char* message) {
    const Error error = refuses(text);
    EXPECT_EQ(error.code, code) << error.describe();
    EXPECT_THAT(error.describe(), HasSubstr(message));
  };
  says("", Code::truncated, "empty");
  says("2.1 clip 25 1\n", Code::unsupported, "line 1: version 2.1 is FAP text and not BAP text");
  says("FBM 2\n", Code::unsupported, "encoder parameter file (EPF) and not BAP text");
  says(std::string("\0\0\1\xBA", 4), Code::unsupported, "binary FBA stream");
  says("hello", Code::syntax, "line 1:1: the first line has to be");
  says("3.1 x 25 1\n0 0 1\n0 5\n", Code::syntax,
       "line 3:3: a mask value has to be 0 or 1, but BAP 5 has '5'");
  says("3.1 x 25 1\n" + mask({1}) + "\n", Code::truncated, "1 value are missing");
  says("3.1 x 25 1\n" + mask({1, 2}) + "\n0 5\n" + mask({}), Code::syntax,
       "line 3:4: the line has 1 value after the frame number, the mask requires 2");
  says("3.1 x 25 1\n" + mask({1}) + "\n0 word\n", Code::syntax, "line 3:3: 'word' is not a number");
  says("3.1 x 25 1\n" + mask({1}) + "\n0 3e9\n", Code::out_of_range, "line 3:3: the value '3e9'");
  says("3.1 x 25 1\n" + mask({1}) + "\n1e16 3\n", Code::out_of_range, "line 3:1: the frame number");
}

TEST(BapText, SurvivesDamage) {
  const std::string good = "# c\n" + write_bap_text({{25, 1},
                                                     {body_frame(0, {{1, 5}, {186, -70000}}),
                                                      body_frame(7, {{200, 9}}), body_frame(8, {})},
                                                     "clip"});
  const auto survive = [](const std::string& text) {
    auto body = read_bap_text(text);
    if (!body) {
      ASSERT_FALSE(body.error().message.empty());
      ASSERT_GT(body.error().where.line, 0);
      return;
    }
    auto again = read_bap_text(write_bap_text(*body));
    ASSERT_TRUE(again) << again.error().describe();
    ASSERT_EQ(again->frames, body->frames);
  };
  ASSERT_EQ(read(good).body.frames.size(), 3u);
  for (std::size_t at = 0; at <= good.size(); ++at) {
    survive(good.substr(0, at));
    for (const char byte : {'\0', ' ', '\n', '#', '9', '-', '\xff'}) {
      std::string changed = good;
      if (at < good.size()) changed[at] = byte;
      survive(changed);
    }
  }
}

TEST(BapText, ReferenceFilesReadAsAPlainReaderReadsThem) {
  int files = 0;
  for (const auto& stream : test::reference_streams()) {
    for (const char* extension : {".src.bap", ".dec.bap"}) {
      if (!std::filesystem::exists(test::with(stream, extension))) continue;
      ++files;
      const std::string text = test::slurp(test::with(stream, extension));
      const auto [body, warnings] = read(text);
      EXPECT_THAT(warnings, IsEmpty());
      EXPECT_EQ(body.name, stream.filename().string());
      const auto plain = test::read_bap(text);
      ASSERT_FALSE(plain.empty());
      EXPECT_EQ(body.frames, plain) << stream << extension;
      EXPECT_EQ(read(write_bap_text(body)).body, body);
    }
  }
  EXPECT_GE(files, 8);
}

TEST(BapText, BodyOfAStream) {
  for (const auto& stream : test::reference_streams()) {
    auto decoded = decode(test::read_bytes(test::with(stream, ".fba")));
    ASSERT_TRUE(decoded) << decoded.error().describe();
    const BodySequence body = body_sequence(*decoded);
    EXPECT_EQ(body.rate, decoded->rate);
    const auto expected = test::with(stream, ".dec.bap");
    if (std::filesystem::exists(expected)) {
      EXPECT_EQ(body.frames, test::read_bap(test::slurp(expected))) << stream;
    } else {
      EXPECT_THAT(body.frames, IsEmpty()) << stream;
    }
  }
}

}  // namespace bap_text_test
}  // namespace animeme::fba
