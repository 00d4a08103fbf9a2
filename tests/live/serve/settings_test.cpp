#include "tools/live/serve/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace animeme::test {
namespace settings_test {

using serve::HeadSettings;
using testing::HasSubstr;
using tools::Json;

Result<HeadSettings> read(const char* text) { return serve::read_settings(*Json::parse(text), {}); }

TEST(HeadSettings, EveryMemberIsReadAndWritten) {
  const char* text =
      R"({"model":"m","lang":"de+f2","speed":150,"pitch":70,"tts":"t","voice_rate":24000,"head":"h","rate":"29.97","style":1.2,)"
      R"("sharpness":2.0,"articulate":0.5,"symmetric":false,"idle_motion":false,"tongue":false,"over":"take","keep":"lips=0.5","mood":"anger:0.5","seed":9,)"
      R"("liveliness":0.5,"still":"gaze,brows","look":"20,-5","intra_seconds":2.0,"encoder_delay":1.5,"quant":3,)"
      R"("sound":false,"audio_codec":"aac","audio_bitrate":64000,"audio_effort":10,"audio_fec":20})";
  const Result<HeadSettings> settings = read(text);
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(serve::settings_json(*settings), *Json::parse(text));
  EXPECT_EQ(settings->voice.language, "de+f2");
  EXPECT_EQ(settings->motion.rate, (fap::Rate{30000, 1001}));
  EXPECT_EQ(settings->audio.codec, media::AudioCodec::aac);
}

TEST(HeadSettings, WhatIsWrittenIsReadAgain) {
  const Json json = serve::settings_json({});
  const Result<HeadSettings> settings = serve::read_settings(json, {});
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(serve::settings_json(*settings), json);
  EXPECT_EQ(json["audio_fec"], "auto");
  const Result<HeadSettings> nothing = read("{}");
  ASSERT_TRUE(nothing);
  EXPECT_EQ(serve::settings_json(*nothing), json);
}

TEST(HeadSettings, FaultsNameTheMember) {
  const std::pair<const char*, const char*> faults[] = {
      {R"([])", "JSON object"},
      {R"({"pitch": 101})", "\"pitch\" is a whole number from 0 to 100"},
      {R"({"pitch": "high"})", "\"pitch\""},
      {R"({"speed": 79})", "\"speed\""},
      {R"({"style": null})", "\"style\" is a number"},
      {R"({"rate": 101})", "\"rate\""},
      {R"({"rate": "1000"})", "\"rate\" is from 1 to 100"},
      {R"({"rate": "1/1000000"})", "\"rate\" is from 1 to 100"},
      {R"({"rate": "often"})", "\"rate\""},
      {R"({"lang": 7})", "\"lang\" is a text"},
      {R"({"idle_motion": "yes"})", "\"idle_motion\" is true or false"},
      {R"({"mood": "joyous day"})", "\"mood\": there is no mood \"joyous day\""},
      {R"({"keep": "ears"})", "\"keep\": 'ears' is not PART=SHARE"},
      {R"({"keep": "nape=1"})", "\"keep\": 'nape' is no part of the face"},
      {R"({"over": 1})", "\"over\" is a text"},
      {R"({"mood": 1})", "\"mood\" is a text"},
      {R"({"seed": 1e10})", "\"seed\""},
      {R"({"encoder_delay": 11})", "\"encoder_delay\" is a number from 0 to 10"},
      {R"({"liveliness": 2.5})", "\"liveliness\" is a number from 0 to 2"},
      {R"({"still": "ears"})", "\"still\": \"ears\" is no part"},
      {R"({"look": "up"})", "\"look\": \"up\" is no target"},
      {R"({"look": "0,90"})", "\"look\": eyes and head reach"},
      {R"({"seed": 1.5})", "\"seed\""},
      {R"({"audio_effort": 11})", "\"audio_effort\""},
      {R"({"audio_fec": 51})", "\"audio_fec\""},
      {R"({"audio_fec": "some"})", "\"audio_fec\" is \"auto\" or a number from 0 to 50"},
      {R"({"audio_codec": "mp3"})", "\"audio_codec\" is \"opus\" or \"aac\""},
      {R"({"Pitch": 50})", "no \"Pitch\"; there are articulate, audio_bitrate"}};
  for (const auto& [text, sentence] : faults) {
    const Result<HeadSettings> settings = read(text);
    ASSERT_FALSE(settings) << text;
    EXPECT_EQ(settings.error().code, Code::invalid_argument);
    EXPECT_THAT(settings.error().message, HasSubstr(sentence));
  }
}

TEST(HeadSettings, Names) {
  for (const char* name : {"a", "anna-2", "A_b.c", "0"}) EXPECT_TRUE(serve::is_head_name(name));
  for (const char* name : {"", ".", ".a", "a/b", "a b", "\xC3\xA4", "a?", "a%"}) {
    EXPECT_FALSE(serve::is_head_name(name)) << name;
  }
  EXPECT_FALSE(serve::is_head_name(std::string(65, 'a')));
  EXPECT_FALSE(serve::is_head_name(std::string_view("a\0b", 3)));
}

TEST(HeadList, OfAFile) {
  const TempDir folder;
  const auto list = [&](const std::string& text) {
    const std::string path = folder.file("heads.json");
    spill(path, text);
    return serve::read_head_list(path, {});
  };
  const auto good = list(R"({"defaults": {"pitch": 40}, "heads": [{"name": "a", "seed": 2},
                            {"name": "b", "pitch": 60}]})");
  ASSERT_TRUE(good) << good.error().describe();
  ASSERT_EQ(good->heads.size(), 2U);
  EXPECT_EQ(good->heads[0].first, "a");
  EXPECT_EQ(good->heads[0].second.voice.pitch, 40);
  EXPECT_EQ(good->heads[1].second.voice.pitch, 60);
  EXPECT_EQ(good->defaults.voice.pitch, 40);
  for (const char* text :
       {"", "[]", "{\"heads\": 1}", "{\"heads\": [{}]}", "{\"heads\": [1]}", "{\"heads\": [",
        R"({"heads": [{"name": "a"}, {"name": "a"}]})", R"({"heads": [{"name": "a/b"}]})",
        R"({"heads": [{"name": "a", "x": 1}]})", R"({"defaults": [], "heads": []})"}) {
    const auto bad = list(text);
    ASSERT_FALSE(bad) << text;
    EXPECT_THAT(bad.error().describe(), HasSubstr("heads.json"));
  }
}

}  // namespace settings_test
}  // namespace animeme::test
