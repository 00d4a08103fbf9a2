#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/text.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace text_write_test {

using made::make_frame;
using made::mask_line;

TEST(WriteText, SafeForm) {
  Sequence clip{{25, 1}, {make_frame(0, {{3, 100}, {68, -7}}), make_frame(2, {})}, "a clip"};
  clip.frames[1].mask.set(1);
  clip.frames[1].mask.set(2);
  clip.frames[1].viseme = {5, 6, 33, true};
  clip.frames[1].expression = {1, 40, 6, 63, false, true};
  EXPECT_EQ(write_text(clip), "2.1 a_clip 25 2\n" + mask_line({3, 68}) + "\n0 100 -7\n" +
                                  mask_line({1, 2}) + "\n2 5 6 33 1 1 40 6 63 0 1\n");
}

TEST(WriteText, Options) {
  const Sequence clip{{30000, 1001}, {make_frame(4, {{3, 1}}), make_frame(9, {{3, 2}})}, "x"};
  const std::string mask = mask_line({3}) + "\n";
  EXPECT_EQ(write_text(clip), "2.1 x 29.97 2\n" + mask + "4 1\n" + mask + "9 2\n");
  EXPECT_EQ(write_text(clip, {.renumber = true, .whole_rate = true}),
            "2.1 x@29.97fps 30 2\n" + mask + "0 1\n" + mask + "1 2\n");
  EXPECT_EQ(write_text({{1, 3}, {}, "x"}, {.whole_rate = true}), "2.1 x@0.3333333fps 1 0\n");
  EXPECT_EQ(write_text({{25, 2}, {}, "x"}, {.whole_rate = true}), "2.1 x@12.5fps 13 0\n");
  EXPECT_EQ(write_text({{25, 1}, {}, "x"}, {.whole_rate = true}), "2.1 x 25 0\n");
  EXPECT_EQ(write_text({{0, 1}, {}, "x"}, {.whole_rate = true}), "2.1 x 0 0\n");
}

TEST(WriteText, WholeRatesKeepTheExactOne) {
  for (const Rate rate : {Rate{30000, 1001}, Rate{24000, 1001}, Rate{25, 2}, Rate{1, 3},
                          Rate{25, 1}, Rate{4294967291u, 4294967279u}}) {
    for (const char* name : {"talk", "a@b", "a@29.97fps", "@30fps", "C:\\faces\\x.fap"}) {
      const Sequence clip{rate, {make_frame(0, {{3, 1}})}, name};
      const std::string text = write_text(clip, {.whole_rate = true});
      std::vector<std::string> warnings;
      const Result<Sequence> again = read_text(text, {}, &warnings);
      ASSERT_TRUE(again) << text;
      EXPECT_EQ(again->rate, rate) << text;
      EXPECT_TRUE(warnings.empty()) << text;
      EXPECT_EQ(write_text(*again, {.whole_rate = true}), text);
      if (std::string(name) != "a@29.97fps") {
        EXPECT_EQ(again->name, name) << text;
      }
    }
  }
}

TEST(WriteText, OnlyTheRateOfTheHeaderIsMadeExact) {
  for (const char* header : {"x@29.97fps 25", "x@30fps 30", "x@29.97 30", "@29.97fps 30",
                             "x@29.97fps 29.97", "x@fps 30", "x@0fps 1"}) {
    const Result<Sequence> clip = read_text("2.1 " + std::string(header) + " 0\n");
    ASSERT_TRUE(clip) << header;
    EXPECT_EQ(clip->name + " ", std::string(header).substr(0, clip->name.size() + 1)) << header;
  }
  // What would be read as an exact rate and is none stays a name.
  const Sequence clip{{30, 1}, {}, "x@29.97fps"};
  EXPECT_EQ(write_text(clip), "2.1 x_29.97fps 30 0\n");
}

TEST(WriteText, LongNamesAreCut) {
  const std::string text =
      write_text({{30000, 1001}, {}, std::string(1000, 'n')}, {.whole_rate = true});
  EXPECT_EQ(text, "2.1 " + std::string(200, 'n') + "@29.97fps 30 0\n");
}

TEST(WriteText, InPieces) {
  const Sequence clip{{25, 1}, {make_frame(0, {{3, 5}}), make_frame(3, {{4, -6}})}, "x"};
  std::string text = text_header(clip.rate, clip.name, 2);
  for (const Frame& frame : clip.frames) append_text(text, frame);
  EXPECT_EQ(text, write_text(clip));
}

TEST(WriteText, NamesAreOneWord) {
  const auto header = [](const char* name) { return write_text({{25, 1}, {}, name}); };
  EXPECT_EQ(header(""), "2.1 clip 25 0\n");
  EXPECT_EQ(header("a\tb\nc d"), "2.1 a_b_c_d 25 0\n");
  EXPECT_EQ(header("#1"), "2.1 _1 25 0\n");
  EXPECT_EQ(header("caf\xc3\xa9"), "2.1 caf\xc3\xa9 25 0\n");
}

TEST(WriteText, ReadsBackEqual) {
  made::Random random(20260101);
  for (int round = 0; round < 200; ++round) {
    const Sequence clip = made::random_sequence(random, int(random.in(0, 40)));
    const std::string text = write_text(clip);
    std::vector<std::string> warnings;
    const Result<Sequence> again = read_text(text, {}, &warnings);
    ASSERT_TRUE(again) << again.error().describe() << "\n" << text;
    ASSERT_EQ(*again, clip) << text;
    ASSERT_TRUE(warnings.empty()) << warnings.front() << "\n" << text;
    ASSERT_EQ(write_text(*again), text);
  }
}

}  // namespace text_write_test
}  // namespace animeme::fap
