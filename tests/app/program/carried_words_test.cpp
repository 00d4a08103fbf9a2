// A talking file carries its words and phones, and commands find them in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "dam/script/script.h"
#include "tests/support/program.h"
#include "tools/formats/media/text_track.h"

namespace animeme {
namespace carried_words_test {

using nlohmann::json;
using test::animeme;
using test::slurp;
using test::spill;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kScript =
    "start_s\tend_s\tphone\tword\n"
    "0\t0.2\tSIL\t\n"
    "0.2\t0.32\tM\tmein\n"
    "0.32\t0.56\tAY\tmein\n"
    "0.56\t0.64\tB\t<b>&\n"
    "0.64\t0.72\tAX\t<b>&\n"
    "0.72\t0.8\tSIL\t\n"
    "0.8\t1\tOW\töde\n";
constexpr const char* kOther = "start_s\tend_s\tphone\tword\n0\t1\tUW\tother\n";

constexpr const char* kShown = "\\u00f6de";  // in the data of a page

class CarriedWords : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    spill(dir_ / "talk.tsv", kScript);
    spill(dir_ / "other.tsv", kOther);
    succeeds({"speak", "--script", dir_ / "talk.tsv", "--lang", "de", "-o", talk_});
    succeeds(
        {"speak", "--script", dir_ / "talk.tsv", "--no-words", "-o", dir_ / ("bare" + ending_)});
  }
  void succeeds(const std::vector<std::string>& arguments) {
    const auto out = animeme(arguments);
    ASSERT_EQ(out.exit_code, 0) << out.err;
  }
  json tracks(const std::string& file) {
    json texts = json::array();
    const json info = json::parse(animeme({"info", file, "--json"}).out);
    for (const json& track : info["tracks"]) {
      if (track["kind"] == "text") {
        texts.push_back(json::array({track["name"], track["language"]}));
      }
    }
    return texts;
  }
  json visemes(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    arguments.insert(arguments.end(), {"-o", dir_ / "out.visemes.json"});
    succeeds(arguments);
    return json::parse(slurp(dir_ / "out.visemes.json"))["events"];
  }
  std::string output(std::vector<std::string> arguments, const std::string& file) {
    arguments.insert(arguments.end(), {"-o", dir_ / file});
    succeeds(arguments);
    return slurp(dir_ / file);
  }

  test::TempDir dir_;
  std::string ending_ = GetParam();
  std::string talk_ = dir_ / ("talk" + ending_), bare_ = dir_ / ("bare" + ending_);
};

TEST_P(CarriedWords, AreTracksBesideTheirCaptionsUnlessUnwanted) {
  const std::string german = "deu";  // Matroska has "ger" for it
  json want = json::array({json::array({"words", german}), json::array({"phones", "zxx"})});
  if (ending_ != ".mp4") want.insert(want.begin(), json::array({"captions", german}));
  EXPECT_EQ(tracks(talk_), want);
  EXPECT_EQ(tracks(bare_), json::array());
  const std::string shown = dir_ / ("shown" + ending_);
  succeeds({"speak", "--script", dir_ / "talk.tsv", "--subtitles", "-o", shown});
  EXPECT_EQ(tracks(shown)[0][0], "captions");
  EXPECT_EQ(tracks(shown).size(), 3u);
}

TEST_P(CarriedWords, OfOtherFormatsAreJoinedToThoseOfTheLanguage) {
  const std::string mp4 = dir_ / "first.mp4", both = dir_ / "both.mp4";
  succeeds({"speak", "--script", dir_ / "talk.tsv", "--lang", "de", "-o", mp4});
  succeeds({"edit", mp4, talk_, "-o", both});
  const json all = tracks(both);
  EXPECT_EQ(std::count(all.begin(), all.end(), json::array({"words", "deu"})), 1) << all;
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](auto& one) { return one[0] == "words"; }), 1);
  const auto texts = media::read_text_tracks(both);
  ASSERT_TRUE(texts);
  const auto words = std::find_if(texts->begin(), texts->end(),
                                  [](const auto& track) { return track.name == "words"; });
  ASSERT_NE(words, texts->end());
  ASSERT_EQ(words->cues.size(), 6u);
  EXPECT_EQ(words->cues[5].text, "öde");
  EXPECT_GT(words->cues[3].start, 1);
}

TEST_P(CarriedWords, OfAScriptWithoutALanguageHaveNone) {
  succeeds({"speak", "--script", dir_ / "talk.tsv", "-o", talk_});
  EXPECT_EQ(tracks(talk_)[0][1], "und");
}

TEST_P(CarriedWords, ComeOutAsTheScriptThatWentIn) {
  succeeds({"demux", talk_, "--script", dir_ / "back.tsv"});
  const auto want = dam::read_script(kScript), got = dam::read_script(slurp(dir_ / "back.tsv"));
  ASSERT_TRUE(want && got);
  ASSERT_EQ(got->phones.size(), want->phones.size());
  for (std::size_t i = 0; i < want->phones.size(); ++i) {
    EXPECT_EQ(got->phones[i].label, want->phones[i].label);
    // SubRip has no way to say that something is no mark of style.
    const bool mark = ending_ == ".mkv" && want->phones[i].word == "<b>&";
    EXPECT_EQ(got->phones[i].word, mark ? "&" : want->phones[i].word);
    EXPECT_NEAR(got->phones[i].start, want->phones[i].start, 0.00051);
    EXPECT_NEAR(got->phones[i].end, want->phones[i].end, 0.00051);
  }
  const auto none = animeme({"demux", bare_, "--script", dir_ / "none.tsv"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("there are no words and phones"));
  // A script is a script, wherever it lies.
  succeeds({"speak", "--script", talk_, "-o", dir_ / "again.fap"});
}

TEST_P(CarriedWords, AreTheSoundsOfVisemes) {
  const json own = visemes({talk_});
  EXPECT_EQ(own.size(), visemes({talk_, "--script", dir_ / "talk.tsv"}).size());
  EXPECT_EQ(own[1]["phone"], "M");
  EXPECT_FALSE(visemes({bare_})[1].contains("phone")) << "what the face shows";
  const json other = visemes({talk_, "--script", dir_ / "other.tsv"});
  EXPECT_EQ(other[0]["phone"], "UW") << "the one that was named counts";
  const json head = json::parse(output({"export", talk_}, "talk.talkinghead.json"));
  EXPECT_EQ(head["words"].size(), 3U);
  EXPECT_EQ(head["words"][2], "öde");
  EXPECT_EQ(head["visemes"][0], "PP");
}

TEST_P(CarriedWords, AreDrawnAndShown) {
  EXPECT_EQ(output({"plot", talk_}, "a.svg"), output({"plot", talk_, "--script", talk_}, "b.svg"));
  EXPECT_NE(output({"plot", talk_}, "a.svg"), output({"plot", bare_}, "b.svg"));
  const std::string page = output({"view", talk_}, "a.html");
  EXPECT_THAT(page, HasSubstr(kShown));
  EXPECT_THAT(page, Not(HasSubstr("<b>&"))) << "what comes from a file is no mark of the page";
  EXPECT_THAT(output({"view", bare_}, "b.html"), Not(HasSubstr(kShown)));
  EXPECT_THAT(output({"view", talk_, "--script", dir_ / "other.tsv"}, "c.html"),
              testing::AllOf(HasSubstr("\"other\""), Not(HasSubstr(kShown))));
}

TEST_P(CarriedWords, GoAlongWithTheFace) {
  succeeds({"speak", "--text", "so", "-o", dir_ / "so.mp4"});
  for (const char* name : {"moved.mp4", "moved.mkv"}) {
    succeeds({"mux", talk_, dir_ / "so.mp4", "-o", dir_ / name});
    const bool captions = std::string(name).ends_with(".mkv");
    EXPECT_EQ(tracks(dir_ / name).size(), captions ? 3U : 2U) << name;
  }
  succeeds({"mux", talk_, dir_ / "so.mp4", "-o", dir_ / "moved.ts"});
  succeeds({"mux", talk_, dir_ / "so.mp4", "--systems", "-o", dir_ / "systems.mp4"});
  succeeds({"render", talk_, "--size", "64x64", "-o", dir_ / "film.mp4"});
  ASSERT_EQ(tracks(dir_ / "film.mp4").size(), 1U);
  EXPECT_EQ(tracks(dir_ / "film.mp4")[0][0], "captions") << "what people read";
  succeeds({"render", talk_, "--size", "64x64", "-o", dir_ / "film.webm"});
}

INSTANTIATE_TEST_SUITE_P(Files, CarriedWords, testing::Values(".mp4", ".mkv", ".m3u8"),
                         [](const auto& file) { return std::string(file.param + 1); });

// Words of a stranger: what they are does not keep the face from being shown.
TEST(CarriedWordsOfOthers, DoNoHarm) {
  if (!test::has_program("mkvmerge")) GTEST_SKIP() << "mkvmerge (mkvtoolnix) is not installed";
  const test::TempDir dir;
  spill(dir / "talk.tsv", kScript);
  ASSERT_EQ(
      animeme({"speak", "--script", dir / "talk.tsv", "--no-words", "-o", dir / "a.mkv"}).exit_code,
      0);
  spill(dir / "bad.srt", "1\n00:00:00,100 --> 00:00:00,300\nno phone </script>\xFF\x1B[2J\n\n");
  ASSERT_EQ(test::run_command({"mkvmerge", "-q", "-o", dir / "b.mkv", dir / "a.mkv", "--track-name",
                               "0:phones", dir / "bad.srt"})
                .exit_code,
            1)
      << "with a warning";
  const auto view = animeme({"view", dir / "b.mkv", "-o", dir / "b.html"});
  EXPECT_EQ(view.exit_code, 0) << view.err;
  EXPECT_THAT(view.err, HasSubstr("its words are ignored"));
  EXPECT_THAT(view.err, Not(HasSubstr("\x1B")));
  // Words alone get their phones by pronunciation; subtitles of another name are nobody's words.
  spill(dir / "words.srt", "1\n00:00:00,200 --> 00:00:00,800\nmoon\n\n");
  for (const char* name : {"Words", "Director's comment"}) {
    ASSERT_EQ(test::run_command({"mkvmerge", "-q", "-o", dir / "c.mkv", dir / "a.mkv",
                                 "--track-name", std::string("0:") + name, dir / "words.srt"})
                  .exit_code,
              0);
    ASSERT_EQ(animeme({"view", dir / "c.mkv", "-o", dir / "c.html"}).exit_code, 0);
    const bool shown = slurp(dir / "c.html").find("\"moon\"") != std::string::npos;
    EXPECT_EQ(shown, std::string(name) == "Words");
  }
}

}  // namespace carried_words_test
}  // namespace animeme
