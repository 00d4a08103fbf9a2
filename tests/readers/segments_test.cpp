// HLS and DASH: the segments by our own tables, and what FFmpeg's readers make of the playlists.
// browser_test.cpp plays them.
#include <gmock/gmock.h>

#include "tests/readers/ffprobe.h"
#include "tests/readers/movie_checks.h"

namespace animeme::test {
namespace segments_test {

class Segments : public testing::TestWithParam<std::string> {
 protected:
  std::string folder() const {
    return dir_.file(layout_.name + (layout_.extension == ".mpd" ? "_dash" : "_hls"));
  }
  // The initialization segment of a track and its media segments, in order.
  std::vector<Bytes> parts(const std::string& track) const {
    std::vector<Bytes> all = {read_bytes(folder() + "/" + track + "-init.mp4")};
    for (int i = 1;; ++i) {
      char number[16];
      std::snprintf(number, sizeof number, "-%05d.m4s", i);
      Bytes segment = read_bytes(folder() + "/" + track + number);
      if (segment.empty()) return all;
      all.push_back(std::move(segment));
    }
  }
  // Runs a command in the folder of the playlist: FFmpeg's reader of DASH wants that.
  std::string here(const std::string& command) const {
    return "cd '" + fs::path(path_).parent_path().string() + "' && " + command;
  }

  TempDir dir_;
  Talk talk_ = walking_talk();
  Layout layout_ = layout_of(GetParam());
  std::string path_ = write_talk(dir_, talk_, layout_);
};

TEST_P(Segments, AreOneMovieAndEachBeginsWithASyncSample) {
  const std::vector<Bytes> face = parts("face");
  ASSERT_EQ(face.size(), 4u) << "2.4 s, an intra plane every second";
  const BoxFile file(joined(face));
  const Movie movie = read_movie(file);
  EXPECT_THAT(movie.errors, testing::IsEmpty());
  expect_face(file, movie, talk_);
  for (std::size_t i = 1; i < face.size(); ++i) {
    const Movie part = read_movie(BoxFile(joined({face[0], face[i]})));
    EXPECT_THAT(part.errors, testing::IsEmpty());
    const char* handler = layout_.metadata() ? "meta" : "vide";
    ASSERT_NE(part.track(handler), nullptr);
    ASSERT_FALSE(part.track(handler)->samples.empty());
    EXPECT_TRUE(part.track(handler)->samples[0].sync) << "segment " << i;
  }
}

TEST_P(Segments, SoundIsOneMovieWithItsPrimingCutOff) {
  const std::vector<Bytes> sound = parts("sound");
  ASSERT_GE(sound.size(), 3u);
  const Movie movie = read_movie(BoxFile(joined(sound)));
  EXPECT_THAT(movie.errors, testing::IsEmpty());
  const MovieTrack* track = movie.track("soun");
  ASSERT_NE(track, nullptr);
  EXPECT_EQ(track->shown_at(layout_.priming(), movie.timescale), 0);
  ASSERT_FALSE(track->samples.empty());
  const MovieSample& last = track->samples.back();
  EXPECT_NEAR(track->shown_at(last.time + last.duration, movie.timescale), talk_.sound.duration(),
              0.0214);
}

TEST_P(Segments, FfprobeGivesTheUnits) {
  NEEDS_PROGRAM("ffprobe", "ffmpeg");
  const std::string playlist =
      layout_.extension == ".mpd" ? layout_.name + ".mpd" : layout_.name + "_hls/face.m3u8";
  const Json said = run_json(here("ffprobe -v fatal -of json -select_streams " +
                                  std::string(layout_.metadata() ? "d" : "v") +
                                  " -show_packets -show_data '" + playlist + "'"));
  expect_packets(talk_, layout_, said["packets"]);
}

TEST_P(Segments, FfmpegPlaysTheSound) {
  NEEDS_PROGRAM("ffmpeg", "ffmpeg");
  const std::string raw = dir_.file("heard.f32");
  int status = 0;
  run(here("ffmpeg -nostdin -v fatal -i " + layout_.name + layout_.extension + " -vn -f f32le '" +
           raw + "' 2>&1"),
      &status);
  ASSERT_EQ(status, 0);
  // As from any fragments: raw samples of AAC begin with the priming.
  expect_bursts(read_floats(raw, talk_.sound.sample_rate), talk_,
                layout_.opus() ? 0 : layout_.priming());
}

INSTANTIATE_TEST_SUITE_P(Layouts, Segments, testing::ValuesIn(names_of(segment_layouts())),
                         [](const auto& value) { return value.param; });

}  // namespace segments_test
}  // namespace animeme::test
