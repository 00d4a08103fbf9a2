// Visemes as a library: tracks of scripts and faces, the files of Oculus avatars and Rhubarb.
#include "tools/formats/exchange/visemes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

namespace animeme::exchange {
namespace visemes_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const dam::Script kScript{{{0, 0.2, "SIL", ""},
                           {0.2, 0.32, "M", "my"},
                           {0.32, 0.56, "AY", "my"},
                           {0.56, 0.64, "HH", "hello"},
                           {0.64, 0.8, "L", "hello"}}};

std::vector<int> visemes_of(const std::vector<VisemeEvent>& events) {
  std::vector<int> out;
  for (const VisemeEvent& event : events) out.push_back(event.viseme);
  return out;
}

TEST(ExchangeVisemes, EventsOfAScript) {
  const auto events = script_events(kScript);
  EXPECT_THAT(visemes_of(events), ElementsAre(0, 1, 10, 12, 8, 8));
  EXPECT_EQ(events[3].phone, "AY");
  EXPECT_NEAR(events[3].time, 0.44, 1e-12);
  EXPECT_THAT(script_events({}), IsEmpty());
}

TEST(ExchangeVisemes, WeightsAddUpToOne) {
  for (const double crossfade : {0.0, 0.08, 10.0}) {
    const auto track = track_of_events(script_events(kScript), {50, 1}, crossfade);
    ASSERT_TRUE(track) << track.error().describe();
    ASSERT_EQ(track->frames.size(), 40U);
    for (const auto& weights : track->frames) {
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
      EXPECT_GE(*std::min_element(weights.begin(), weights.end()), -1e-12);
    }
    EXPECT_NEAR(track->frames[13][1], 1, 1e-12) << "the lips meet in the middle of M";
  }
}

TEST(ExchangeVisemes, WithoutACrossfadeTheFrameOfABeginHasTheNewViseme) {
  const auto track = track_of_events({{0, 0.2, "P", 1}, {0.2, 0.2, "S", 7}}, {25, 1}, 0);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frames.size(), 10U);
  EXPECT_EQ(track->frames[4][1], 1);
  EXPECT_EQ(track->frames[5][7], 1);
}

TEST(ExchangeVisemes, TracksThatCannotBe) {
  EXPECT_EQ(track_of_events(script_events(kScript), {0, 0}, 0).error().code,
            Code::invalid_argument);
  EXPECT_EQ(track_of_events({{0, 1e300, "AA", 10}}, {25, 1}, 0).error().code, Code::out_of_range);
  EXPECT_THAT(track_of_events({}, {25, 1}, 0)->frames, IsEmpty());
  EXPECT_THAT(track_of_face({{25, 1}, {}, ""}).events, IsEmpty());
}

TEST(ExchangeVisemes, FacesHaveRuns) {
  fap::Sequence clip{{25, 1}, {}, ""};
  for (const int viseme : {0, 1, 11, 11}) {
    for (int i = 0; i < 5; ++i) clip.frames.push_back(fap::viseme_shape(viseme));
  }
  const VisemeTrack track = track_of_face(clip);
  EXPECT_THAT(visemes_of(track.events), ElementsAre(0, 1, 11));
  EXPECT_NEAR(track.events[2].duration, 0.4, 1e-12);
  EXPECT_EQ(track.frames.size(), 20U);
}

TEST(ExchangeVisemes, FilesOfAvatars) {
  const auto track = track_of_events(script_events(kScript), {25, 1}, 0.08);
  ASSERT_TRUE(track);
  const auto json = nlohmann::json::parse(write_visemes_json(*track, "a\"b.wav"));
  EXPECT_EQ(json["audio"], "a\"b.wav");
  EXPECT_EQ(json["rate"], nlohmann::json({25, 1}));
  EXPECT_EQ(json["events"][1]["viseme"], "viseme_PP");
  EXPECT_EQ(json["events"][1]["phone"], "M");
  EXPECT_EQ(json["frames"].size(), 20U);
  const std::string csv = write_visemes_csv(*track);
  EXPECT_THAT(csv, HasSubstr("time_s,viseme_sil,viseme_PP,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  const VisemeTrack nothing{{25, 1}, {}, {}};
  EXPECT_EQ(nlohmann::json::parse(write_visemes_json(nothing))["audio"], nullptr);
}

TEST(ExchangeVisemes, MouthShapesOfRhubarb) {
  const auto track = track_of_events(script_events(kScript), {25, 1}, 0.08);
  ASSERT_TRUE(track);
  EXPECT_EQ(write_rhubarb_tsv(*track), "0.00\tX\n0.20\tA\n0.32\tD\n0.44\tB\n0.64\tH\n0.80\tX\n");
  EXPECT_EQ(write_rhubarb_xml(*track, "a & b.wav"),
            "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<rhubarbResult>\n  <metadata>\n"
            "    <soundFile>a &amp; b.wav</soundFile>\n    <duration>0.80</duration>\n"
            "  </metadata>\n  <mouthCues>\n"
            "    <mouthCue start=\"0.00\" end=\"0.20\">X</mouthCue>\n"
            "    <mouthCue start=\"0.20\" end=\"0.32\">A</mouthCue>\n"
            "    <mouthCue start=\"0.32\" end=\"0.44\">D</mouthCue>\n"
            "    <mouthCue start=\"0.44\" end=\"0.64\">B</mouthCue>\n"
            "    <mouthCue start=\"0.64\" end=\"0.80\">H</mouthCue>\n"
            "  </mouthCues>\n</rhubarbResult>\n");
  EXPECT_EQ(write_rhubarb_dat(*track), "MohoSwitch1\n1 X\n5 A\n8 D\n11 B\n16 H\n20 X\n");
  RhubarbOptions basic;
  basic.extended = "";
  basic.preston_blair = true;
  basic.dat_rate = 10;
  EXPECT_EQ(write_rhubarb_tsv(*track, basic), "0.00\tA\n0.32\tD\n0.44\tB\n0.64\tC\n0.80\tA\n");
  EXPECT_EQ(write_rhubarb_dat(*track, basic), "MohoSwitch1\n1 MBP\n4 AI\n5 etc\n7 E\n9 MBP\n");
  EXPECT_EQ(write_rhubarb_dat({{25, 1}, {}, {}}), "MohoSwitch1\n");
  const auto json = nlohmann::json::parse(write_rhubarb_json(*track, "x.wav"));
  EXPECT_EQ(json["metadata"]["soundFile"], "x.wav");
  EXPECT_EQ(json["mouthCues"].size(), 5U);
  EXPECT_EQ(write_rhubarb_tsv({{25, 1}, {}, {}}), "");
  EXPECT_EQ(nlohmann::json::parse(write_rhubarb_json({{25, 1}, {}, {}}))["mouthCues"].size(), 0U);
}

// No cue that a player's frame could miss, whatever the sounds are, and lips that close do.
TEST(ExchangeVisemes, RhubarbCuesAreNoShorterThanAFrame) {
  std::mt19937 random(7);
  const char* const labels[] = {"SIL", "P", "AA", "F", "L", "T", "UW", "OW", "IY", "M"};
  for (int round = 0; round < 200; ++round) {
    dam::Script script;
    double time = 0;
    for (int i = 0; i < 30; ++i) {
      const double end = time + 0.005 + double(random() % 100) / 1000;
      script.phones.push_back({time, end, labels[random() % 10], ""});
      time = end;
    }
    const auto track = track_of_events(script_events(script), {60, 1}, 0.08);
    ASSERT_TRUE(track);
    const auto cues = nlohmann::json::parse(write_rhubarb_json(*track))["mouthCues"];
    ASSERT_FALSE(cues.empty());
    EXPECT_EQ(cues[0]["start"], 0.0);
    EXPECT_NEAR(cues.back()["end"].get<double>(), time, 0.0051);
    for (std::size_t i = 0; i < cues.size(); ++i) {
      EXPECT_GE(cues[i]["end"].get<double>() - cues[i]["start"].get<double>(), 0.04 - 1e-9);
      if (i == 0) continue;
      EXPECT_EQ(cues[i]["start"], cues[i - 1]["end"]);
      EXPECT_NE(cues[i]["value"], cues[i - 1]["value"]);
    }
  }
}

TEST(ExchangeVisemes, ShortClosuresStayInRhubarbs) {
  const dam::Script script{{{0, 0.2, "AA", ""},
                            {0.2, 0.22, "P", ""},
                            {0.22, 0.4, "IY", ""},
                            {0.4, 0.42, "T", ""},
                            {0.42, 0.6, "UW", ""}}};
  const auto track = track_of_events(script_events(script), {60, 1}, 0.08);
  ASSERT_TRUE(track);
  const std::string text = write_rhubarb_tsv(*track);
  EXPECT_THAT(text, HasSubstr("0.18\tA\n0.22\t"));  // 0.02 s from the vowel before
  EXPECT_THAT(text, HasSubstr("0.42\tF\n"));        // T is left to the vowel before it
}

TEST(ExchangeVisemes, TalkingHeadHasVisemesAndWordsInMilliseconds) {
  const dam::Script script{{{0, 0.2, "SIL", ""},
                            {0.2, 0.3, "AA", "up"},
                            {0.3, 0.32, "P", "up"},
                            {0.32, 0.52, "IY", "\"E\""},
                            {0.52, 0.54, "T", "\"E\""},
                            {0.54, 0.8, "SIL", ""},
                            {0.8, 0.9, "F", "of"}}};
  const auto track = track_of_events(script_events(script), {60, 1}, 0.08);
  ASSERT_TRUE(track);
  const auto json = nlohmann::json::parse(write_talking_head(*track, script, "voice.wav"));
  EXPECT_EQ(json["audio"], "voice.wav");
  EXPECT_EQ(json["words"], (nlohmann::json{"up", "\"E\"", "of"}));
  EXPECT_EQ(json["wtimes"], (nlohmann::json{200, 320, 800}));
  EXPECT_EQ(json["wdurations"], (nlohmann::json{120, 220, 100}));
  // P takes what it lacks from the vowel before it, T is left to the one before.
  EXPECT_EQ(json["visemes"], (nlohmann::json{"aa", "PP", "I", "FF"}));
  EXPECT_EQ(json["vtimes"], (nlohmann::json{200, 280, 320, 800}));
  EXPECT_EQ(json["vdurations"], (nlohmann::json{80, 40, 220, 100}));
  const auto none = nlohmann::json::parse(write_talking_head({{25, 1}, {}, {}}, {}));
  EXPECT_TRUE(none["audio"].is_null());
  EXPECT_EQ(none["visemes"].size() + none["words"].size(), 0U);
}

TEST(ExchangeVisemes, TalkingHeadsCuesAreNoShorterThanAFrame) {
  std::mt19937 random(11);
  const char* const labels[] = {"SIL", "P", "AA", "F", "L", "T", "UW", "OW", "IY", "M"};
  for (int round = 0; round < 200; ++round) {
    dam::Script script;
    double time = 0;
    for (int i = 0; i < 30; ++i) {
      const double end = time + 0.005 + double(random() % 100) / 1000;
      script.phones.push_back({time, end, labels[random() % 10], ""});
      time = end;
    }
    const auto track = track_of_events(script_events(script), {60, 1}, 0.08);
    ASSERT_TRUE(track);
    const auto json = nlohmann::json::parse(write_talking_head(*track, script));
    const std::size_t count = json["visemes"].size();
    ASSERT_EQ(json["vtimes"].size(), count);
    ASSERT_EQ(json["vdurations"].size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_GE(json["vdurations"][i].get<int>(), 40);
      EXPECT_NE(json["visemes"][i], "sil");
      if (i == 0) continue;
      EXPECT_GE(json["vtimes"][i].get<int>(),
                json["vtimes"][i - 1].get<int>() + json["vdurations"][i - 1].get<int>());
    }
  }
}

}  // namespace visemes_test
}  // namespace animeme::exchange
