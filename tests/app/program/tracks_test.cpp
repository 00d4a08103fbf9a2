// Files with several languages and people, through the program: mux --track writes them, the
// commands that read faces take --track.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/program/commands.h"

namespace animeme {
namespace tracks_test {

using test::animeme;
using test::json_of;
using test::slurp;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;

class Tracks : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    for (const auto& [lang, text] : {std::pair("en", "Good morning, my friends."),
                                     {"de", "Guten Morgen, liebe Freunde."},
                                     {"fr", "Bonjour mes amis."}}) {
      const std::string name = dir_ / lang;
      succeeds({"speak", "--text", text, "--lang", lang, "-o", name + ".mp4"});
      const std::string alone = name + "-alone" + GetParam();
      succeeds({"mux", name + ".mp4", name + ".mp4", "--audio-codec", "copy", "-o", alone});
      succeeds({"demux", alone, "-o", name + ".fba", "-o", name + ".wav"});
    }
    succeeds({"mux", "--track", track("en"), "--track", track("de"), "--track",
              track("fr") + ",speaker=Ann", "--audio-codec", "copy", "-o", film_});
  }
  std::string track(const std::string& lang) {
    const std::string file = dir_ / (lang + ".mp4");
    return "lang=" + lang + ",face=" + file + ",audio=" + file;
  }

  TempDir dir_;
  std::string film_ = dir_ / (std::string("film") + GetParam());
};

TEST_P(Tracks, EachLanguageComesBack) {
  for (const char* lang : {"en", "de", "fr"}) {
    const std::string wanted = std::string("lang=") + lang, name = dir_ / lang;
    succeeds({"demux", film_, "--track", wanted, "-o", dir_ / "out.fba", "-o", dir_ / "out.wav",
              "-o", dir_ / "out.TextGrid"});
    EXPECT_TRUE(slurp(dir_ / "out.fba") == slurp(name + ".fba")) << lang;
    EXPECT_TRUE(slurp(dir_ / "out.wav") == slurp(name + ".wav")) << lang;
    succeeds({"decode", film_, "--track", wanted, "-o", dir_ / "out.fap"});
    succeeds({"decode", name + ".fba", "-o", dir_ / "alone.fap"});
    EXPECT_EQ(test::read_clip(dir_ / "out.fap").frames, test::read_clip(dir_ / "alone.fap").frames);
  }
  EXPECT_THAT(slurp(dir_ / "out.TextGrid"), HasSubstr("Bonjour"));
  // The default is the first.
  succeeds({"demux", film_, "-o", dir_ / "out.fba"});
  EXPECT_TRUE(slurp(dir_ / "out.fba") == slurp(dir_ / "en.fba"));
  succeeds({"demux", film_, "--track", "speaker=Ann", "-o", dir_ / "out.fba"});
  EXPECT_TRUE(slurp(dir_ / "out.fba") == slurp(dir_ / "fr.fba"));
}

TEST_P(Tracks, InfoListsThem) {
  const test::Json info = json_of({"info", film_});
  std::string all;
  for (const auto& track : info["tracks"]) {
    all += std::string(track["kind"]) + " " + std::string(track.value("language_tag", "")) + " " +
           std::string(track.value("speaker", "")) + (track["default"] ? "*" : "") + "; ";
  }
  EXPECT_THAT(all, HasSubstr("face en *; face de ; face fr Ann; audio en *; audio de ; "));
}

TEST_P(Tracks, OtherCommandsReadThem) {
  const std::string de = dir_ / "de.fba", alone = dir_ / (std::string("de-alone") + GetParam());
  for (const std::vector<std::string>& line :
       std::vector<std::vector<std::string>>{{"compare", film_, de, "--max-rms", "0"},
                                             {"edit", film_, "-o", dir_ / "edited.fba"},
                                             {"export", film_, "-o", dir_ / "de.csv"},
                                             {"plot", film_, "-o", dir_ / "de.svg"},
                                             {"view", film_, "-o", dir_ / "de.html"}}) {
    std::vector<std::string> all = line;
    all.insert(all.end(), {"--track", "lang=de"});
    const auto result = animeme(all);
    EXPECT_EQ(result.exit_code, 0) << line.front() << ": " << result.err;
  }
  succeeds({"edit", alone, "-o", dir_ / "edited-alone.fba"});
  EXPECT_TRUE(slurp(dir_ / "edited.fba") == slurp(dir_ / "edited-alone.fba"));
}

TEST_P(Tracks, Mistakes) {
  const auto said = [&](std::vector<std::string> line) { return animeme(line); };
  EXPECT_THAT(said({"decode", film_, "--track", "lang=ja", "-o", dir_ / "x.fap"}).err,
              HasSubstr("no track in the language ja"));
  EXPECT_THAT(said({"decode", film_, "--track", "german", "-o", dir_ / "x.fap"}).err,
              HasSubstr("lang=de"));
  EXPECT_THAT(said({"mux", "--track", "lang=de", "-o", dir_ / "x.mp4"}).err,
              HasSubstr("names no file"));
  EXPECT_THAT(said({"mux", "--track", "face=a.fba", "-o", dir_ / "x.mp4"}).err,
              HasSubstr("no language and no speaker"));
  EXPECT_EQ(said({"mux", "-o", dir_ / "x.mp4"}).exit_code, 2);
  EXPECT_EQ(said({"mux", dir_ / "de.fba", "--track", track("en"), "-o", dir_ / "x.mp4"}).exit_code,
            2);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "x.mp4"));
}

INSTANTIATE_TEST_SUITE_P(All, Tracks, testing::Values(".mp4", ".mkv"),
                         [](const auto& param) { return std::string(param.param + 1); });

}  // namespace tracks_test
}  // namespace animeme
