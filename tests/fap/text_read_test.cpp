#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fap/text.h"
#include "tests/fap/in_pieces.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace text_read_test {

using made::make_frame;
using made::mask_line;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Read {
  Sequence clip;
  std::vector<std::string> warnings;
};

Read read(const std::string& text, const ReadTextOptions& options = {}) {
  Read result;
  Result<Sequence> clip = read_text(text, options, &result.warnings);
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().describe()) << "\n" << text;
  in_pieces::expect_as_whole(text, options);
  if (clip) result.clip = *std::move(clip);
  return result;
}

Error error_of(const std::string& text, const ReadTextOptions& options = {}) {
  Result<Sequence> clip = read_text(text, options);
  EXPECT_FALSE(clip) << text;
  in_pieces::expect_as_whole(text, options);
  return clip ? Error{} : clip.error();
}

const std::string kMask = mask_line({3, 4});

// A frame with FAP 3 and 4.
std::string frame_text(const std::string& values) { return kMask + "\n" + values + "\n"; }

Sequence two_frames() {
  return {
      {25, 1}, {make_frame(0, {{3, 100}, {4, -20}}), make_frame(1, {{3, 120}, {4, -25}})}, "clip"};
}

const std::string kTwoFrames =
    "2.1 clip 25 2\n" + frame_text("0 100 -20") + frame_text("1 120 -25");

TEST(ReadText, PlainFile) {
  const Read r = read(kTwoFrames);
  EXPECT_EQ(r.clip, two_frames());
  EXPECT_THAT(r.warnings, IsEmpty());
}

TEST(ReadText, LegalVariantsAreSilent) {
  std::string crlf;
  std::string tabs;
  for (const char c : kTwoFrames) {
    if (c == '\n') crlf += '\r';
    crlf += c;
    tabs += c == ' ' ? "\t" : c == '\n' ? " \t\n\n" : std::string(1, c);
  }
  std::string old_mac = kTwoFrames;
  for (char& c : old_mac) c = c == '\n' ? '\r' : c;
  const std::string commented = "# first\n\n2.1 clip 25 2 # header\n" + kMask +
                                " # between\n   # more\n\n0 100 -20 # values\n" +
                                frame_text("1 120 -25") + "#end";
  const std::string no_newline = kTwoFrames.substr(0, kTwoFrames.size() - 1);
  for (const std::string& text : {crlf, tabs, old_mac, commented, no_newline}) {
    const Read r = read(text);
    EXPECT_EQ(r.clip, two_frames()) << text;
    EXPECT_THAT(r.warnings, IsEmpty());
  }
}

TEST(ReadText, HighLevelFaps) {
  const Read r = read("2.2 x 25 1\n" + mask_line({1, 2, 3}) + "\n0 5 6 33 1 1 40 6 63 0 1 77\n");
  ASSERT_EQ(r.clip.frames.size(), 1u);
  const Frame& frame = r.clip.frames[0];
  EXPECT_EQ(frame.viseme, (Viseme{5, 6, 33, true}));
  EXPECT_EQ(frame.expression, (Expression{1, 40, 6, 63, false, true}));
  EXPECT_EQ(frame.value[3], 77);
  EXPECT_EQ(frame.mask.count(), 3u);
  EXPECT_THAT(r.warnings, IsEmpty());
}

TEST(ReadText, HighLevelValuesOutOfRangeAreKept) {
  const Read r = read("2.1 x 25 1\n" + mask_line({1}) + "\n0 15 -1 64 2\n");
  EXPECT_EQ(r.clip.frames.at(0).viseme, (Viseme{15, -1, 64, true}));
  EXPECT_THAT(r.warnings, ElementsAre("line 3: a value of FAP 1 or 2 is 15, allowed are 0 to 14 "
                                      "(and in 3 more places)"));
}

TEST(ReadText, SingleHighLevelValues) {
  const Read viseme =
      read("2.1 x 25 2\n" + mask_line({1, 3}) + "\n0 7 55\n" + mask_line({1, 3}) + "\n1 8 56\n");
  ASSERT_EQ(viseme.clip.frames.size(), 2u);
  EXPECT_EQ(viseme.clip.frames[0].viseme, (Viseme{7, 0, 63, false}));
  EXPECT_EQ(viseme.clip.frames[1].value[3], 56);
  EXPECT_THAT(viseme.warnings, ElementsAre(HasSubstr("line 3: FAP 1 or 2 has a single value")));

  const Read both = read("2.1 x 25 1\n" + mask_line({1, 2}) + "\n0 7 3\n");
  EXPECT_EQ(both.clip.frames.at(0).expression, (Expression{3, 63, 0, 0, false, false}));
}

TEST(ReadText, NamesAndVersions) {
  const std::string frame = frame_text("0 1 2");
  EXPECT_EQ(read("2.1 C:\\tmp\\x.fap 25 1\n" + frame).clip.name, "C:\\tmp\\x.fap");
  EXPECT_EQ(read("2.1 25 25 1\n" + frame).clip.name, "25");

  const Read blanks = read("2.1 AU Inter  polation_2.fap 25 1\n" + frame);
  EXPECT_EQ(blanks.clip.name, "AU Inter  polation_2.fap");
  EXPECT_THAT(blanks.warnings, ElementsAre(HasSubstr("line 1: the name contains blanks")));

  const Read hash = read("2.1 take #3 25 1\n" + frame);
  EXPECT_EQ(hash.clip.name, "take #3");
  EXPECT_EQ(read("2.1 take 25 1 # 3 4\n" + frame).clip.name, "take");

  const Read none = read("2.1 25 1\n" + frame);
  EXPECT_EQ(none.clip.name, "");
  EXPECT_EQ(none.clip.rate, (Rate{25, 1}));
  EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("no name")));

  const Read version = read("2.7 x 25 1\n" + frame);
  EXPECT_THAT(version.warnings, ElementsAre(HasSubstr("version '2.7' is not known")));
  EXPECT_EQ(version.clip.frames.at(0).value[3], 1);
}

TEST(ReadText, OldVersionIsNotScaled) {
  const Read r = read("2.0 x 25 1\n" + frame_text("0 1080 20"));
  EXPECT_EQ(r.clip.frames.at(0).value[3], 1080);
  EXPECT_THAT(r.warnings, IsEmpty());
}

TEST(ReadText, Rates) {
  const std::string frame = frame_text("0 1 2");
  EXPECT_EQ(read("2.1 x 12.5 1\n" + frame).clip.rate, (Rate{25, 2}));
  EXPECT_EQ(read("2.1 x 29.97 1\n" + frame).clip.rate, (Rate{30000, 1001}));
  const Read zero = read("2.1 x 0 1\n" + frame, {.default_rate = {30, 1}});
  EXPECT_EQ(zero.clip.rate, (Rate{30, 1}));
  EXPECT_THAT(zero.warnings, ElementsAre("line 1: the header has rate 0, 30 frames a second are "
                                         "assumed"));
}

TEST(ReadText, WrongOrMissingCount) {
  for (const char* count : {"1", "5", "-1", "2000000000", "1e300", "99999999999999999999999"}) {
    std::string text = kTwoFrames;
    text.replace(text.find("25 2") + 3, 1, count);
    const Read r = read(text);
    EXPECT_EQ(r.clip, two_frames());
    EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("the text has 2"))) << count;
  }
  const Read none = read("2.1 clip 25\n" + kTwoFrames.substr(kTwoFrames.find('\n') + 1));
  EXPECT_EQ(none.clip, two_frames());
  EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("no frame count")));
}

TEST(ReadText, EmptyClip) {
  const Read r = read("2.1 empty 25 0\n");
  EXPECT_TRUE(r.clip.frames.empty());
  EXPECT_THAT(r.warnings, IsEmpty());
}

TEST(ReadText, SixtyNineFlags) {
  const std::string text = "2.1 x 25 2\n" + kMask + " 0\n0 5 6\n" + kMask + " 1\n1 7 8\n";
  const Read r = read(text);
  ASSERT_EQ(r.clip.frames.size(), 2u);
  EXPECT_EQ(r.clip.frames[1].value[4], 8);
  EXPECT_THAT(r.warnings, ElementsAre("line 2: a mask has 69 values, the last one is ignored (and "
                                      "in 1 more place)"));
  // With an empty mask the number of the frame could be meant: the next line tells.
  const std::string empty = mask_line({});
  EXPECT_EQ(read("2.1 x 25 2\n" + empty + " 0\n0\n" + empty + " 0\n1\n").clip.frames.size(), 2u);
  const Read one_line = read("2.1 x 25 2\n" + empty + " 0\n" + empty + " 1\n");
  ASSERT_EQ(one_line.clip.frames.size(), 2u);
  EXPECT_EQ(one_line.clip.frames[1].number, 1);
}

TEST(ReadText, AllOnOneLine) {
  const Read lines = read("2.1 clip 25 2\n" + kMask + " 0 100 -20\n" + kMask + " 1 120 -25\n");
  EXPECT_EQ(lines.clip, two_frames());
  EXPECT_THAT(lines.warnings, ElementsAre(HasSubstr("line 2: the values are on the line")));
  const Read line = read("2.1 clip 25 2\n" + kMask + " 0 100 -20 " + kMask + " 1 120 -25\n");
  EXPECT_EQ(line.clip, two_frames());
}

TEST(ReadText, WrappedLines) {
  std::string mask = kMask;
  mask[mask.size() / 2] = '\n';
  ASSERT_EQ(kMask[kMask.size() / 2], ' ') << "the mask has to be cut between two flags";
  const Read r = read("2.1 clip 25 2\n" + mask + "\n0\n100\n-20\n" + frame_text("1 120 -25"));
  EXPECT_EQ(r.clip, two_frames());
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("line 2: a mask continues"),
                                      HasSubstr("line 4: the values of a frame continue")));
}

TEST(ReadText, RoundsFractions) {
  const Read r = read("2.1 x 25 2\n" + frame_text("0 1.5 -1.5") + frame_text("1.0 1e2 +7"));
  ASSERT_EQ(r.clip.frames.size(), 2u);
  EXPECT_EQ(r.clip.frames[0].value[3], 2);
  EXPECT_EQ(r.clip.frames[0].value[4], -2);
  EXPECT_EQ(r.clip.frames[1].value[3], 100);
  EXPECT_EQ(r.clip.frames[1].value[4], 7);
  EXPECT_THAT(r.warnings, ElementsAre("line 3: the value '1.5' is rounded to an integer (and in 1 "
                                      "more place)"));
}

TEST(ReadText, ValueRange) {
  const Read r = read("2.1 x 25 1\n" + frame_text("0 2147483647 -2147483648"));
  EXPECT_EQ(r.clip.frames.at(0).value[3], INT32_MAX);
  EXPECT_EQ(r.clip.frames.at(0).value[4], INT32_MIN);
  for (const char* value : {"2147483648", "-2147483649", "1e12", "1e999", "99999999999999999999"}) {
    const Error e = error_of("2.1 x 25 1\n" + frame_text("0 1 " + std::string(value)));
    EXPECT_EQ(e.code, Code::out_of_range) << value;
    EXPECT_EQ(e.where.line, 3);
    EXPECT_EQ(e.where.column, 5);
  }
}

TEST(ReadText, NoHeader) {
  const std::string body = frame_text("0 100 -20") + frame_text("1 120 -25");
  for (const std::string& text : {body, "280\n" + body}) {
    const Read found = read(text);
    EXPECT_EQ(found.clip.frames, two_frames().frames);
    EXPECT_EQ(found.clip.rate, (Rate{25, 1}));
    EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("line 1: there is no header")));
    const Read asked = read(text, {.headerless = true, .default_rate = {50, 1}});
    EXPECT_EQ(asked.clip.frames, two_frames().frames);
    EXPECT_EQ(asked.clip.rate, (Rate{50, 1}));
    EXPECT_THAT(asked.warnings, IsEmpty());
  }
  EXPECT_EQ(error_of("2.1 clip 25 1\n" + body, {.headerless = true}).code, Code::syntax);
}

TEST(ReadText, ByteOrderMark) {
  const Read r = read("\xef\xbb\xbf" + kTwoFrames);
  EXPECT_EQ(r.clip, two_frames());
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("byte order mark")));
}

std::vector<std::int64_t> numbers(const Sequence& clip) {
  std::vector<std::int64_t> result;
  for (const Frame& frame : clip.frames) result.push_back(frame.number);
  return result;
}

Read read_numbers(std::initializer_list<const char*> list, const ReadTextOptions& options = {}) {
  std::string text = "2.1 x 25 " + std::to_string(list.size()) + "\n";
  int value = 0;
  for (const char* number : list) {
    text += frame_text(std::string(number) + " " + std::to_string(value) + " 0");
    ++value;
  }
  return read(text, options);
}

TEST(ReadText, FrameNumbers) {
  const Read gaps = read_numbers({"0", "3", "4"});
  EXPECT_THAT(numbers(gaps.clip), ElementsAre(0, 3, 4));
  EXPECT_THAT(gaps.warnings, IsEmpty());

  const Read offset = read_numbers({"320", "321", "325"});
  EXPECT_THAT(numbers(offset.clip), ElementsAre(0, 1, 5));
  EXPECT_THAT(offset.warnings, ElementsAre(HasSubstr("line 3: the frame numbers start at 320")));

  const Read kept = read_numbers({"320", "321", "325"}, {.keep_numbers = true});
  EXPECT_THAT(numbers(kept.clip), ElementsAre(320, 321, 325));
  EXPECT_THAT(kept.warnings, IsEmpty());

  const Read negative = read_numbers({"-2", "-1", "0"});
  EXPECT_THAT(numbers(negative.clip), ElementsAre(0, 1, 2));

  const Read restart = read_numbers({"0", "1", "0", "1", "3"});
  EXPECT_THAT(numbers(restart.clip), ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(restart.warnings, ElementsAre("line 7: frame number 0 comes after 1, the numbering "
                                            "goes on behind it"));

  const Read constant = read_numbers({"7", "7", "7"});
  EXPECT_THAT(numbers(constant.clip), ElementsAre(0, 1, 2));
  EXPECT_EQ(constant.clip.frames[2].value[3], 2);
  EXPECT_THAT(constant.warnings, ElementsAre(HasSubstr("all frames have the same number")));
}

TEST(ReadText, RepeatedNumbersMerge) {
  const Read r = read("2.1 x 25 3\n" + frame_text("0 1 2") + mask_line({4, 5}) + "\n0 8 9\n" +
                      frame_text("1 3 4"));
  ASSERT_EQ(r.clip.frames.size(), 2u);
  EXPECT_EQ(r.clip.frames[0], make_frame(0, {{3, 1}, {4, 8}, {5, 9}}));
  EXPECT_EQ(r.clip.frames[1], make_frame(1, {{3, 3}, {4, 4}}));
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("line 5: frame number 0 comes again")));
}

TEST(ReadText, HugeFrameNumbers) {
  EXPECT_THAT(numbers(read_numbers({"0", "1000000000000000"}).clip),
              ElementsAre(0, 1000000000000000));
  EXPECT_EQ(error_of("2.1 x 25 1\n" + frame_text("1000000000000001 0 0")).code, Code::out_of_range);
  // Each restart would push the numbers further.
  std::string text = "2.1 x 25 9\n";
  for (int i = 0; i < 9; ++i) {
    text += frame_text("-1000000000000000 0 0") + frame_text("1000000000000000 0 0");
  }
  EXPECT_EQ(error_of(text).code, Code::out_of_range);
}

TEST(ReadText, ErrorsTellWhere) {
  struct Case {
    std::string text;
    Code code;
    std::int64_t line;
    std::int64_t column;
    std::string message;
  };
  const std::string header = "2.1 x 25 1\n";
  const std::int64_t mask_end = std::int64_t(kMask.size()) + 1;
  const std::vector<Case> cases = {
      {"", Code::truncated, 1, 0, "the text is empty"},
      {"# nothing\n\n", Code::truncated, 3, 0, "the text is empty"},
      {"hello world\n", Code::syntax, 1, 1, "starts with 'hello'"},
      {" \x01\x02 25 1\n", Code::syntax, 1, 2, "starts with '\?\?'"},
      {"2.1 x\n" + frame_text("0 1 2"), Code::syntax, 1, 5, "the frame rate is missing"},
      {"2.1\n" + frame_text("0 1 2"), Code::syntax, 1, 1, "the frame rate is missing"},
      {"2.1 x 1/0 1\n", Code::syntax, 1, 7, "is not a frame rate"},
      {"2.1 x 29,97 1\n", Code::syntax, 1, 7,
       "'29,97' is not a frame rate, write 29.97 with a point"},
      {"2.1 29,97 1\n", Code::syntax, 1, 5, "'29,97' is not a frame rate"},
      {"2.1 x 29,97\n", Code::syntax, 1, 7, "write 29.97 with a point"},
      {"2.1 my talk nan 1\n", Code::syntax, 1, 13,
       "'nan' is not a frame rate, write for instance 25, 12.5, 29.97 or 30000/1001"},
      {"2.1 x 1e9 1\n", Code::syntax, 1, 7, "'1e9' is not a frame rate"},
      {"2.1 x -25 1\n", Code::syntax, 1, 7, "'-25' is not a frame rate"},
      {header + kMask.substr(2) + "\n0 1 2\n", Code::syntax, 2, mask_end - 2,
       "the mask has only 67 of 68 values"},
      {header + kMask.substr(2), Code::truncated, 2, mask_end - 2, "67 of 68"},
      {header + "0 0 2 " + kMask.substr(6), Code::syntax, 2, 5, "FAP 3 has '2'"},
      {header + kMask + " 2\n0 1 2\n", Code::syntax, 2, mask_end + 1, "but '2' follows"},
      {header + kMask + "\n0 1\n" + kMask + "\n1 1 2\n", Code::syntax, 3, 4,
       "the line has 1 value after the frame number, the mask requires 2"},
      {header + kMask + "\n0 1\n", Code::truncated, 3, 4, "and the text ends here"},
      {header + kMask + "\n0 1 2 3\n", Code::syntax, 3, 7, "the line has 3 values"},
      {header + kMask + "\n0 1 2x\n", Code::syntax, 3, 5, "'2x' is not a number"},
      {header + kMask + "\n0 1 nan\n", Code::syntax, 3, 5, "'nan' is not a number"},
      {header + kMask + "\n0 1 -inf\n", Code::syntax, 3, 5, "'-inf' is not a number"},
      {header + kMask + "\n0 1 +-5\n", Code::syntax, 3, 5, "'+-5' is not a number"},
      {header + kMask + "\nx 1 2\n", Code::syntax, 3, 1, "'x' is not a number"},
      {header + kMask + "\n", Code::truncated, 3, 0, "the text ends after a mask"},
      {header + frame_text("0 1 2") + header, Code::syntax, 4, 1, "every frame starts with 68"},
  };
  for (const Case& c : cases) {
    const Error e = error_of(c.text);
    EXPECT_EQ(e.code, c.code) << e.describe() << "\n" << c.text;
    EXPECT_EQ(e.where.line, c.line) << e.describe() << "\n" << c.text;
    EXPECT_EQ(e.where.column, c.column) << e.describe() << "\n" << c.text;
    EXPECT_THAT(e.message, HasSubstr(c.message));
  }
}

// With all FAPs a frame has 77 numbers: nine of them and the next mask would be as many.
TEST(ReadText, AMaskIsNoContinuationOfValues) {
  std::string all = mask_line({});
  for (char& c : all) c = c == '0' ? '1' : c;
  const Error e = error_of("2.1 x 25 2\n" + all + "\n0 1 2 3 4 5 6 7 8\n" + all + "\n");
  EXPECT_EQ(e.code, Code::syntax);
  EXPECT_EQ(e.where.line, 3);
}

TEST(ReadText, ForeignFilesAreNamed) {
  const std::pair<std::string, std::string> cases[] = {
      {std::string("\0\0\1\xba\x19\0", 6), "binary FBA stream"},
      {"\xff\xfe\x32", "UTF-16"},
      {"FBM 1\nFFR 0\n", "encoder parameter file"},
      {"<task name=\"UPLOAD_FAP\">", "XML"},
      {"3.1 body 25 1\n", "body animation"},
  };
  for (const auto& [text, message] : cases) {
    const Error e = error_of(text);
    EXPECT_EQ(e.code, Code::unsupported) << e.describe();
    EXPECT_THAT(e.message, HasSubstr(message));
  }
}

TEST(ReadText, RefusesABadDefaultRate) {
  EXPECT_EQ(error_of(kTwoFrames, {.default_rate = {0, 1}}).code, Code::invalid_argument);
}

// Names that look a little like numbers, without a number of frames behind the rate.
TEST(ReadText, NamesOfDigitsAreNames) {
  for (const char* name : {"2026-11-22", "1-2", "scene 25", "1,2,3", "nan"}) {
    const std::string rate = std::string_view(name) == "scene 25" ? "30000/1001" : "25";
    const Read got = read("2.1 " + std::string(name) + " " + rate + "\n" + frame_text("0 1 2"));
    EXPECT_EQ(got.clip.name, name);
  }
}

}  // namespace text_read_test
}  // namespace animeme::fap
