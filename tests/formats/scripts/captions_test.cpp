// Subtitles as sites, recognisers and people write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace captions_test {

using testing::HasSubstr;

std::string read(const std::string& text, const dam::ScriptOptions& options = {}) {
  const auto timings = read_labels(text, options);
  if (!timings) return timings.error().describe();
  std::string out;
  for (const dam::TimedLabel& label : timings->labels) {
    if (label.label.empty()) continue;
    out += (out.empty() ? "" : " | ") + label.label + (label.is_word ? " " : "! ") +
           std::to_string(std::llround(label.start * 1000)) + "-" +
           std::to_string(std::llround(label.end * 1000));
  }
  return out;
}

// Automatic captions of YouTube: a line of one blank first, each line shown again twice.
TEST(Captions, ThatRollAreReadOnce) {
  const std::string head = "WEBVTT\nKind: captions\nLanguage: en\n\n";
  EXPECT_EQ(
      read(head + "00:00:00.160 --> 00:00:02.070 align:start position:0%\n \n"
                  "my<00:00:00.480><c> puppy</c><00:00:00.960><c> bob</c>\n\n"
                  "00:00:02.070 --> 00:00:02.080 align:start position:0%\nmy puppy bob\n \n\n"
                  "00:00:02.080 --> 00:00:03.070 align:start position:0%\nmy puppy bob\nno\n\n"
                  "00:00:03.070 --> 00:00:03.080 align:start position:0%\nno\n \n\n"
                  "00:00:03.080 --> 00:00:04.000\nno\nno<00:00:03.500><c> pool</c>\n\n"
                  "00:00:04.000 --> 00:00:06.000 align:start position:0%\nno pool\n[Music]\n"),
      "my 160-480 | puppy 480-960 | bob 960-2070 | no 2080-3070 | no 3080-3500 | pool "
      "3500-4000");
  // The same as SubRip, without times of words.
  EXPECT_EQ(read("1\n00:00:00,000 --> 00:00:02,000\n \nmy puppy\n\n"
                 "2\n00:00:02,000 --> 00:00:02,010\nmy puppy\n \n\n"
                 "3\n00:00:02,010 --> 00:00:04,000\nmy puppy\nis blue\n\n"
                 "4\n00:00:04,000 --> 00:00:04,010\nis blue\n \n\n"
                 "5\n00:00:04,010 --> 00:00:06,000\nis blue\nis blue\n"),
            "my puppy 0-2000 | is blue 2010-4000 | is blue 4010-6000");
}

TEST(Captions, RepeatWhatIsSaidTwice) {
  EXPECT_EQ(read("1\n00:00:00,000 --> 00:00:01,000\nNo.\n\n2\n00:00:01,000 --> 00:00:02,000\nNo.\n"
                 "\n3\n00:00:02,000 --> 00:00:03,000\nNo.\nBye.\n"),
            "No. 0-1000 | No. 1000-2000 | No. Bye. 2000-3000");
}

TEST(Captions, BlankLinesDoNotEndACue) {
  const std::string want = "Hi Bob 0-1000 | bye 1000-2000";
  EXPECT_EQ(
      read("WEBVTT\n\n00:00.000 --> 00:01.000\n\t\nHi\n \nBob\n\n00:01.000 --> 00:02.000\nbye\n"),
      want);
  // SubRip whose text stands below an empty line, and one that parts cues by blanks.
  EXPECT_EQ(read("1\n00:00:00,000 --> 00:00:01,000\n\nHi Bob\n\n2\n00:00:01,000 --> "
                 "00:00:02,000\n\nbye\n"),
            want);
  EXPECT_EQ(
      read("1\n00:00:00,000 --> 00:00:01,000\nHi Bob\n \n2\n00:00:01,000 --> 00:00:02,000\nbye\n"),
      want);
  // An empty cue of WebVTT is one; a comment is no text.
  EXPECT_EQ(
      read("WEBVTT\n\n00:00.000 --> 00:01.000\n\nNOTE bad\n\nx\n00:01.000 --> 00:02.000\nbye\n"),
      "bye 1000-2000");
}

TEST(Captions, CharacterReferencesAreCharacters) {
  EXPECT_EQ(read("WEBVTT\n\n00:00.000 --> 00:02.000\nI don&#39;t &quot;know&quot; "
                 "a&#x26;b&nbsp;caf&eacute; &hellip;"
                 " &#146;s &copy &bad; AT&T &#0;x &#x110000;\n"),
            "I don't \"know\" a&b café … ’s &copy &bad; AT&T  x \xEF\xBF\xBD 0-2000");
}

TEST(Captions, SpeakersAreChosen) {
  const std::string two =
      "WEBVTT\n\n00:00.000 --> 00:02.000\n<v Ann>Hi Bob\n\n"
      "00:01.000 --> 00:03.000\n<v.loud Bob Smith>Hi <b>Ann</b></v>\n\n"
      "00:04.000 --> 00:05.000\n<v Ann>bye</v> <v Bob Smith>so long</v>\n";
  dam::ScriptOptions options;
  options.speaker = "ann";
  EXPECT_EQ(read(two, options), "Hi Bob 0-2000 | bye 4000-5000");
  options.speaker = "Bob Smith";
  EXPECT_EQ(read(two, options), "Hi Ann 1000-3000 | so long 4000-5000");
  options.speaker = "Pam";
  EXPECT_THAT(read(two, options), HasSubstr("its speakers are \"Ann\", \"Bob Smith\""));
  // One face says one at a time.
  EXPECT_EQ(read(two), "Hi Bob 0-1000 | Hi Ann 1000-3000 | bye so long 4000-5000");
  const auto timings = read_labels(two);
  ASSERT_TRUE(timings && timings->notes.size() == 1);
  EXPECT_THAT(timings->notes[0].describe(),
              HasSubstr("line 3: \"Hi Bob\" is cut where \"Hi Ann\""));
  EXPECT_THAT(timings->notes[0].describe(), HasSubstr("--speaker"));
}

TEST(Captions, WithoutTimeAreLeftOut) {
  const std::string text =
      "\xEF\xBB\xBF"
      "1\n00:00:01,000 --> 00:00:02,500  X1:117 X2:619 Y1:042 Y2:428\nBob, my puppy\n\n\n"
      "2\n00:00:02,500 --> 00:00:02,500\nzero\n\n3\n00:00:02,400 --> 00:00:04,000\noverlaps a "
      "little\n";
  EXPECT_EQ(read(text), "Bob, my puppy 1000-2400 | overlaps a little 2400-4000");
  const auto timings = read_labels(text);
  ASSERT_TRUE(timings && timings->notes.size() == 2);
  EXPECT_EQ(timings->notes[0].describe(), "line 7: \"zero\" takes no time and is left out");
  EXPECT_THAT(timings->notes[1].describe(), HasSubstr("\"Bob, my puppy\" is cut"));
}

// Words that look like phones are words where a format holds words.
TEST(Captions, HoldWords) {
  EXPECT_EQ(read("1\n00:00:00,500 --> 00:00:01,000\nOh\n\n2\n00:00:01,000 --> 00:00:01,500\nno\n\n"
                 "3\n00:00:01,500 --> 00:00:02,000\nBob\n"),
            "Oh 500-1000 | no 1000-1500 | Bob 1500-2000");
  EXPECT_EQ(read("WEBVTT phones\n\n00:00.000 --> 00:00.500\n<00:00.000>B <00:00.250>AA\n"),
            "B! 0-250 | AA! 250-500");
}

TEST(Captions, OfSubViewer) {
  EXPECT_EQ(
      read("0:00:01.000,0:00:02.200\nBob my puppy\n\n0:00:03.000,0:00:04.200\nPam, my kitten\n"),
      "Bob my puppy 1000-2200 | Pam, my kitten 3000-4200");
}

// Nobody says 10 MB in a cue. It is refused where it stands, in any format.
TEST(Captions, ACueHoldsWhatSomebodyCanSay) {
  const auto with = [](std::size_t bytes) {
    std::string text;
    while (text.size() + 6 <= bytes) text += "hello ";
    return text + "end";
  };
  const auto files = [](const std::string& text) {
    return std::vector<std::string>{
        "1\n00:00:00,000 --> 00:00:05,000\n" + text + "\n",
        "WEBVTT\n\n00:00.000 --> 00:05.000\n" + text + "\n",
        "0:00:00.000,0:00:05.000\n" + text + "\n",
        R"([{"start": 0, "end": 5, "word": ")" + text + "\"}]",
        "<tt xmlns=\"http://www.w3.org/ns/ttml\"><body><div><p begin=\"0s\" end=\"5s\">" + text +
            "</p></div></body></tt>",
        "[00:00.00]" + text + "\n[00:05.00]\n",
    };
  };
  for (const std::string& file : files(with(90'000))) {
    EXPECT_TRUE(read_labels(file, {})) << file.substr(0, 60);
  }
  for (const std::string& file : files(with(1'000'000))) {
    const auto read = read_labels(file, {});
    ASSERT_FALSE(read) << file.substr(0, 60);
    EXPECT_EQ(read.error().code, Code::out_of_range) << read.error().describe();
    EXPECT_THAT(read.error().describe(), HasSubstr("split it into phrases"));
  }
  // Times between the syllables are no text.
  std::string timed = "WEBVTT\n\n00:00.000 --> 60:00.000\n";
  for (int i = 0; i < 3000; ++i) {
    char tag[32];
    std::snprintf(tag, sizeof tag, "<%02d:%02d.000>", i / 60, i % 60);
    timed += tag + std::string("<c> word</c>");
  }
  EXPECT_TRUE(read_labels(timed + "\n", {}));
}

}  // namespace captions_test
}  // namespace animeme::scripts
