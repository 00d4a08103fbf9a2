// What stands in front of the fragments of an mp4: how long all of it lasts, and where it lies.
#include <gmock/gmock.h>

#include <fstream>
#include <numeric>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace fragments_test {

using test::Bytes;

std::uint64_t number(const Bytes& bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes.at(at + i);
  return value;
}

struct TopBox {
  std::string type;
  std::size_t at, size;
};

std::vector<TopBox> top_boxes(const Bytes& file) {
  std::vector<TopBox> boxes;
  for (std::size_t at = 0; at + 8 <= file.size(); at += boxes.back().size) {
    const std::string type(file.begin() + std::ptrdiff_t(at + 4),
                           file.begin() + std::ptrdiff_t(at + 8));
    boxes.push_back({type, at, std::size_t(number(file, at, 4))});
  }
  return boxes;
}

struct Index {
  std::uint64_t track, timescale, begin;
  std::vector<std::size_t> places;  // in the file, where it says that fragments begin, and the end
  std::vector<std::uint64_t> durations;
  std::vector<bool> sync;

  double seconds() const {
    return double(std::accumulate(durations.begin(), durations.end(), std::uint64_t(0))) /
           double(timescale);
  }
};

std::vector<Index> indexes(const Bytes& file) {
  std::vector<Index> found;
  for (const TopBox& box : top_boxes(file)) {
    if (box.type != "sidx") continue;
    EXPECT_EQ(file[box.at + 8], 1) << "version";
    Index index{number(file, box.at + 12, 4),
                number(file, box.at + 16, 4),
                number(file, box.at + 20, 8),
                {},
                {},
                {}};
    index.places.push_back(box.at + box.size + number(file, box.at + 28, 8));
    const std::size_t count = number(file, box.at + 38, 2);
    EXPECT_EQ(box.size, 40 + 12 * count);
    for (std::size_t at = box.at + 40; at < box.at + box.size; at += 12) {
      index.places.push_back(index.places.back() + number(file, at, 4));
      index.durations.push_back(number(file, at + 4, 4));
      index.sync.push_back(number(file, at + 8, 4) == 0x90000000);
    }
    found.push_back(std::move(index));
  }
  return found;
}

class Fragments : public testing::Test {
 protected:
  Bytes write(const MuxInput& input, double fragment_seconds = 1) {
    const auto written =
        write_container(path_, input, {.fragmented = true, .fragment_seconds = fragment_seconds});
    EXPECT_TRUE(written) << written.error().describe();
    return test::read_bytes(path_);
  }

  test::TempDir dir_;
  std::string path_ = dir_.file("talk.mp4");
  fba::AccessUnits face_ = test::make_face(250, 25000, 1000, 100);
  Pcm sound_ = test::make_clicks(48000, 9 * 48000 + 12345, {24000, 48000 * 7 + 11});
};

TEST_F(Fragments, TheIndexNamesEachFragmentAndWhatAReaderCanBeginWith) {
  const Bytes file = write({.face = &face_, .audio = &sound_});
  std::vector<std::size_t> fragments;
  for (const TopBox& box : top_boxes(file)) {
    if (box.type == "moof") fragments.push_back(box.at);
  }
  fragments.push_back(file.size());
  const std::vector<Index> found = indexes(file);
  ASSERT_EQ(found.size(), 2u);
  const Index &face = found[0], &sound = found[1];
  EXPECT_EQ(face.places, fragments);
  EXPECT_EQ(sound.places, fragments);
  EXPECT_EQ(face.timescale, 25000u);
  EXPECT_EQ(sound.timescale, 48000u);
  EXPECT_EQ(face.begin, 0u);
  EXPECT_EQ(sound.begin, 0u) << "presented, so without the priming";
  EXPECT_DOUBLE_EQ(face.seconds(), 10);
  EXPECT_DOUBLE_EQ(sound.seconds(), sound_.duration());
  ASSERT_GE(face.sync.size(), 10u);
  EXPECT_EQ(std::count(face.sync.begin(), face.sync.end(), true), 3) << "planes 0, 100, 200";
  EXPECT_TRUE(face.sync[0]);
  // The sound is over before the face is.
  EXPECT_EQ(sound.sync, std::vector<bool>(10, true));
  std::uint64_t time = 0;
  for (std::size_t i = 0; i < face.sync.size(); ++i) {
    EXPECT_EQ(face.sync[i], time % 100000 == 0) << i;
    time += face.durations[i];
  }
}

TEST_F(Fragments, TheMovieTellsHowLongAllOfItLasts) {
  const auto told = [](const Bytes& file) {
    const Bytes box = test::find_box(file, "moov/mvex/mehd");
    EXPECT_EQ(box.size(), 12u);
    const Bytes header = test::find_box(file, "moov/mvhd");
    return double(number(box, 4, 8)) / double(number(header, 12, 4));
  };
  EXPECT_DOUBLE_EQ(told(write({.face = &face_, .audio = &sound_})), 10);
  EXPECT_DOUBLE_EQ(told(write({.audio = &sound_})), sound_.duration());
  for (fba::AccessUnit& unit : face_.units) unit.time += 50000;
  const Bytes late = write({.face = &face_, .audio = &sound_});
  EXPECT_DOUBLE_EQ(told(late), 12);
  const std::vector<Index> found = indexes(late);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].begin, 50000u) << "the face begins at 2 s";
  EXPECT_DOUBLE_EQ(found[0].seconds(), 10);
  EXPECT_TRUE(test::find_box(write({.face = &face_}), "sidx").size() > 0);
}

TEST_F(Fragments, AFileWithoutFragmentsHasNoIndex) {
  ASSERT_TRUE(write_container(path_, {.face = &face_, .audio = &sound_}));
  const Bytes file = test::read_bytes(path_);
  EXPECT_TRUE(indexes(file).empty());
  EXPECT_TRUE(test::find_box(file, "moov/mvex").empty());
}

TEST_F(Fragments, MoreOfThemThanAnIndexHoldsAreWrittenWithoutIt) {
  const fba::AccessUnits face = test::make_face(66000, 90000, 1800, 1);
  const Bytes file = write({.face = &face}, 0.02);
  EXPECT_TRUE(indexes(file).empty());
  EXPECT_EQ(test::find_box(file, "moov/mvex/mehd").size(), 12u);
}

// A reader that has the front of the file only cannot have gone through it.
TEST_F(Fragments, FfprobeKnowsTheDurationFromTheFront) {
  if (!test::has_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  const Bytes file = write({.face = &face_, .audio = &sound_});
  const std::string cut = dir_.file("cut.mp4");
  std::ofstream(cut, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size() / 2));
  EXPECT_EQ(test::run("ffprobe -v quiet -show_entries stream=duration -of csv=p=0 " + cut),
            "10.000000\n9.257188\n");
}

TEST_F(Fragments, FfmpegSeeksToThePlaceAskedFor) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  write({.face = &face_, .audio = &sound_});
  const std::string wav = dir_.file("part.wav");
  (void)test::run("ffmpeg -v quiet -ss 6.5 -i " + path_ + " -vn -c:a pcm_s16le " + wav);
  const Result<Pcm> part = read_audio(wav);
  ASSERT_TRUE(part) << part.error().describe();
  // The burst at 7 s; within a frame of the codec, since a seek drops whole ones.
  EXPECT_NEAR(double(test::find_click(*part, 24011, 4800)), 24011, 1025);
}

}  // namespace fragments_test
}  // namespace animeme::media
