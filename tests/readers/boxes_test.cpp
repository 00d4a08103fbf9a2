// The structure of our MP4 files: boxes, tables, edit lists, sync samples.
#include <gmock/gmock.h>

#include "tests/readers/movie_checks.h"

namespace animeme::test {
namespace boxes_test {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

void expect_sound(const Movie& movie, const Talk& talk, const Layout& layout) {
  const MovieTrack* sound = movie.track("soun");
  ASSERT_NE(sound, nullptr);
  EXPECT_EQ(sound->entry, layout.opus() ? "Opus" : "mp4a");
  EXPECT_EQ(sound->shown_at(layout.priming(), movie.timescale), 0) << "priming is not cut off";
  ASSERT_FALSE(sound->samples.empty());
  const MovieSample& last = sound->samples.back();
  const double end = sound->shown_at(last.time + last.duration, movie.timescale);
  // Of what is written as it comes, nobody knows the end.
  const double padding =
      layout.options.fragmented || layout.opus() ? 0.0214 : 1.0 / movie.timescale;
  EXPECT_GE(end, talk.sound.duration() - 1.0 / movie.timescale);
  EXPECT_LE(end, talk.sound.duration() + padding);
}

Talk late_talk() {
  Talk talk = walking_talk(44100);
  for (fba::AccessUnit& unit : talk.face.units) unit.time += 3700;
  return talk;
}

TEST(Boxes, TablesAgreeAndNameEveryByte) {
  const TempDir dir;
  for (const Talk& talk : {walking_talk(), walking_talk(22050), late_talk(),
                           reference_talk("skip_frames"), reference_talk("rate_29_97")}) {
    for (const Layout& layout : mp4_layouts()) {
      SCOPED_TRACE(layout.name);
      const BoxFile file(read_bytes(write_talk(dir, talk, layout)));
      const Movie movie = read_movie(file);
      EXPECT_THAT(movie.errors, IsEmpty());
      EXPECT_EQ(movie.timescale, std::uint32_t(layout.opus() ? 48000 : talk.sound.sample_rate));
      expect_face(file, movie, talk);
      expect_sound(movie, talk, layout);
    }
  }
}

// The checks themselves: each has to fire, or the test above proves nothing.
class BoxesFire : public testing::Test {
 protected:
  // Errors of the file with one byte changed: `offset` bytes into the first box of a path.
  std::vector<std::string> errors(const std::string& path, std::size_t offset,
                                  std::uint8_t change) const {
    const BoxFile file(good_);
    const Box* box = file.root().find(path);
    if (box == nullptr) return {"no " + path};
    Bytes bad = good_;
    bad[box->content() + offset] ^= change;
    return read_movie(BoxFile(bad)).errors;
  }

  TempDir dir_;
  Bytes good_ = read_bytes(write_talk(dir_, walking_talk(), layout_of("mp4")));
};

TEST_F(BoxesFire, OnTables) {
  const std::string table = "moov/trak/mdia/minf/stbl/";
  EXPECT_THAT(errors("moov/mvhd", 99, 0x03), Contains(HasSubstr("next_track_ID")));
  EXPECT_THAT(errors("moov/mvhd", 18, 0xFF), Contains(HasSubstr("longer than the movie")));
  EXPECT_THAT(errors("moov/trak/edts/elst", 11, 1), Contains(HasSubstr("tkhd and elst")));
  EXPECT_THAT(errors("moov/trak/edts/elst", 7, 2), Contains(HasSubstr("elst: size")));
  EXPECT_THAT(errors("moov/trak/mdia/mdhd", 19, 1), Contains(HasSubstr("mdhd and stts")));
  EXPECT_THAT(errors(table + "stts", 11, 1), Contains(HasSubstr("stts: ")));
  EXPECT_THAT(errors(table + "stsz", 11, 1), Contains(HasSubstr("stsz: size")));
  EXPECT_THAT(errors(table + "stsz", 15, 1), Contains(HasSubstr("mdat")));
  EXPECT_THAT(errors(table + "stco", 11, 1), Contains(HasSubstr("mdat")));
  EXPECT_THAT(errors(table + "stss", 8, 1), Contains(HasSubstr("stss: sample")));
  EXPECT_THAT(errors(table + "stsd", 7, 2), Contains(HasSubstr("stsd")));
}

TEST_F(BoxesFire, OnBoxesThatDoNotFit) {
  Bytes bad = good_;
  bad.push_back(0);
  EXPECT_THAT(read_movie(BoxFile(bad)).errors, Contains(HasSubstr("1 bytes left")));
  bad = good_;
  bad.pop_back();
  EXPECT_THAT(read_movie(BoxFile(bad)).errors, Contains(HasSubstr("does not fit")));
  EXPECT_THAT(read_movie(BoxFile({})).errors, Contains("ftyp is not first"));
}

}  // namespace boxes_test
}  // namespace animeme::test
