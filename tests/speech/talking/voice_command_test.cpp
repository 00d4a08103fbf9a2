// Voices that are programs of others: here shell scripts that do as such programs do.
#include "tools/speech/talking/voice_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/program.h"
#include "tools/formats/media/audio.h"

namespace animeme::speech {
namespace voice_command_test {

using testing::HasSubstr;

class VoiceProgram : public testing::Test {
 protected:
  void SetUp() override {
    const media::Pcm pcm{16000, std::vector<float>(8000, 0.25F)};
    ASSERT_TRUE(media::write_wav(dir / "voice.wav", pcm));
    std::ofstream(dir / "times.txt") << "0 0.1 B\n0.1 0.3 AA\n";
  }
  // A voice that runs `script`; "$1" and so on are `arguments`.
  VoiceCommand shell(const std::string& script, const std::string& arguments) const {
    return {.command = "sh -c '" + script + "' voice " + arguments};
  }
  Result<TimedSpeech> speak(const VoiceCommand& voice, const std::string& text = "bah") {
    said.clear();
    tools::Log log;
    log.info = log.warn = [this](const std::string& line) { said += line + "\n"; };
    return run_voice_command(text, voice, log);
  }
  std::string error_of(const VoiceCommand& voice, const std::string& text = "bah") {
    const auto speech = speak(voice, text);
    EXPECT_FALSE(speech);
    return speech ? std::string() : speech.error().describe();
  }
  std::string wav() const { return dir / "voice.wav"; }

  test::TempDir dir;
  std::string said;
};

TEST_F(VoiceProgram, WritesSoundAndSaysTimes) {
  const auto speech = speak(shell("cp " + wav() + " \"$1\"; cat " + (dir / "times.txt"), "{wav}"));
  ASSERT_TRUE(speech) << speech.error().describe();
  EXPECT_EQ(speech->times, TimesFrom::script);
  EXPECT_EQ(speech->speech.voice, "sh");
  EXPECT_EQ(speech->speech.audio.samples.size(), 8000u);
  ASSERT_EQ(speech->speech.script.phones.size(), 3u);
  EXPECT_EQ(speech->speech.script.phones[0].label, "B");
  EXPECT_DOUBLE_EQ(speech->speech.script.duration(), 0.5);  // silence to the end of the sound
}

TEST_F(VoiceProgram, WritesTimesToAFileAndSoundToStandardOutput) {
  const auto speech =
      speak(shell("cp " + (dir / "times.txt") + " \"$1\"; cat " + wav(), "{script}"));
  ASSERT_TRUE(speech) << speech.error().describe();
  EXPECT_EQ(speech->times, TimesFrom::script);
  EXPECT_EQ(speech->speech.audio.samples.size(), 8000u);
}

TEST_F(VoiceProgram, GetsTheTextAsItIsInThreeWays) {
  // What a shell would run, and what stands for other files, stays text.
  const std::string text = "it's \"$(touch " + (dir / "ran") + ")\" {wav} `x` %s";
  const auto speech =
      speak(shell("cat > " + (dir / "in") + "; printf %s \"$2\" > " + (dir / "argument") +
                      "; cp \"$3\" " + (dir / "file") + "; printf %s \"$4\" > " + (dir / "lang") +
                      "; cp " + wav() + " \"$1\"; cat " + (dir / "times.txt"),
                  "{wav} {text} {text_file} {lang}"),
            text);
  ASSERT_TRUE(speech) << speech.error().describe();
  EXPECT_EQ(test::slurp(dir / "in"), text + "\n");
  EXPECT_EQ(test::slurp(dir / "file"), text + "\n");
  EXPECT_EQ(test::slurp(dir / "argument"), text);
  EXPECT_EQ(test::slurp(dir / "lang"), "en");
  EXPECT_FALSE(std::filesystem::exists(dir / "ran"));
}

TEST_F(VoiceProgram, TimesThatWereAskedForHaveToBeThere) {
  VoiceCommand voice = shell("cp " + wav() + " \"$1\"; echo done", "{wav}");
  voice.input.reading.format = "labels";
  EXPECT_THAT(error_of(voice), HasSubstr("what sh says:1"));
  voice = shell("cp " + wav() + " \"$1\"; echo 0 9 AA > \"$2\"", "{wav} {script}");
  EXPECT_THAT(error_of(voice), HasSubstr("the script lasts 9 s"));
}

TEST_F(VoiceProgram, ThatFailsSaysWhy) {
  EXPECT_THAT(error_of(shell("echo no model >&2; exit 4", "{wav}")),
              testing::AllOf(HasSubstr("exit code 4"), HasSubstr("no model")));
  EXPECT_THAT(error_of(shell("kill -SEGV $$", "{wav}")), HasSubstr("signal 11"));
  EXPECT_THAT(error_of(shell("exit 0", "{wav}")), HasSubstr("produced no sound"));
  EXPECT_THAT(error_of(shell("exit 0", "")), HasSubstr("{wav}"));
  EXPECT_THAT(error_of(shell("echo text > \"$1\"", "{wav}")), HasSubstr("the sound of sh"));
  EXPECT_THAT(error_of({.command = "no-such-voice {wav}"}), HasSubstr("no-such-voice"));
  EXPECT_THAT(error_of({.command = "sh 'x"}), HasSubstr("not closed"));
  EXPECT_THAT(error_of(shell("exit 0", "{wav}"), " \n"), HasSubstr("nothing to say"));
  VoiceCommand slow = shell("sleep 30", "{wav}");
  slow.seconds = 0.2;
  EXPECT_THAT(error_of(slow), HasSubstr("took more than 0.2 s"));
}

}  // namespace voice_command_test
}  // namespace animeme::speech
