// Lists of words as recognisers write them: times in other units, words without times, speakers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dam/script/script.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace words_test {

using testing::HasSubstr;

std::string read(const std::string& text, const dam::ScriptOptions& options = {}) {
  const auto timings = read_labels(text, options);
  if (!timings) return timings.error().describe();
  std::string out;
  for (const dam::TimedLabel& label : timings->labels) {
    out += (out.empty() ? "" : " ") + label.label + " " +
           std::to_string(std::llround(label.start * 1000)) + "-" +
           std::to_string(std::llround(label.end * 1000));
  }
  return out;
}

std::string note(const std::string& text, const dam::ScriptOptions& options = {}) {
  const auto timings = read_labels(text, options);
  return timings && timings->notes.size() == 1 ? timings->notes[0].describe() : "no single note";
}

// AssemblyAI and others count milliseconds and do not say so.
TEST(TimeUnits, NobodySaysAWordForMinutes) {
  const std::string want = "Bob 200-550 my 550-850 puppy 850-1400";
  const std::string json = R"({"words": [{"text": "Bob", "start": 200, "end": 550},
    {"text": "my", "start": 550, "end": 850}, {"text": "puppy", "start": 850, "end": 1400}]})";
  for (const std::string& text :
       {json, std::string("200 550 Bob\n550 850 my\n850 1400 puppy\n"),
        std::string("a 1 200 350 Bob\na 1 550 300 my\na 1 850 550 puppy\n"),
        std::string("start\tend\tword\n200\t550\tBob\n550\t850\tmy\n850\t1400\tpuppy\n"),
        std::string("File type = \"ooTextFile\"\n\"TextGrid\" 0 1600 <exists> 1 \"IntervalTier\" "
                    "\"words\" 0 1600 3 200 550 \"Bob\" 550 850 \"my\" 850 1400 \"puppy\"")}) {
    EXPECT_EQ(read(text), want) << text;
    EXPECT_THAT(note(text), HasSubstr("taken for milliseconds")) << text;
  }
  dam::ScriptOptions told;
  told.format = "words";
  told.rate = 1;
  EXPECT_EQ(read(json, told), "Bob 200000-550000 my 550000-850000 puppy 850000-1400000");
  told.rate = 100;
  EXPECT_EQ(read(json, told), "Bob 2000-5500 my 5500-8500 puppy 8500-14000");
  // Phones of aligners that count milliseconds, and samples as before.
  EXPECT_EQ(read("0 80 b\n80 200 aa\n200 290 b\n"), "b 0-80 aa 80-200 b 200-290");
  EXPECT_EQ(read("0 1600 b\n1600 3200 aa\n"), "b 0-100 aa 100-200");
  EXPECT_THAT(note(R"([{"word": "a", "start": 0.5, "end": 40.2}])"), HasSubstr("words@1000"));
  EXPECT_TRUE(read_labels("0 2 aa\n2 4 b\n")->notes.empty());
  // The usual word counts, not those in the middle that are held.
  std::string held;
  for (int i = 0; i < 40; ++i) {
    const bool is_long = i >= 15 && i < 26;
    held += std::to_string(60 * i) + " " + std::to_string(60 * i + (is_long ? 59 : 1)) + " oh\n";
  }
  EXPECT_TRUE(read_labels(held)->notes.empty());
}

// Subtitles whose end is a slip of the pen; phones of aligners are another matter.
TEST(TimeUnits, AWordThatEndsBeforeItBeginsIsSaid) {
  const std::string srt =
      "1\n00:00:00,300 --> 00:00:02,000\nBom dia!\n\n"
      "2\n00:00:03,000 --> 00:00:02,500\nErrado\n\n"
      "3\n00:00:04,000 --> 00:00:05,000\nordem\n\n"
      "4\n00:00:04,800 --> 00:00:00,900\nno fim\n";
  EXPECT_EQ(read(srt), "Bom dia! 300-2000 Errado 3000-3420 ordem 4000-4800 no fim 4800-5220");
  EXPECT_EQ(read("start\tend\tword\n0.5\t0.9\ta\n1\t0.2\tmother\n1.1\t1.5\tb\n"),
            "a 500-900 mother 1000-1100 b 1100-1500");
  const auto timings = read_labels(srt, {});
  ASSERT_EQ(timings->notes.size(), 2u);  // the third one is cut
  EXPECT_EQ(timings->notes[1].kind, dam::ScriptNote::Kind::given_times);
  EXPECT_THAT(timings->notes[1].describe(), HasSubstr("line 6: \"Errado\" ends before it begins"));
  EXPECT_EQ(timings->notes[1].count, 2u);
  const auto phones = dam::read_script("0 0.1 b\n0.1 0.05 aa\n0.2 0.3 b\n");
  ASSERT_FALSE(phones);
  EXPECT_THAT(phones.error().message, HasSubstr("not after its start"));
}

// WhisperX gives no times to what it cannot align: numbers, for the most part.
TEST(WordsWithoutTimes, AreSaidBetweenTheirNeighbours) {
  EXPECT_EQ(read(R"({"segments": [
      {"start": 1.0, "end": 3.0, "words": [{"word": "In"}, {"word": "2014"},
        {"word": "we", "start": 2.4, "end": 2.6, "score": 0.9}]},
      {"start": 5.0, "end": 9.0, "words": [{"word": "saw", "start": 5.0, "end": 5.4, "score": 0.9},
        {"word": "42"}]}]})"),
            "In 1000-1156 2014 1156-2400 we 2400-2600 saw 5000-5400 42 5400-6000");
  EXPECT_THAT(note(R"([{"word": "a", "start": 0, "end": 1}, {"word": "b c"},
                       {"word": "d", "start": 1.2, "end": 2}])"),
              HasSubstr("line 1: \"b c\" has no times"));
  // In front of the first, behind the last, and where there is no room at all.
  EXPECT_EQ(read(R"([{"word": "hello"}, {"word": "a", "start": 3, "end": 3.5}, {"word": "x"},
                     {"word": "b", "start": 3.5, "end": 4}])"),
            "hello 2625-3000 a x 3000-3500 b 3500-4000");
}

TEST(WordLists, TellSpeakersApart) {
  dam::ScriptOptions options;
  options.speaker = "s2";
  EXPECT_EQ(read(R"({"segments": [
      {"speaker": "S1", "words": [{"word": "hi", "start": 0, "end": 1}]},
      {"words": [{"word": "ho", "start": 1, "end": 2, "speaker": "S2"}]}]})",
                 options),
            "ho 1000-2000");
  options.speaker = "1";
  EXPECT_EQ(read(R"({"monologues": [
      {"speaker": 0, "elements": [{"type": "text", "value": "hi", "ts": 0, "end_ts": 1}]},
      {"speaker": 1, "elements": [{"type": "text", "value": "ho", "ts": 0.5, "end_ts": 2}]}]})",
                 options),
            "ho 500-2000");
  EXPECT_EQ(read(R"({"words": [{"word": "hi", "start": 0, "end": 1}]})", options),
            "the script does not say who speaks; leave out --speaker");
}

// Words of two channels, one after the other, are one talk.
TEST(WordLists, AreSortedAndDoNotOverlap) {
  const std::string two = R"({"results": {"channels": [
      {"alternatives": [{"words": [{"word": "hi", "start": 0, "end": 1.2},
                                   {"word": "Bob", "start": 3, "end": 4}]}]},
      {"alternatives": [{"words": [{"word": "ho", "start": 1, "end": 2}]}]}]}})";
  EXPECT_EQ(read(two), "hi 0-1000 ho 1000-2000 Bob 3000-4000");
  EXPECT_THAT(note(two), HasSubstr("\"hi\" is cut where \"ho\" begins"));
}

TEST(WordLists, OfPiecesAndSyllables) {
  EXPECT_EQ(read("[00:01.00]<00:01.00>pup<00:01.40>py <00:01.80>Bob's <00:02.20>\n"),
            "puppy 1000-1800 Bob's 1800-2200");
  EXPECT_EQ(
      read("Dialogue: 0,0:00:01.00,0:00:02.00,D,,0,0,0,,{\\k20}日{\\k20}本{\\k30} ka{\\k30}wa\n"),
      "日 1000-1200 本 1200-1400 kawa 1400-2000");
}

// What begins with a bracket is not JSON for that.
TEST(WordLists, AreNotTakenForJson) {
  EXPECT_EQ(read("[00:12.00]Pam my kitten\n[00:20.00]\n"), "Pam my kitten 12000-13500");
  EXPECT_THAT(read("[Intro] some text\n"), HasSubstr("not a phoneme script"));
  EXPECT_EQ(read("{ 80\nb 60\n"), "{ 0-80 b 80-140");
  EXPECT_THAT(read("[1, 2"), HasSubstr("begins like JSON"));
  EXPECT_THAT(read("{\"words\": ["), HasSubstr("begins like JSON"));
}

TEST(Messages, NameNoPhoneForWhatIsNone) {
  const auto wrong = [](const std::string& label) {
    const auto script =
        dam::read_script("start\tend\tphone\n0\t1\tAA1\n1\t2\tB\n2\t3\t" + label + "\n");
    return script ? std::string("read") : script.error().message;
  };
  EXPECT_THAT(wrong("AOO"), HasSubstr("nearest ARPAbet label is AO"));
  EXPECT_THAT(wrong("zebra"), HasSubstr("neither a sound of ARPAbet nor a mark"));
  EXPECT_EQ(wrong("[loud"), "read");
  EXPECT_EQ(wrong("BACKGROUND_NOISE"), "read");
}

}  // namespace words_test
}  // namespace animeme::scripts
