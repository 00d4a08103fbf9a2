// Voices of others through the commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/app/program/commands.h"
#include "tools/formats/media/audio.h"

namespace animeme {
namespace voices_test {

using test::animeme;
using testing::HasSubstr;

class Voices : public testing::Test {
 protected:
  void SetUp() override {
    const media::Pcm pcm{16000, std::vector<float>(16000, 0.25F)};
    ASSERT_TRUE(media::write_wav(wav(), pcm));
    std::ofstream(dir / "times.txt") << "0 0.1 SIL\n0.1 0.3 B\n0.3 0.8 AA\n";
    command = "sh -c 'cp " + wav() + " \"$1\"; cat " + (dir / "times.txt") + "' voice {wav}";
  }
  std::string wav() const { return dir / "voice.wav"; }

  test::TempDir dir;
  std::string command;
};

TEST_F(Voices, SpeakWithOneOfYours) {
  const test::Json json = test::json_of({"speak", "--text", "bah", "--tts", command, "-o",
                                         dir / "a.mp4", "--save-script", dir / "a.tsv"});
  EXPECT_EQ(json["voice"], "sh");
  EXPECT_EQ(json["times"], "script");
  EXPECT_EQ(json["approximate"], false);
  EXPECT_TRUE(json["confidence"].is_null());
  EXPECT_EQ(json["frames"], 25);
  EXPECT_THAT(test::slurp(dir / "a.tsv"), HasSubstr("0.1\t0.3\tB"));
  const auto sound = media::read_audio(dir / "a.mp4");
  ASSERT_TRUE(sound);
  EXPECT_NEAR(sound->duration(), 1, 0.05);
}

TEST_F(Voices, OfWordsWithTimesArePartlyGuessed) {
  std::ofstream(dir / "times.txt") << "[{\"word\": \"Bob\", \"start\": 0.1, \"end\": 0.5}]";
  const auto result =
      animeme({"speak", "--text", "Bob", "--tts", command, "-o", dir / "a.fap", "--json"});
  if (result.exit_code != 0) GTEST_SKIP() << "no pronunciations: " << result.err;
  const test::Json json = test::Json::parse(result.out, nullptr, false);
  EXPECT_EQ(json["times"], "words");
  EXPECT_EQ(json["approximate"], true);
}

// A line of a chat is no option of the voice.
TEST_F(Voices, TextsAreNoOptions) {
  const std::string victim = dir / "victim";
  std::ofstream(victim) << "precious";
  std::ofstream(dir / "voice.sh")
      << "#!/bin/sh\nfor one; do case $one in -w*) echo gone >\"${one#-w}\";; esac; done\ncp " +
             wav() + " \"$1\"\n";
  std::filesystem::permissions(dir / "voice.sh", std::filesystem::perms::owner_all);
  const std::string voice = dir / "voice.sh";
  const auto speak = [&](const std::string& program, const std::string& text) {
    return animeme({"speak", "--text=" + text, "--tts", program, "-o", dir / "a.fap"});
  };
  for (const std::string place : {"{text}", "{text}."}) {
    const auto result = speak(voice + " {wav} " + place, "-w" + victim);
    EXPECT_EQ(result.exit_code, 3) << place;
    EXPECT_THAT(result.err, HasSubstr("would be an option")) << place;
    EXPECT_THAT(result.err, HasSubstr("--text=" + place)) << place;
  }
  EXPECT_EQ(test::slurp(victim), "precious");
  // Behind -- and joined to an option it is a text.
  EXPECT_THAT(speak("sh -c 'echo \"$2\" >&2; exit 1' voice -- {text}", "-5 degrees").err,
              HasSubstr("it said: -5 degrees"));
  EXPECT_THAT(speak("sh -c 'echo \"$1\" >&2; exit 1' voice --text={text}", "-5 degrees").err,
              HasSubstr("it said: --text=-5 degrees"));
}

// The text and the sound of a user do not stay behind, however the program ends.
TEST_F(Voices, TemporaryFilesGoWithTheProgram) {
  namespace fs = std::filesystem;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string folder = dir / ("tmp" + std::to_string(number));
    fs::create_directory(folder);
    // Of a process that was killed long ago, and of others.
    for (const char* name : {"animeme-999999999-old", "animeme-1-running", "other"}) {
      fs::create_directory(folder + "/" + name);
      fs::last_write_time(folder + "/" + name,
                          fs::file_time_type::clock::now() - std::chrono::hours(30));
    }
    const std::string line =
        "TMPDIR='" + folder + "' timeout --preserve-status -s " + std::to_string(number) +
        " 1.5 '" + std::string(test::kBinaryFolder) +
        "/bin/animeme' speak --text bah --tts \"sh -c 'mkdir \\$(dirname \\$1)/sub; "
        "echo x >\\$(dirname \\$1)/sub/y; sleep 20' voice {wav}\" -o '" +
        (dir / "a.fap") + "' 2>/dev/null";
    EXPECT_NE(std::system(line.c_str()), 0);
    std::vector<std::string> left;
    for (const auto& one : fs::directory_iterator(folder)) left.push_back(one.path().filename());
    EXPECT_THAT(left, testing::UnorderedElementsAre("animeme-1-running", "other")) << number;
  }
}

TEST_F(Voices, LeaveNothingWhereTheyFail) {
  const auto result = animeme(
      {"speak", "--text", "bah", "--tts", "sh -c 'echo no key >&2; exit 1'", "-o", dir / "a.mp4"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("it said: no key"));
  EXPECT_FALSE(std::filesystem::exists(dir / "a.mp4"));
  EXPECT_EQ(animeme({"speak", "--script", "x", "--tts", "x", "-o", "a.fap"}).exit_code, 2);
  EXPECT_EQ(animeme({"speak", "--text", "x", "--tier", "x", "-o", "a.fap"}).exit_code, 2);
}

TEST_F(Voices, PushPiecesToALiveHead) {
  const std::string pieces =
      "{\"file\": \"" + wav() + "\", \"script\": \"0 0.2 B\\n0.2 0.9 AA\"}\n" + "{\"file\": \"" +
      wav() + "\", \"script\": \"nothing\"}\n" + "{\"script\": [{\"word\"]}\n" + "{\"file\": \"" +
      wav() + "\", \"script\": \"0 0.2 M\\n0.2 0.9 AA\"}\n";
  const auto result =
      animeme({"stream", "--say-json", "-", "--to", "udp://127.0.0.1:9", "--json"}, pieces);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const test::Json json = test::Json::parse(result.out, nullptr, false);
  EXPECT_EQ(json["lines"], 3) << "sound is never left out";
  EXPECT_NEAR(json["seconds"].get<double>(), 3.1, 0.25);
  EXPECT_THAT(result.err, testing::AllOf(HasSubstr("line 2, \"\": its script cannot be read"),
                                         HasSubstr("line 3")));
}

TEST_F(Voices, SpeakLinesOfALiveHead) {
  const auto result = animeme(
      {"stream", "--say", "-", "--tts", command, "--to", "udp://127.0.0.1:9", "--json"}, "bah\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const test::Json json = test::Json::parse(result.out, nullptr, false);
  EXPECT_EQ(json["lines"], 1);
}

}  // namespace voices_test
}  // namespace animeme
