// GStreamer's demuxers: the units byte for byte, their times, and which of them are deltas.
#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace gstreamer_test {

struct Route {
  std::string layout;
  std::string element;
  std::string package;
  std::string branch;  // from the demuxer to what looks at the units
};

// "0:00:01.040000000" in seconds; negative: "none".
double seconds_of(const std::string& clock) {
  int hours = 0, minutes = 0;
  double seconds = 0;
  if (std::sscanf(clock.c_str(), "%d:%d:%lf", &hours, &minutes, &seconds) != 3) return -1;
  return hours * 3600 + minutes * 60 + seconds;
}

// What follows `key` in a line, up to a comma, a blank or a bracket.
std::string field(const std::string& line, const std::string& key) {
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return {};
  const std::size_t start = at + key.size();
  return line.substr(start, line.find_first_of(", )", start) - start);
}

class GStreamer : public testing::TestWithParam<Route> {
 protected:
  void SetUp() override {
    NEEDS_PROGRAM("gst-launch-1.0", "gstreamer1.0-tools");
    if (std::system(("gst-inspect-1.0 --exists " + GetParam().element).c_str()) != 0) {
      GTEST_SKIP() << GetParam().element << " is missing (Debian package " << GetParam().package
                   << "; tools/setup.sh tests installs it)";
    }
  }

  // Runs the demuxer and writes the units, one behind the other; its talk, one string a line.
  std::vector<std::string> demux(const std::string& path, const std::string& units) const {
    int status = 0;
    const std::string said =
        run("timeout 60 gst-launch-1.0 -v filesrc location='" + path + "' ! " + GetParam().element +
                " name=d " + GetParam().branch +
                " ! identity name=unit silent=false ! filesink location='" + units + "' 2>&1",
            &status);
    EXPECT_EQ(status, 0) << said;
    std::vector<std::string> lines;
    std::istringstream in(said);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

TEST_P(GStreamer, GivesTheUnitsByteForByteAndInTime) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam().layout);
  for (const Talk& talk : {walking_talk(), reference_talk("start_code_inside_face")}) {
    const std::string path = write_talk(dir, talk, layout);
    const auto said = demux(path, dir.file("units"));
    const std::vector<Bytes> units = units_of(talk, layout.ts());
    EXPECT_EQ(to_hex(read_bytes(dir.file("units"))), to_hex(joined(units)));
    std::size_t count = 0;
    for (const std::string& line : said) {
      if (line.find("chain") == std::string::npos) continue;
      ASSERT_LT(count, units.size());
      const fba::AccessUnit& unit = talk.face.units[count];
      SCOPED_TRACE("unit " + std::to_string(count) + ": " + line);
      EXPECT_EQ(field(line, "(unit:sink) ("), std::to_string(units[count].size()));
      const double time = double(unit.time) / talk.face.timescale;
      // tsdemux counts from the clock at the first plane, mkv has whole milliseconds behind the
      // priming.
      const double shift =
          layout.ts() ? kTsBegin / 2 : double(layout.late()) / talk.sound.sample_rate;
      EXPECT_NEAR(seconds_of(field(line, "pts: ")), time + shift,
                  layout.ts() ? 2.0 / 90000 : 0.001);
      if (!layout.ts()) {
        EXPECT_EQ(line.find("delta-unit") == std::string::npos, unit.intra);
      }
      ++count;
    }
    EXPECT_EQ(count, units.size());
  }
}

TEST_P(GStreamer, NamesTheProfile) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam().layout);
  const std::string path = write_talk(dir, walking_talk(), layout);
  std::string caps;
  for (const std::string& line : demux(path, dir.file("units"))) {
    if (line.find("GstIdentity:unit.GstPad:sink: caps") != std::string::npos) caps = line;
  }
  if (layout.metadata()) {
    EXPECT_NE(caps.find("meta/x-gst-fourcc-mp4s"), std::string::npos) << caps;
    return;
  }
  EXPECT_NE(caps.find("video/mpeg, mpegversion=(int)4"), std::string::npos) << caps;
  if (GetParam().element == "tsdemux") return;  // the transport stream tells no more
  EXPECT_NE(caps.find("codec_data=(buffer)000001b061000001b58947"), std::string::npos) << caps;
  if (GetParam().element == "matroskademux") return;  // matroskademux calls it "simple"
  EXPECT_NE(caps.find("profile=(string)simple-face, level=(string)1"), std::string::npos) << caps;
}

Route route_of(const std::string& layout) {
  const std::string extension = layout_of(layout).extension;
  if (extension == ".mkv") {
    return {layout, "matroskademux", "gstreamer1.0-plugins-good", "d.video_0"};
  }
  if (extension == ".ts") {
    return {layout, "tsdemux", "gstreamer1.0-plugins-bad",
            "d. ! video/mpeg,mpegversion=4,systemstream=false"};
  }
  const bool metadata = layout_of(layout).metadata();
  return {layout, "qtdemux", "gstreamer1.0-plugins-good", metadata ? "d.meta_0" : "d.video_0"};
}

std::vector<Route> routes() {
  std::vector<Route> all;
  for (const std::string& layout : names_of(layouts())) all.push_back(route_of(layout));
  return all;
}

INSTANTIATE_TEST_SUITE_P(Routes, GStreamer, testing::ValuesIn(routes()),
                         [](const auto& value) { return value.param.layout; });

}  // namespace gstreamer_test
}  // namespace animeme::test
