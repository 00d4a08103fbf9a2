// npm mp4box and codem-isoboxer: tracks, descriptors and every sample, against the bytes of the
// tools/formats/media/containers.md, sections 1.4 and 1.5.
#include "tests/readers/scripts.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace script_test {

// tools/formats/media/containers.md, section 1.4; bufferSizeDB and the two bit rates depend on the
// data.
const std::string kFaceEsdsStart =
    "0000003c65736473"
    "00000000"
    "038080802b"
    "0000"
    "00"
    "048080801d"
    "20"
    "11";
const std::string kFaceEsdsEnd =
    "058080800b"
    "000001b061000001b58947"
    "0680808001"
    "02";
constexpr std::size_t kEsdsFree = 3 + 4 + 4;

// tools/formats/media/containers.md, section 1.5.
const std::string kSystemsIods =
    "00000021696f647300000000"
    "1013004ffefe2961fe"
    "0e0400000001"
    "0e0400000002";
const std::string kSceneConfig =
    "1038"
    "0a00"
    "0780";
const std::string kSceneUnit = "c005a1d00d00240539388605414f00";
const std::string kObjectUnit =
    "0110"
    "1106029f0f020001"
    "1106051f0f020002";

// The box "esds" behind the fields of a sample entry (tools/formats/media/containers.md,
// section 1.5: none in mp4s).
std::string esds_of(const Json& track) {
  const auto entry = track["entry_hex"].get<std::string>();
  const std::size_t fields = track["entry"] == "mp4v" ? 86 : track["entry"] == "mp4a" ? 36 : 16;
  EXPECT_GT(entry.size(), 2 * fields) << track["entry"];
  if (entry.size() <= 2 * fields) return {};
  const std::size_t size = std::stoul(entry.substr(2 * fields, 8), nullptr, 16);
  EXPECT_EQ(entry.substr(2 * fields + 8, 8), "65736473");
  return entry.substr(2 * fields, 2 * size);
}

void expect_face_esds(const std::string& esds, const Talk& talk) {
  ASSERT_EQ(esds.size(), kFaceEsdsStart.size() + 2 * kEsdsFree + kFaceEsdsEnd.size());
  EXPECT_EQ(esds.substr(0, kFaceEsdsStart.size()), kFaceEsdsStart);
  EXPECT_EQ(esds.substr(esds.size() - kFaceEsdsEnd.size()), kFaceEsdsEnd);
  std::size_t largest = 0;
  for (const fba::AccessUnit& unit : talk.face.units) {
    largest = std::max(largest, unit.bytes.size());
  }
  EXPECT_EQ(std::stoul(esds.substr(kFaceEsdsStart.size(), 6), nullptr, 16), largest);
}

void expect_face_samples(const Json& samples, const Talk& talk) {
  ASSERT_EQ(samples.size(), talk.face.units.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const fba::AccessUnit& unit = talk.face.units[i];
    SCOPED_TRACE("unit " + std::to_string(i));
    EXPECT_EQ(samples[i]["hex"], to_hex(unit.bytes));
    EXPECT_EQ(samples[i]["time"], unit.time);
    EXPECT_EQ(samples[i]["duration"], unit.duration);
    EXPECT_EQ(samples[i]["sync"], unit.intra);
  }
}

const Json* track_with(const Json& report, const std::string& handler) {
  for (const Json& track : report["tracks"]) {
    if (track["handler"] == handler) return &track;
  }
  ADD_FAILURE() << "no track with handler " << handler;
  return nullptr;
}

class Script : public testing::TestWithParam<std::string> {
 protected:
  std::string handler() const { return layout_.metadata() ? "meta" : "vide"; }
  std::string entry() const { return layout_.metadata() ? "mp4s" : "mp4v"; }
  // Priming is cut off; the length of fragments is not known when the list is written (0).
  void expect_edits(const Json& edits) const {
    ASSERT_EQ(edits.size(), 1u);
    EXPECT_EQ(edits[0]["media_time"], layout_.priming());
    EXPECT_EQ(edits[0]["duration"], layout_.options.fragmented ? 0 : talk_.sound.samples.size());
  }

  TempDir dir_;
  Talk talk_ = walking_talk();
  Layout layout_ = layout_of(GetParam());
  std::string path_ = write_talk(dir_, talk_, layout_);
};

TEST_P(Script, Mp4boxSeesFaceAndSound) {
  NEEDS_NPM("mp4box");
  const Json report = run_script("report.js", "mp4box '" + path_ + "'");
  EXPECT_EQ(report["brand"], "mp42");
  EXPECT_EQ(report["timescale"], talk_.sound.sample_rate);
  const Json* face = track_with(report, handler());
  const Json* sound = track_with(report, "soun");
  ASSERT_TRUE(face && sound);
  EXPECT_EQ((*face)["media_header"], layout_.metadata() ? "nmhd" : "vmhd");
  EXPECT_EQ((*face)["entry"], entry());
  EXPECT_EQ((*face)["timescale"], talk_.face.timescale);
  expect_face_esds(esds_of(*face), talk_);
  expect_face_samples((*face)["samples"], talk_);
  EXPECT_EQ((*sound)["media_header"], "smhd");
  EXPECT_EQ((*sound)["codec"], layout_.opus() ? "Opus" : "mp4a.40.2");
  EXPECT_EQ(report["fragmented"], layout_.options.fragmented);
  expect_edits((*sound)["edits"]);
}

TEST_P(Script, IsoboxerSeesTheSame) {
  NEEDS_NPM("codem-isoboxer");
  const Json report = run_script("report.js", "isoboxer '" + path_ + "'");
  EXPECT_EQ(report["complete"], true);
  EXPECT_EQ(report["brand"], "mp42");
  const Json* face = track_with(report, handler());
  const Json* sound = track_with(report, "soun");
  ASSERT_TRUE(face && sound);
  EXPECT_EQ((*face)["entry"], entry());
  EXPECT_EQ((*face)["timescale"], talk_.face.timescale);
  EXPECT_EQ((*sound)["entry"], layout_.opus() ? "Opus" : "mp4a");
  expect_edits((*sound)["edits"]);
  if (!layout_.options.fragmented) {
    EXPECT_EQ((*face)["durations"], Json::parse("[[60, 1000]]"));
    return;
  }
  // The fragments of the face, one behind the other.
  Json samples = Json::array();
  for (const Json& fragment : report["fragments"]) {
    if (fragment["id"] != (*face)["id"]) continue;
    EXPECT_EQ(fragment["samples"][0]["sync"], true) << "a reader could not begin here";
    for (const Json& sample : fragment["samples"]) samples.push_back(sample);
  }
  expect_face_samples(samples, talk_);
}

INSTANTIATE_TEST_SUITE_P(Layouts, Script, testing::ValuesIn(names_of(mp4_layouts())),
                         [](const auto& value) { return value.param; });

TEST(ScriptMp4, InitialObjectDescriptor) {
  NEEDS_NPM("mp4box");
  const TempDir dir;
  const std::string path = write_talk(dir, walking_talk(), layout_of("mp4"));
  // tools/formats/media/containers.md, section 1.4, with the tracks 1 and 2 named.
  const std::string iods =
      "0000002a696f647300000000"
      "1080808019"
      "004f"
      "ffff2961ff"
      "0e8080800400000001"
      "0e8080800400000002";
  EXPECT_EQ(run_script("report.js", "mp4box '" + path + "'")["iods"], iods);
  EXPECT_EQ(run_script("report.js", "isoboxer '" + path + "'")["iods"], iods);
}

TEST(ScriptSystems, SceneAndObjectsAreThoseOfTheSpecification) {
  NEEDS_NPM("mp4box");
  const TempDir dir;
  const std::string path = write_talk(dir, walking_talk(), layout_of("systems"));
  const Json report = run_script("report.js", "mp4box '" + path + "'");
  EXPECT_EQ(report["iods"], kSystemsIods);
  ASSERT_EQ(report["tracks"].size(), 4u);
  const Json* scene = track_with(report, "sdsm");
  const Json* objects = track_with(report, "odsm");
  ASSERT_TRUE(scene && objects);
  for (const Json* track : {scene, objects}) {
    EXPECT_EQ((*track)["media_header"], "nmhd");
    EXPECT_EQ((*track)["entry"], "mp4s");
    ASSERT_EQ((*track)["samples"].size(), 1u);
  }
  EXPECT_EQ((*scene)["id"], 1);
  EXPECT_EQ((*scene)["samples"][0]["hex"], kSceneUnit);
  EXPECT_NE(esds_of(*scene).find("010d"), std::string::npos) << "object type 1, stream type 3";
  EXPECT_NE(esds_of(*scene).find(kSceneConfig), std::string::npos);
  EXPECT_EQ((*objects)["id"], 2);
  EXPECT_EQ((*objects)["samples"][0]["hex"], kObjectUnit);
  EXPECT_NE(esds_of(*objects).find("0105"), std::string::npos) << "object type 1, stream type 1";
  // The scene's object 10 is the face, object 20 the sound.
  EXPECT_EQ((*objects)["references"], Json::parse(R"([{"type": "mpod", "ids": [10, 20]}])"));
  EXPECT_EQ((*track_with(report, "vide"))["id"], 10);
  EXPECT_EQ((*track_with(report, "soun"))["id"], 20);
}

TEST(ScriptMp4, StartCodesInsideUnitsDoNoHarm) {
  NEEDS_NPM("mp4box");
  const TempDir dir;
  for (const char* name : {"start_code_inside_face", "rate_29_97", "skip_frames"}) {
    const Talk talk = reference_talk(name);
    const std::string path = write_talk(dir, talk, layout_of("mp4"));
    const Json report = run_script("report.js", "mp4box '" + path + "'");
    const Json* face = track_with(report, "meta");
    ASSERT_NE(face, nullptr);
    expect_face_samples((*face)["samples"], talk);
  }
}

}  // namespace script_test
}  // namespace animeme::test
