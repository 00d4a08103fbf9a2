// Every reference stream through every container: access units byte for byte, times in place.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tests/support/reference_streams.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/media/stored.h"

namespace animeme::media {
namespace round_trip_test {

struct Way {
  const char* extension;
  AudioCodec codec;
  bool fragmented;
  double tolerance;   // seconds; 0: exact
  double shared = 0;  // seconds of planes in a packet
};

constexpr Way kWays[] = {{".mp4", AudioCodec::aac, false, 0},
                         {".mp4", AudioCodec::opus, true, 0},
                         {".m3u8", AudioCodec::aac, false, 0},
                         {".mpd", AudioCodec::opus, false, 0},
                         {".mkv", AudioCodec::aac, false, 0.001},
                         {".mkv", AudioCodec::opus, false, 0.001},
                         {".ts", AudioCodec::aac, false, 1.01 / 90000},
                         {".ts", AudioCodec::aac, false, 1.51 / 90000, 0.4}};

class RoundTrip : public testing::Test {
 protected:
  void SetUp() override {
    const Pcm sound = test::make_clicks(48000, 48000, {24000});
    for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
      auto coded = encode_audio(sound, {.codec = codec});
      ASSERT_TRUE(coded) << coded.error().describe();
      sounds_.push_back(std::move(*coded));
    }
  }

  void expect_same(const fba::AccessUnits& face, const fba::AccessUnits& back, double tolerance) {
    EXPECT_EQ(back.config, face.config);
    if (tolerance == 0) {
      EXPECT_TRUE(back == face) << "times, durations, bytes or flags differ";
      return;
    }
    ASSERT_EQ(back.units.size(), face.units.size());
    const double first = double(back.units[0].time) / back.timescale;
    for (std::size_t i = 0; i < face.units.size(); ++i) {
      ASSERT_EQ(back.units[i].bytes, face.units[i].bytes) << i;
      ASSERT_EQ(back.units[i].intra, face.units[i].intra) << i;
      ASSERT_NEAR(double(back.units[i].time) / back.timescale - first,
                  double(face.units[i].time) / face.timescale, tolerance)
          << i;
    }
  }

  void carry(const fba::AccessUnits& face) {
    for (const Way& way : kWays) {
      SCOPED_TRACE(std::string(way.extension) + " " + name_of(way.codec));
      const std::string path = dir_.file(std::string("a") + way.extension);
      MuxOptions options;
      options.fragmented = way.fragmented;
      options.shared_seconds = way.shared;
      const MuxInput input{.face = &face, .encoded = &sounds_[std::size_t(way.codec)]};
      const auto written = write_container(path, input, options);
      ASSERT_TRUE(written) << written.error().describe();
      const Result<Container> back = read_container(path);
      ASSERT_TRUE(back) << back.error().describe();
      EXPECT_THAT(back->warnings, testing::IsEmpty());
      expect_same(face, back->face, way.tolerance);
      expect_streamed(path, *back);
      const bool in_memory = way.shared > 0 || !segment_folder(path).empty();
      if (!in_memory) expect_written_alike(path, face, input, options);
    }
  }

  // Unit by unit the same is read, unless something is repaired or warned of.
  void expect_streamed(const std::string& path, const Container& whole) {
    fba::AccessUnits face;
    const auto summary = stream_face(
        path, [&face](const fba::AccessUnit& unit, std::span<const std::uint8_t> config) {
          face.config.assign(config.begin(), config.end());
          face.units.push_back(unit);
          return Result<void>();
        });
    ASSERT_TRUE(summary) << summary.error().describe();
    if (!*summary) {
      ++not_streamed_;
      return;
    }
    ++streamed_;
    const FaceSummary& facts = **summary;
    expect_stored(path, whole.face);
    EXPECT_EQ(facts.format, whole.format);
    EXPECT_EQ(facts.visual_profile, whole.visual_profile);
    EXPECT_EQ(facts.timescale, whole.face.timescale);
    EXPECT_EQ(facts.start, whole.face.units.front().time);
    EXPECT_EQ(facts.end, whole.face.units.back().time + whole.face.units.back().duration);
    EXPECT_EQ(face.config, whole.face.config);
    ASSERT_EQ(facts.units, whole.face.units.size());
    ASSERT_EQ(face.units.size(), facts.units);
    for (std::size_t i = 0; i < facts.units; ++i) {
      EXPECT_EQ(face.units[i].bytes, whole.face.units[i].bytes) << i;
      EXPECT_EQ(face.units[i].intra, whole.face.units[i].intra) << i;
      EXPECT_EQ(face.units[i].duration, whole.face.units[i].duration) << i;
    }
  }

  // So has what is kept in a temporary file, again and again.
  static void expect_stored(const std::string& path, const fba::AccessUnits& face) {
    auto stored = store_face(path);
    ASSERT_TRUE(stored) << stored.error().describe();
    ASSERT_EQ(stored->has_value(), face.units.front().time >= 0);
    for (int pass = 0; *stored && pass < 2; ++pass) {
      fba::UnitReader& units = **stored;
      EXPECT_EQ(units.summary().config, face.config);
      EXPECT_EQ(units.summary().timescale, face.timescale);
      for (const fba::AccessUnit& expected : face.units) {
        const auto unit = units.next();
        ASSERT_TRUE(unit && *unit != nullptr);
        EXPECT_TRUE(**unit == expected);
      }
      EXPECT_EQ(*units.next(), nullptr);
      units.rewind();
    }
  }

  // The file of units that are read while it is written has the same bytes.
  void expect_written_alike(const std::string& path, const fba::AccessUnits& face, MuxInput input,
                            const MuxOptions& options) {
    const std::vector<std::uint8_t> stream = fba::join_access_units(face);
    auto units = fba::UnitReader::open(stream);
    ASSERT_TRUE(units) << units.error().describe();
    input.face = nullptr;
    input.face_units = &*units;
    const std::string other = dir_.file("b" + path.substr(path.rfind('.')));
    const auto written = write_container(other, input, options);
    ASSERT_TRUE(written) << written.error().describe();
    EXPECT_TRUE(test::slurp(other) == test::slurp(path));
  }

  int streamed_ = 0, not_streamed_ = 0;  // files

  test::TempDir dir_;
  std::vector<EncodedAudio> sounds_;
};

TEST_F(RoundTrip, EveryReferenceStreamInEveryContainer) {
  std::size_t count = 0, misleading = 0;
  for (const auto& base : test::reference_streams()) {
    SCOPED_TRACE(base.filename().string());
    const auto stream = test::read_bytes(test::with(base, ".fba"));
    const Result<fba::AccessUnits> face = fba::split_access_units(stream);
    ASSERT_TRUE(face) << face.error().describe();
    ++count;
    for (const fba::AccessUnit& unit : face->units) {
      const test::Bytes code = {0, 0, 1};
      const auto inside =
          unit.bytes.begin() + std::min<std::ptrdiff_t>(13, unit.bytes.end() - unit.bytes.begin());
      const auto found = std::search(inside, unit.bytes.end(), code.begin(), code.end());
      if (found != unit.bytes.end()) ++misleading;
    }
    carry(*face);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(count, 64u);
  EXPECT_GE(misleading, 1u) << "no stream has start codes inside its planes";
  EXPECT_EQ(streamed_, 3 * not_streamed_) << "all but playlists, two of eight";
}

TEST_F(RoundTrip, GapsAndALateStart) {
  fba::AccessUnits face = test::make_face(100, 30000, 1001, 25);
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    face.units[i].time += 30030 + (i >= 40 ? 60060 : 0);
  }
  face.units[39].duration += 60060;
  const auto first = face.units[0].time;
  for (const Way& way : kWays) {
    SCOPED_TRACE(way.extension);
    const std::string path = dir_.file(std::string("a") + way.extension);
    MuxOptions options;
    options.fragmented = way.fragmented;
    options.shared_seconds = way.shared;
    const MuxInput input{.face = &face, .encoded = &sounds_[std::size_t(way.codec)]};
    ASSERT_TRUE(write_container(path, input, options));
    const Result<Container> back = read_container(path);
    ASSERT_TRUE(back) << back.error().describe();
    if (way.tolerance == 0) {
      EXPECT_TRUE(back->face == face);
      continue;
    }
    ASSERT_EQ(back->face.units.size(), face.units.size());
    const double shift = way.codec == AudioCodec::aac ? 1024.0 / 48000 : 0;
    for (std::size_t i = 0; i < face.units.size(); ++i) {
      EXPECT_NEAR(double(back->face.units[i].time) / back->face.timescale,
                  double(face.units[i].time) / 30000 + shift, way.tolerance);
    }
  }
  EXPECT_EQ(first, 30030);
}

TEST_F(RoundTrip, FacesWithoutSound) {
  const fba::AccessUnits face = test::make_face(120, 25000, 1000, 30);
  for (const Way& way : kWays) {
    SCOPED_TRACE(way.extension);
    const std::string path = dir_.file(std::string("a") + way.extension);
    MuxOptions options;
    options.fragmented = way.fragmented;
    options.shared_seconds = way.shared;
    ASSERT_TRUE(write_container(path, {.face = &face}, options));
    const Result<Container> back = read_container(path);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_FALSE(back->audio);
    expect_same(face, back->face, way.tolerance);
  }
}

}  // namespace round_trip_test
}  // namespace animeme::media
