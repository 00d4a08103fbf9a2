// `animeme plot`: pictures of curves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "fap/text.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme {
namespace plot_test {

using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

void write_clip(const std::string& path, int frames, int height) {
  fap::Sequence clip{{25, 1}, {}, "clip"};
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, i % 2 == 0 ? 0 : height);
    clip.frames.push_back(frame);
  }
  spill(path, fap::write_text(clip));
}

std::int64_t count(const std::string& text, const std::string& part) {
  std::int64_t n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

TEST(Plot, OneRowAFapByNumberOrName) {
  const TempDir dir;
  write_clip(dir / "a.fap", 50, 200);
  const auto out = animeme({"plot", dir / "a.fap", "--faps", "open_jaw,5", "-o", "-"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(count(out.out, "<polyline"), 1) << "FAP 5 is not in the clip";
  EXPECT_THAT(out.out, HasSubstr(">raise_b_midlip, absent<"));
  EXPECT_THAT(out.out, HasSubstr("FAP 3"));
  EXPECT_THAT(out.out, HasSubstr("FAP 5"));
  EXPECT_THAT(out.out, HasSubstr(">200<"));  // the scale of the first row
  EXPECT_THAT(out.out, HasSubstr(">1/1024 MNS<"));
  const auto range = animeme({"plot", dir / "a.fap", "--faps", "3-5,head_pitch", "-o", "-"});
  ASSERT_EQ(range.exit_code, 0) << range.err;
  EXPECT_EQ(count(range.out, "<polyline"), 1);
  EXPECT_EQ(count(range.out, ">FAP "), 4);
  EXPECT_THAT(range.out, HasSubstr(">degrees<"));
}

TEST(Plot, ShortClipsFillThePictureAndNarrowPhonesHaveNoName) {
  const TempDir dir;
  write_clip(dir / "a.fap", 6, 200);  // 0.24 s
  spill(dir / "a.tsv", "start_s\tend_s\tphone\n0\t0.002\tEH\n0.002\t0.1\tAA\n0.1\t0.24\tS\n");
  const auto out =
      animeme({"plot", dir / "a.fap", "--faps", "3", "--script", dir / "a.tsv", "-o", "-"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"784.0\""));
  EXPECT_THAT(out.out, HasSubstr(">0.05<"));
  EXPECT_THAT(out.out, HasSubstr(">AA<"));
  EXPECT_THAT(out.out, Not(HasSubstr(">EH<")));
  EXPECT_EQ(count(out.out, "<rect"), 4);  // ground and three bands
}

TEST(Plot, HighLevelFapsAreShownAsTheHeadShowsThem) {
  const auto out =
      animeme({"plot", std::string(test::kSourceFolder) + "/tests/data/fap/high_level.fap",
               "--faps", "3", "-o", "-"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("150.0,93.9 450.0,33.5 "));
}

TEST(Plot, RefusesWhatItCannotDraw) {
  const TempDir dir;
  write_clip(dir / "a.fap", 50, 200);
  const auto name = animeme({"plot", dir / "a.fap", "-o", dir / "a.jpg"});
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_THAT(name.err, HasSubstr(".svg, .pdf or .png"));
  const auto part = animeme({"plot", dir / "a.fap", "--from", "1", "--to", "0.5", "-o", "-"});
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_THAT(part.err, HasSubstr("--to"));
}

TEST(Plot, TheDifferenceHasItsOwnRow) {
  const TempDir dir;
  write_clip(dir / "a.fap", 50, 200);
  write_clip(dir / "b.fap", 50, 170);
  const auto out =
      animeme({"plot", dir / "a.fap", dir / "b.fap", "--faps", "3", "--difference", "-o", "-"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_EQ(count(out.out, "<polyline"), 3);
  // At its largest 30 of the 250 units, 86 pixels, that both rows show below its 0.
  EXPECT_THAT(out.out, HasSubstr("150.0,198.8 162.0,209.1"));
  EXPECT_EQ(animeme({"plot", dir / "a.fap", "--difference", "-o", "-"}).exit_code, 2);
}

TEST(Plot, APartOfALongClip) {
  const TempDir dir;
  write_clip(dir / "a.fap", 25 * 700, 100);
  const auto whole = animeme({"plot", dir / "a.fap", "-o", dir / "a.svg"});
  EXPECT_EQ(whole.exit_code, 3);
  EXPECT_THAT(whole.err, HasSubstr("--from"));
  const auto part =
      animeme({"plot", dir / "a.fap", "--faps", "3", "--from", "600", "--to", "602", "-o", "-"});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  EXPECT_THAT(part.out, HasSubstr(">600.0<"));
  EXPECT_THAT(part.out, HasSubstr(">602.0<"));
  EXPECT_THAT(part.out, Not(HasSubstr(">599.5<")));
}

TEST(Plot, PngByItsName) {
  const TempDir dir;
  write_clip(dir / "a.fap", 50, 200);
  const auto out = animeme({"plot", dir / "a.fap", "-o", dir / "a.png"});
  if (out.exit_code != 0 && out.err.find("FFmpeg cannot") != std::string::npos) {
    GTEST_SKIP() << out.err;
  }
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(slurp(dir / "a.png"), StartsWith("\x89PNG"));
}

TEST(Plot, ForPapers) {
  const TempDir dir;
  write_clip(dir / "a.fap", 50, 200);
  const auto column = animeme({"plot", dir / "a.fap", "--faps", "3", "--width", "85", "--title",
                               "One jaw", "--spectrum", "-o", "-"});
  ASSERT_EQ(column.exit_code, 0) << column.err;
  EXPECT_THAT(column.out, HasSubstr("width=\"85mm\""));
  EXPECT_THAT(column.out, HasSubstr(">One jaw<"));
  EXPECT_THAT(column.out, HasSubstr(">Frequency (Hz)<"));
  EXPECT_EQ(count(column.out, "<polyline"), 2);
  const auto pdf = animeme({"plot", dir / "a.fap", "--width", "85", "-o", dir / "a.pdf"});
  ASSERT_EQ(pdf.exit_code, 0) << pdf.err;
  EXPECT_THAT(slurp(dir / "a.pdf"), StartsWith("%PDF-1.4"));
  const auto slide = animeme({"plot", dir / "a.fap", "--size", "960x540", "-o", "-"});
  ASSERT_EQ(slide.exit_code, 0) << slide.err;
  EXPECT_THAT(slide.out, HasSubstr("width=\"960.0\" height=\"540.0\""));
  const auto low =
      animeme({"plot", dir / "a.fap", "--faps", "3-30", "--size", "960x200", "-o", "-"});
  EXPECT_EQ(low.exit_code, 2);
  EXPECT_THAT(low.err, HasSubstr("they need a height of"));
  EXPECT_EQ(animeme({"plot", dir / "a.fap", "--size", "960", "-o", "-"}).exit_code, 2);
  EXPECT_EQ(
      animeme({"plot", dir / "a.fap", "--width", "85", "--size", "960x540", "-o", "-"}).exit_code,
      2);
}

TEST(Plot, UnknownFapsAreNamed) {
  const TempDir dir;
  write_clip(dir / "a.fap", 5, 200);
  for (const char* name : {"open_jaws", "2", "69", "-3", "3x", "5-3", "3-", "3-70"}) {
    const auto out = animeme({"plot", dir / "a.fap", "--faps=" + std::string(name), "-o", "-"});
    EXPECT_EQ(out.exit_code, 2) << name;
    EXPECT_THAT(out.err, HasSubstr("is not a FAP")) << name;
  }
}

}  // namespace plot_test
}  // namespace animeme
