#include "tools/speech/text/mood_marks.h"

#include <gtest/gtest.h>

namespace animeme::text {
namespace mood_marks_test {

std::string shown(const std::string& text) {
  const std::u32string source = code_points(text);
  std::string all;
  for (const MoodPlace& place : find_moods(source)) {
    all += all.empty() ? "" : " | ";
    all += place.mood ? place.mood->name : "*";
    if (place.gain != 1) all += place.gain > 1.3 ? "!!" : "!";
    all +=
        " [" + utf8(source.substr(place.place.first, place.place.last - place.place.first)) + "]";
  }
  return all;
}

TEST(MoodMarks, EmojiAreForTheWordsInFrontOfThem) {
  EXPECT_EQ(shown("Hello. This is all."), "");
  EXPECT_EQ(shown("Great news 😀"), "joy [Great news 😀]");
  EXPECT_EQ(shown("Oh no. 😢 But now it is fine. 😊"),
            "sadness [Oh no. 😢 ] | friendly [But now it is fine. 😊]");
  EXPECT_EQ(shown("I am happy 😀 but the dog is ill 😢 you know"),
            "joy [I am happy 😀 ] | sadness [but the dog is ill 😢 ]");
  EXPECT_EQ(shown("One. Two 😡"), "anger [Two 😡]") << "not for the sentence before";
  EXPECT_EQ(shown("Ask Dr. No 🤔"), "thinking [Ask Dr. No 🤔]");
  EXPECT_EQ(shown("It costs 3.50 😱"), "fear [It costs 3.50 😱]");
  EXPECT_EQ(shown("😀 Hello there. Bye."), "joy [😀 Hello there. ]") << "in front of the first words";
  EXPECT_EQ(shown("Yes\n😢 No"), "sadness [😢 No]");
  EXPECT_EQ(shown("I drive a 🚗 home"), "") << "no mood";
  EXPECT_EQ(shown("😂"), "joy [😂]");
  EXPECT_EQ(shown("好的😀。再见"), "joy [好的😀。]");
}

TEST(MoodMarks, VariantsAndRepetition) {
  EXPECT_EQ(shown("Thanks 👍🏽"), "friendly [Thanks 👍🏽]");
  EXPECT_EQ(shown("Love ❤️ you"), "loving [Love ❤️ ]");
  const auto once = find_moods(U"So sad 😔"), often = find_moods(U"So sad 😔😔😔");
  ASSERT_EQ(once.size(), 1u);
  ASSERT_EQ(often.size(), 1u);
  EXPECT_GT(often[0].mood->intensity, once[0].mood->intensity + 0.2);
  EXPECT_LE(find_moods(U"x 😀😀😀😀😀😀😀😀😀")[0].mood->intensity, 1);
}

TEST(MoodMarks, SmileysAndWhatOnlyLooksLikeThem) {
  EXPECT_EQ(shown("Nice :-)"), "friendly [Nice :-)]");
  EXPECT_EQ(shown("Too bad :( Well."), "sadness [Too bad :( ]");
  EXPECT_EQ(shown("Sure ;-)."), "ironic [Sure ;-).]");
  for (const char* plain : {"http://x.org", "a:b", "10:30 PM", "note: (see below)", "C:/temp",
                            "f(x):)", "item 1) and 2)", "std::vector", "AXD :"}) {
    EXPECT_EQ(shown(plain), "") << plain;
  }
  EXPECT_EQ(mood_of_emoji(U":-D"), (dam::Mood{"joy", 1}));
  EXPECT_EQ(mood_of_emoji(U"🤢"), (dam::Mood{"disgust", 0.9}));
  EXPECT_FALSE(mood_of_emoji(U"🚗"));
  EXPECT_FALSE(mood_of_emoji(U"x"));
  EXPECT_FALSE(mood_of_emoji(U""));
  SpokenText said = as_written(U"Nice :-) indeed :x 😀");
  blank_smileys(said);
  EXPECT_EQ(said.text, U"Nice     indeed :x 😀");
}

TEST(MoodMarks, ExclamationMarksIntensify) {
  EXPECT_EQ(shown("Come here! Now."), "*! [Come here! ]");
  EXPECT_EQ(shown("Come here!!"), "*!! [Come here!!]");
  EXPECT_EQ(shown("Really?! 😡"), "anger! [Really?! 😡]");
  EXPECT_EQ(shown("快！"), "*! [快！]");
  EXPECT_EQ(shown("a != b"), "");
}

TEST(MoodMarks, AsTimes) {
  const dam::Script script{{{0, 0.2, "SIL", ""},
                            {0.2, 0.5, "OW", "Oh"},
                            {0.5, 0.8, "N", "no."},
                            {0.8, 1, "SIL", ""},
                            {1, 1.4, "F", "Fine"},
                            {1.4, 2, "SIL", ""}}};
  const auto spans = find_moods("Oh no. 😢 Fine! 😀", script);
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0], (dam::MoodSpan{0.2, 1, dam::Mood{"sadness", 0.8}, 1}));
  EXPECT_EQ(spans[1], (dam::MoodSpan{1, 1.4, dam::Mood{"joy", 1}, 1.2}));
  EXPECT_TRUE(find_moods("😢", dam::Script{}).empty());
}

}  // namespace mood_marks_test
}  // namespace animeme::text
