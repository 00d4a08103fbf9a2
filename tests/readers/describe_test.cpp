// Programs that describe files: mediainfo and mkvmerge.
#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace describe_test {

// The first track of a type ("Video", "Audio"), null: there is none.
Json track_of(const Json& report, const std::string& type) {
  if (!report.contains("media")) return {};
  for (const Json& track : report["media"]["track"]) {
    if (track["@type"] == type) return track;
  }
  return {};
}

double number(const Json& track, const char* key) {
  return track.contains(key) ? std::stod(track[key].get<std::string>()) : -1;
}

struct Description {
  std::string extension;
  std::string format;    // mediainfo: of the file
  std::string codec_id;  // mediainfo: of the face
  std::string kind;      // mkvmerge: of the file
};

Description description_of(const std::string& extension) {
  for (const Description& description :
       {Description{".mp4", "MPEG-4", "mp4v-20", "QuickTime/MP4"},
        Description{".mkv", "Matroska", "V_MPEG4/ISO/ASP", "Matroska"},
        Description{".ts", "MPEG-TS", "16", "MPEG transport stream"}}) {
    if (description.extension == extension) return description;
  }
  return {};
}

class Describe : public testing::TestWithParam<std::string> {
 protected:
  TempDir dir_;
  Talk talk_ = walking_talk();
  Layout layout_ = layout_of(GetParam());
  Description expected_ = description_of(layout_.extension);
  std::string path_ = write_talk(dir_, talk_, layout_);
};

TEST_P(Describe, Mediainfo) {
  NEEDS_PROGRAM("mediainfo", "mediainfo");
  const Json report = run_json("mediainfo --Output=JSON '" + path_ + "'");
  const Json file = track_of(report, "General");
  EXPECT_EQ(file["Format"], expected_.format);
  const Json face = track_of(report, layout_.metadata() ? "Other" : "Video");
  EXPECT_EQ(face["Format"], layout_.metadata() ? "mp4s-20" : "MPEG-4 Visual");
  EXPECT_EQ(face["CodecID"], layout_.metadata() ? "mp4s-20" : expected_.codec_id);
  const Json sound = track_of(report, "Audio");
  EXPECT_EQ(sound["Format"], layout_.opus() ? "Opus" : "AAC");
  EXPECT_EQ(sound["SamplingRate"], "48000");
  // In a TS it sees the time from the first unit to the last; it prints no rate for a TS and for
  // metadata.
  const bool ts = layout_.ts();
  const double seconds = double(talk_.face.units.size()) / 25;
  EXPECT_NEAR(number(face, "Duration"), ts ? seconds - 0.04 : seconds, 0.001);
  EXPECT_NEAR(number(face, "FrameRate"), ts || layout_.metadata() ? -1 : 25, 0.0005);
  EXPECT_NEAR(number(face, "FrameCount"), ts ? -1 : double(talk_.face.units.size()), 0);
  // Elsewhere, and in fragments, it counts priming and padding.
  if (layout_.mp4() && !layout_.options.fragmented) {
    EXPECT_NEAR(number(sound, "Duration"), talk_.sound.duration(), 0.0006);
  }
}

TEST_P(Describe, Mkvmerge) {
  NEEDS_PROGRAM("mkvmerge", "mkvtoolnix");
  const Json report = run_json("mkvmerge -J '" + path_ + "'");
  EXPECT_EQ(report["container"]["type"], expected_.kind);
  EXPECT_EQ(report["errors"].size(), 0u);
  EXPECT_EQ(report["warnings"].size(), 0u);
  std::string tracks;
  for (const Json& track : report["tracks"]) {
    tracks += track["type"].get<std::string>() + " " + track["codec"].get<std::string>() + "\n";
  }
  // In a TS it looks for video and finds none, and it does not know metadata: only the sound is
  // left.
  const std::string sound = layout_.opus() ? "audio Opus\n" : "audio AAC\n";
  EXPECT_EQ(tracks, layout_.ts() || layout_.metadata() ? sound : "video MPEG-4p2\n" + sound);
}

INSTANTIATE_TEST_SUITE_P(Layouts, Describe, testing::ValuesIn(names_of(layouts())),
                         [](const auto& value) { return value.param; });

}  // namespace describe_test
}  // namespace animeme::test
