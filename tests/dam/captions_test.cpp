// Words of a script, and captions of them.
#include "dam/script/captions.h"

#include <gtest/gtest.h>

#include <random>

#include "dam/script/script.h"
#include "dam/script/textgrid.h"
#include "dam/script/words.h"

namespace animeme::dam {
namespace captions_test {

// A phone for each word: "No|no" has no pause, "Yes! ... no" one of half a second.
Script script_of(const std::vector<std::pair<std::string, double>>& words_and_pauses,
                 double seconds = 0.3) {
  Script script;
  double at = 0;
  for (const auto& [word, pause] : words_and_pauses) {
    script.phones.push_back({at, at + seconds, "AA", word});
    link_phone(script.phones, script.phones.size() - 1, true);
    at += seconds;
    if (pause > 0) script.phones.push_back({at, at + pause, "SIL", ""});
    at += pause;
  }
  return script;
}

std::vector<std::string> texts_of(const std::vector<Caption>& captions) {
  std::vector<std::string> texts;
  for (const Caption& caption : captions) texts.push_back(caption_text(caption));
  return texts;
}

using Texts = std::vector<std::string>;

TEST(ScriptWords, EqualWordsInARowAreWordsOfTheirOwn) {
  const Script script = script_of({{"No", 0}, {"no", 0}, {"no,", 0.1}, {"no,", 0}, {"bye", 0}});
  Script twice = script;
  twice.phones[1].word = "No";
  link_phone(twice.phones, 1, true);
  EXPECT_EQ(twice.phones[1].link, WordLink::again);
  EXPECT_EQ(words_of(twice).size(), 5u);
  twice.phones[1].link = WordLink::automatic;
  EXPECT_EQ(words_of(twice).size(), 4u);
}

TEST(ScriptWords, AWordMayHaveAPauseInside) {
  Script script{{{0, 0.2, "T", "12,50 €"}, {0.2, 0.3, "SIL", ""}, {0.3, 0.5, "AA", "12,50 €"}}};
  EXPECT_EQ(words_of(script).size(), 2u);
  link_phone(script.phones, 2, false);
  EXPECT_EQ(script.phones[2].link, WordLink::continued);
  const auto words = words_of(script);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_EQ(words[0], (ScriptWord{0, 0.5, "12,50 €", 0, 3}));
}

TEST(ScriptWords, FilesKeepThem) {
  Script script = script_of({{"no", 0}, {"no", 0}, {"no", 0.2}, {"no", 0}});
  script.phones.push_back({1.4, 1.5, "SIL", ""});
  script.phones.push_back({1.5, 1.6, "IY", "no", WordLink::continued});
  ASSERT_EQ(words_of(script).size(), 4u);
  for (const char* ending : {".tsv", ".TextGrid"}) {
    const auto read = read_script(write_script(script, ending));
    ASSERT_TRUE(read) << ending << read.error().describe();
    EXPECT_EQ(*read, script) << ending;
  }
}

TEST(Captions, AreSentencesOfALine) {
  // Nobody pauses after "Dr." and "St."; the dash and the comma are places to cut.
  const auto captions = captions_of(script_of({{"Dr.", 0},
                                               {"Smith,", 0.1},
                                               {"who", 0},
                                               {"lives", 0},
                                               {"in", 0},
                                               {"St.", 0},
                                               {"Ives,", 0.1},
                                               {"paid", 0},
                                               {"$5.50 --", 0},
                                               {"really?", 0.3},
                                               {"Yes!", 0.5}}));
  EXPECT_EQ(texts_of(captions),
            (Texts{"Dr. Smith, who lives in St. Ives,", "paid $5.50 -- really?", "Yes!"}));
  EXPECT_NEAR(captions[2].end - captions[2].start, 1, 1e-9);  // it is said in 0.3 s
}

TEST(Captions, ALongClauseTakesTwoLines) {
  const auto captions = captions_of(script_of({{"This", 0},
                                               {"is", 0},
                                               {"one", 0},
                                               {"clause", 0},
                                               {"without", 0},
                                               {"any", 0},
                                               {"punctuation", 0},
                                               {"that", 0},
                                               {"does", 0},
                                               {"not", 0},
                                               {"fit", 0},
                                               {"one", 0},
                                               {"line.", 0}},
                                              0.25));
  EXPECT_EQ(texts_of(captions),
            (Texts{"This is one clause without any\npunctuation that does not fit one line."}));
}

TEST(Captions, ChineseHasNoBlanksAndWideCharacters) {
  std::vector<std::pair<std::string, double>> words;
  for (int i = 0; i < 12; ++i) words.push_back({"你好，", 0});
  const auto captions = captions_of(script_of(words));
  for (const Caption& caption : captions) {
    for (const auto& line : caption.lines) {
      EXPECT_LE(caption_line(line).size() / 3 * 2, 42u);
      EXPECT_EQ(caption_line(line).find(' '), std::string::npos);
    }
  }
  EXPECT_TRUE(blank_between("안녕", "하세요"));
  EXPECT_TRUE(blank_between("你好", "Bob"));
}

TEST(Captions, HoldEveryWordOnceInOrderWithinTheLimits) {
  std::mt19937 random(41);
  const auto below = [&](unsigned n) { return unsigned(random() % n); };
  constexpr const char* kEnds[] = {"", "", "", "", ",", ".", "?", " --", ";", "..."};
  for (int round = 0; round < 300; ++round) {
    std::vector<std::pair<std::string, double>> said;
    const unsigned count = 1 + below(80);
    for (unsigned i = 0; i < count; ++i) {
      std::string word(1 + below(14), char('a' + below(26)));
      word += kEnds[below(10)];
      said.push_back({word, below(4) == 0 ? 0.05 + 0.01 * below(200) : 0});
    }
    const double seconds = 0.1 + 0.01 * below(50);
    const Script script = script_of(said, seconds);
    const auto captions = captions_of(script);
    std::vector<ScriptWord> words;
    double reached = 0;
    for (const Caption& caption : captions) {
      EXPECT_GE(caption.start, reached);
      reached = caption.end;
      EXPECT_LE(caption.end - caption.start, 7 + 1e-9);
      ASSERT_LE(caption.lines.size(), 2u);
      for (const auto& line : caption.lines) {
        EXPECT_LE(caption_line(line).size(), 42u);
        words.insert(words.end(), line.begin(), line.end());
      }
      EXPECT_LE(caption.start, caption.lines.front().front().start);
      EXPECT_GE(caption.end, caption.lines.back().back().end);
    }
    EXPECT_EQ(words, words_of(script));
    // Shorter than a second only where the next word comes at once and cannot be shown, too.
    for (std::size_t i = 0; i + 1 < captions.size(); ++i) {
      const double length = captions[i].end - captions[i].start;
      EXPECT_TRUE(length > 1 - 1e-9 || captions[i].end > captions[i + 1].start - 1e-9);
    }
  }
}

TEST(Captions, WebVttAndSubRip) {
  const Script script = script_of({{"Ben &", 0}, {"Jerry.", 0.5}, {"<Yes>", 0}});
  EXPECT_EQ(write_webvtt(script),
            "WEBVTT\n\n00:00:00.000 --> 00:00:01.400\n<00:00:00.000>Ben &amp; <00:00:00.300>Jerry."
            "<00:00:00.600> <00:00:01.100>&lt;Yes&gt;\n");
  EXPECT_EQ(write_srt(script), "1\n00:00:00,000 --> 00:00:01,400\nBen & Jerry. <Yes>\n");
  const auto read = read_timings(write_webvtt(script));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->labels.size(), 3u);
  EXPECT_EQ(read->labels[1].label, "Jerry.");
  EXPECT_NEAR(read->labels[1].end, 0.6, 1e-9);
  EXPECT_TRUE(captions_of({}).empty());
}

}  // namespace captions_test
}  // namespace animeme::dam
