// A voice alone, as a user has it: speak, follow and export without a text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace animeme {
namespace listen_command_test {

using nlohmann::json;
using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::HasSubstr;
using testing::StartsWith;

void put(std::string& out, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) out += char(value >> (8 * i));
}

std::string wav(const std::string& data, std::uint32_t rate = 16000, std::uint32_t channels = 1) {
  std::string out = "RIFF";
  put(out, std::uint32_t(36 + data.size()), 4);
  out += "WAVEfmt ";
  for (const auto& [value, size] : {std::pair<std::uint32_t, int>{16, 4},
                                    {1, 2},
                                    {channels, 2},
                                    {rate, 4},
                                    {rate * channels * 2, 4},
                                    {channels * 2, 2},
                                    {16, 2}}) {
    put(out, value, size);
  }
  out += "data";
  put(out, std::uint32_t(data.size()), 4);
  return out + data;
}

// A synthetic voice as an .mp4 with sound, which the commands read as a recording.
bool make_voice(const std::string& path) {
  return animeme({"speak", "--text", "Mama may buy a map.", "-o", path}).exit_code == 0;
}

bool deaf() {
  const TempDir dir;
  spill(dir / "a.wav", wav(std::string(32000, '\0')));
  const auto out = animeme({"speak", "--audio", dir / "a.wav", "-o", dir / "a.fap"});
  return out.err.find("cannot") != std::string::npos ||
         out.err.find("install") != std::string::npos;
}

TEST(ListenCommands, SpeakHearsAVoiceAlone) {
  const TempDir dir;
  if (deaf() || !make_voice(dir / "voice.mp4")) GTEST_SKIP() << "no voice or no ears";
  const auto out = animeme({"speak", "--audio", dir / "voice.mp4", "--save-script",
                            dir / "heard.tsv", "--json", "-o", dir / "face.mkv"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json report = json::parse(out.out);
  EXPECT_EQ(report["recognised"], true);
  EXPECT_GT(report["confidence"], 0.3);
  EXPECT_GE(report["heard"].size(), 5u);
  const auto lips =
      std::count_if(report["heard"].begin(), report["heard"].end(), [](const json& one) {
        return one["phone"] == "M" || one["phone"] == "B" || one["phone"] == "P";
      });
  EXPECT_GE(lips, 3);
  EXPECT_THAT(slurp(dir / "heard.tsv"), StartsWith("start_s\tend_s\tphone"));
  // What was heard can be spoken as a script.
  EXPECT_EQ(animeme({"speak", "--script", dir / "heard.tsv", "-o", dir / "again.fap"}).exit_code,
            0);
}

// A recording of Debian, where asterisk-core-sounds-en-g722 is installed: its words are found.
TEST(ListenCommands, EnglishWordsAreFound) {
  const std::string voice = "/usr/share/asterisk/sounds/en_US_f_Allison/invalid.g722";
  if (deaf() || slurp(voice).empty()) {
    GTEST_SKIP() << "no ears, or no asterisk-core-sounds-en-g722";
  }
  const TempDir dir;
  const auto out = animeme({"speak", "--audio", voice, "--save-script", dir / "heard.tsv", "--json",
                            "-o", dir / "face.fap"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json report = json::parse(out.out);
  std::string words;
  for (const json& one : report["words"]) {
    words += one["word"].get<std::string>() + " ";
    EXPECT_LT(one["start"], one["end"]);
    EXPECT_GT(one["confidence"], 0);
  }
  EXPECT_THAT(words, HasSubstr("please try")) << words;
  EXPECT_THAT(slurp(dir / "heard.tsv"), HasSubstr("\tplease\n"));
  // In another language there are none.
  const auto other =
      animeme({"speak", "--audio", voice, "--lang", "it", "--json", "-o", dir / "other.fap"});
  EXPECT_TRUE(json::parse(other.out)["words"].empty());
}

TEST(ListenCommands, StreamSendsAVoiceAlone) {
  const TempDir dir;
  if (deaf() || !make_voice(dir / "voice.mp4")) GTEST_SKIP() << "no voice or no ears";
  const auto out = animeme(
      {"stream", "--audio", dir / "voice.mp4", "--fast", "--to", "udp://127.0.0.1:9", "--json"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const json report = json::parse(out.out);
  EXPECT_GT(report["face"]["units"], 20);
  EXPECT_GT(report["sound"]["units"], 20);
}

TEST(ListenCommands, SilenceIsAStillFace) {
  if (deaf()) GTEST_SKIP() << "no ears";
  const TempDir dir;
  spill(dir / "still.wav", wav(std::string(64000, '\0'), 8000, 2));
  const auto out = animeme({"speak", "--audio", dir / "still.wav", "-o", dir / "still.fap"});
  EXPECT_EQ(out.exit_code, 0);
  EXPECT_THAT(out.err, HasSubstr("no speech was recognised"));
}

TEST(ListenCommands, BadSoundsAreRefused) {
  const TempDir dir;
  spill(dir / "none.wav", "");
  spill(dir / "one.wav", wav("ab"));
  spill(dir / "head.wav", wav(std::string(100, 'x')).substr(0, 30));
  spill(dir / "text.wav", "this is no sound at all, whatever it is called\n");
  for (const char* name : {"none.wav", "one.wav", "head.wav", "text.wav", "missing.wav"}) {
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"speak", "--audio", dir / name, "-o", dir / "x.fap"},
          {"export", dir / name, "-f", "xml", "-o", dir / "x.xml"}}) {
      const auto out = animeme(command);
      EXPECT_EQ(out.exit_code, 3) << command[0] << " " << name << ": " << out.err;
      EXPECT_THAT(out.err, HasSubstr("error:"));
      EXPECT_EQ(slurp(command.back()), "");
    }
  }
  for (const std::string& bytes : {std::string(), std::string("RIFF"), std::string(5000, 'x')}) {
    EXPECT_EQ(animeme({"follow", "--audio", "-"}, bytes).exit_code, 3);
    EXPECT_EQ(animeme({"stream", "--say-audio", "-", "--to", "udp://127.0.0.1:9"}, bytes).exit_code,
              3);
  }
  EXPECT_EQ(animeme({"follow", "--audio", "-", "--pcm", "7"}).exit_code, 2);
  EXPECT_EQ(animeme({"export", dir / "none.wav"}).exit_code, 2);
}

TEST(ListenCommands, FollowGivesAFrameForEveryFortyMilliseconds) {
  if (deaf()) GTEST_SKIP() << "no ears";
  const auto out = animeme({"follow", "--audio", "-", "--pcm", "16000"}, std::string(32000, '\0'));
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.out, StartsWith("time_s,"));
  EXPECT_EQ(std::count(out.out.begin(), out.out.end(), '\n'), 26);
  const auto same = animeme({"follow", "--audio", "-"}, wav(std::string(32000, '\0')));
  EXPECT_EQ(same.out, out.out);
}

TEST(ListenCommands, ExportWritesWhatRhubarbWrites) {
  const TempDir dir;
  if (deaf() || !make_voice(dir / "voice.mp4")) GTEST_SKIP() << "no voice or no ears";
  // The sound without the face.
  const std::string sound = std::string(32000, '\0');
  spill(dir / "voice.wav", wav(sound));
  EXPECT_THAT(animeme({"export", dir / "voice.wav", "-f", "tsv"}).out, StartsWith("0.00\tX"));
  EXPECT_THAT(animeme({"export", dir / "voice.wav", "-f", "xml"}).out,
              HasSubstr("<soundFile>voice.wav</soundFile>"));
  EXPECT_THAT(animeme({"export", dir / "voice.wav", "-f", "dat", "--datUsePrestonBlair"}).out,
              StartsWith("MohoSwitch1\n1 rest\n"));
  const auto read = json::parse(animeme({"export", dir / "voice.wav", "-f", "json"}).out);
  EXPECT_EQ(read["mouthCues"][0]["value"], "X");
  EXPECT_EQ(animeme({"export", dir / "voice.wav", "-o", dir / "v.dat"}).exit_code, 0);
  EXPECT_EQ(animeme({"export", dir / "voice.wav", "-o", dir / "v.visemes.json"}).exit_code, 0);
}

TEST(Hear, IsForHeadsThatLive) {
  const TempDir dir;
  const std::string to = "udp://127.0.0.1:9", wave = dir / "other.wav";
  spill(wave, std::string(2000, 'x'));
  const std::vector<std::vector<std::string>> wrong = {
      {"stream", "--hear", wave, "--to", to},
      {"stream", "--text", "Hello", "--hear", wave, "--to", to},
      {"stream", "--say", "-", "--hear", "-", "--to", to},
      {"stream", "--say", "-", "--hear", wave, "--no-idle-motion", "--to", to},
      {"stream", "--say", "-", "--hear", wave, "--hear-pcm", "7", "--to", to},
      {"stream", "--say", "-", "--hear-pcm", "16000", "--to", to}};
  for (const auto& arguments : wrong) EXPECT_EQ(animeme(arguments, "Hi.").exit_code, 2);
  const auto none =
      animeme({"stream", "--say", "-", "--hear", dir / "none.wav", "--to", to}, "Hi.");
  EXPECT_EQ(none.exit_code, 3) << none.err;
  // A sound that is none is told of, and the head goes on.
  const auto noise = animeme({"stream", "--say", "-", "--hear", wave, "--to", to}, "Hello there.");
  if (noise.err.find("built without") != std::string::npos) return;
  EXPECT_EQ(noise.exit_code, 0) << noise.err;
  EXPECT_THAT(noise.err, testing::HasSubstr("the sound of --hear has ended"));
  const auto samples =
      animeme({"stream", "--say", "-", "--hear", wave, "--hear-pcm", "16000:2", "--to", to},
              "Hello there.");
  EXPECT_EQ(samples.exit_code, 0) << samples.err;
}

}  // namespace listen_command_test
}  // namespace animeme
