// The C++ examples of the pages: each is compiled with the variables that it uses, and run where
// that needs no network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "dam/model/builtin.h"
#include "dam/script/timings.h"
#include "fap/fill.h"
#include "fap/head/own_head.h"
#include "fap/head/rig.h"
#include "fap/text.h"
#include "fap/xml/fdp.h"
#include "fap/xml/xmt.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tools/formats/exchange/landmarks.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/open.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/live/recovery.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/media/rtp/session_clock.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/live/web/web.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/live_speaker.h"
#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/word_phones.h"
#include "tools/view/gltf/read_head.h"

namespace fill_and_text {
#include <fap_README_md.cpp.1.inc>
}  // namespace fill_and_text

namespace animeme {
namespace blocks_test {

namespace fs = std::filesystem;
using test::TempDir;

const fs::path kSamples = fs::path(test::kSourceFolder) / "tools/release/samples";

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  const std::string text = test::slurp(path);
  return {text.begin(), text.end()};
}

// The working folder of a block that writes files.
class Here {
 public:
  Here() : before_(fs::current_path()) { fs::current_path(dir_.path()); }
  ~Here() { fs::current_path(before_); }

 private:
  TempDir dir_;
  fs::path before_;
};

// How the blocks that are not in this file are run.
const std::map<std::string, std::string> kElsewhere = {
    {"README.md c 1", "tests/release/blocks/readme_c_test.c"},
    {"README.md python 1", "tests/bindings/python/test_pages.py"},
    {"README.md js 1", "tests/release/blocks/blocks_test.mjs"},
    {"HACKING.md cmake 1", "tests/release/package/find_package.cmake"},
    {"HACKING.md cmake 2", "tests/release/package/fetch_content.cmake"},
    {"tests/README.md js 1", "tests/release/blocks/blocks_test.mjs"},
    {"tools/bindings/agents/README.md python 1", "tests/bindings/agents/test_pauses.py"},
    {"tools/bindings/agents/README.md python 2", "tests/bindings/agents/test_pipecat.py"},
    {"tools/bindings/agents/README.md js 1", "tests/bindings/agents/page_test.mjs"},
    {"tools/bindings/blender/README.md python 1", "tests/bindings/blender/faps.py"},
    {"tools/bindings/npm/README.md html 1", "tests/bindings/npm/page.html"},
    {"tools/bindings/npm/README.md js 1", "tests/release/blocks/blocks_test.mjs"},
    {"tools/bindings/npm/README.md js 2", "tests/release/blocks/blocks_test.mjs"},
    {"tools/bindings/npm/README.md js 3", "tests/release/blocks/blocks_test.mjs"},
    {"tools/bindings/python/README.md python 1", "tests/bindings/python/test_pages.py"},
    {"tools/live/serve/requests.md python 1", "tests/live/serve/say_test.py"},
    {"tools/live/web/README.md js 1", "tests/view/viewer/js/viewer_report.js"},
    {"tools/live/web/README.md html 1", "tests/live/web/embed_test.cpp"},
    {"tools/live/web/protocol.md js 1", "tests/live/web/embed_test.cpp"},
    {"tools/live/web/protocol.md js 2", "tests/live/web/embed_test.cpp"},
    {"tools/view/viewer/README.md html 1", "tests/view/viewer/js/viewer_report.js"},
};

// The blocks of C++ that this file includes.
std::set<std::string> included_here() {
  std::set<std::string> files;
  std::istringstream lines(
      test::slurp(fs::path(test::kSourceFolder) / "tests/release/blocks/blocks_test.cpp"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#include <") && line.ends_with(".inc>")) {
      files.insert(line.substr(10, line.size() - 11));
    }
  }
  return files;
}

TEST(Blocks, EachIsRunByATest) {
  const std::set<std::string> here = included_here();
  std::ifstream list(fs::path(test::kBinaryFolder) / "blocks/list.txt");
  std::size_t count = 0;
  std::set<std::string> found;
  for (std::string page, language, number, file; list >> page >> language >> number >> file;) {
    ++count;
    const std::string name = page + " " + language + " " + number;
    found.insert(name);
    if (here.contains(file)) continue;
    const auto where = kElsewhere.find(name);
    ASSERT_NE(where, kElsewhere.end()) << name << ": no test runs this block";
    EXPECT_TRUE(fs::exists(fs::path(test::kSourceFolder) / where->second)) << where->second;
  }
  EXPECT_GT(count, 25u);
  for (const auto& [name, where] : kElsewhere)
    EXPECT_TRUE(found.contains(name)) << name << " is gone";
}

TEST(Blocks, Readme) {
  const auto decode_all = [](const std::vector<std::uint8_t>& bytes, int& shown) {
    const auto show = [&shown](const fap::Frame&) { ++shown; };
    std::string failed;
    const auto fail = [&failed](const std::string& sentence) { failed = sentence; };
    const auto block = [&] {
#include <README_md.cpp.1.inc>
    };
    block();
    return failed;
  };
  int shown = 0;
  EXPECT_EQ(decode_all(bytes_of(kSamples / "talk.fba"), shown), "");
  EXPECT_GT(shown, 10);
  EXPECT_THAT(decode_all({1, 2, 3}, shown), testing::HasSubstr("bit"));
}

TEST(Blocks, FillAndText) {
  std::vector<std::string> warnings;
  const auto text = fill_and_text::clean(test::slurp(kSamples / "talk.fap"), warnings);
  ASSERT_TRUE(text) << text.error().describe();
  EXPECT_TRUE(fap::read_text(*text));
  EXPECT_FALSE(fill_and_text::clean("no text of FAPs", warnings));
}

TEST(Blocks, Rig) {
  const auto clip = *fap::read_text(test::slurp(kSamples / "talk.fap"));
#include <fap_head_README_md.cpp.1.inc>
  std::size_t moved = 0;
  for (const auto& part : pose.positions) moved += part.size();
  EXPECT_GT(moved, 100u);
}

TEST(Blocks, HeadFilesInXml) {
  const auto woman = *head::make_head(*head::head_parameters("woman"));
  const auto written = head::write_fdp(woman, head::make_rig(woman), {.name = "me"});
  ASSERT_TRUE(written) << written.error().describe();
  const std::string text = written->fdp;
  const auto load = [&](const std::string& name) -> Result<std::string> {
    if (name != "me.wrl") return make_error(Code::not_found, name);
    return written->wrl;
  };
#include <fap_xml_README_md.cpp.1.inc>
  EXPECT_TRUE(files) << files.error().describe();
  EXPECT_TRUE(scene) << scene.error().describe();
}

TEST(Blocks, Landmarks) {
  std::size_t frames = 0;
  const auto use = [&](const fap::Sequence& clip) { frames = clip.frames.size(); };
  const auto warn = [](const std::string&) {};
  const auto block = [&](const std::string& text) -> Result<void> {
#include <tools_formats_exchange_README_md.cpp.1.inc>
    return {};
  };
  const auto done = block(test::slurp(kSamples / "OpenFace.csv"));
  EXPECT_TRUE(done) << done.error().describe();
  EXPECT_GT(frames, 10u);
  EXPECT_FALSE(block("nothing"));
}

TEST(Blocks, Media) {
  using namespace media;
  const Here here;
  const auto talked = read_container((kSamples / "talk.mp4").string());
  ASSERT_TRUE(talked) << talked.error().describe();
  const fba::AccessUnits units = talked->face;
  const auto recorded = read_audio((kSamples / "voice.wav").string());
  ASSERT_TRUE(recorded);
  const Pcm voice = *recorded;
  const auto block = [&]() -> Result<void> {
#include <tools_formats_media_README_md.cpp.1.inc>
    EXPECT_EQ(talk->face.units.size(), units.units.size());
    EXPECT_EQ(sound->sample_rate, 16000);
    return {};
  };
  const auto done = block();
  EXPECT_TRUE(done) << done.error().describe();
  EXPECT_TRUE(fs::exists("talk.m3u8") && fs::exists("talk_hls"));
}

// What the next three send and receive: compiled, and not called.
[[maybe_unused]] void live_transport(const std::function<void(media::LiveUnit)>& play) {
  using namespace media;
#include <tools_formats_media_live_README_md.cpp.1.inc>
}

[[maybe_unused]] void web_sink(const media::LiveInfo& info,
                               const std::vector<media::LiveUnit>& units) {
  using media::LiveUnit;
#include <tools_live_web_README_md.cpp.1.inc>
}

[[maybe_unused]] void live_speaker(const dam::Model& model, media::Pacer& pacer,
                                   media::LiveSink& sink){
#include <tools_speech_talking_README_md.cpp.1.inc>
}

TEST(Blocks, Scripts) {
  const std::string text = test::slurp(kSamples / "voice.TextGrid");
  std::vector<std::string> warnings;
#include <tools_formats_scripts_README_md.cpp.1.inc>
  ASSERT_TRUE(script) << script.error().describe();
  EXPECT_GT(script->phones.size(), 5u);
}

TEST(Blocks, Text) {
  const text::Speakers speakers{.list = {text::make_speaker("cmn", "cmn", "Chinese"),
                                         text::make_speaker("en", "en", "English")},
                                .find = {}};
  const text::Helpers helpers{
      [](const std::string& language, const std::string& voice) -> std::optional<text::Speaker> {
        return text::make_speaker(language, voice, language);
      },
      [](const text::Speaker&, const std::string& ipa, std::vector<std::string>&) { return ipa; }};
#include <tools_speech_text_README_md.cpp.1.inc>
  if (!utterance) GTEST_SKIP() << utterance.error().describe();
  EXPECT_GE(utterance->stretches.size(), 2u);
}

TEST(Blocks, Gltf) {
  const Here here;
  fs::copy(kSamples / "me.glb", "anna.glb");
  std::vector<std::string> notes;
#include <tools_view_gltf_README_md.cpp.1.inc>
  EXPECT_TRUE(head) << head.error().describe();
}

}  // namespace blocks_test
}  // namespace animeme
