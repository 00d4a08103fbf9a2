#include "tools/speech/talking/spoken.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/files.h"
#include "tools/speech/talking/written_text.h"

namespace animeme::speech {
namespace spoken_test {

TEST(WordsOfFile, AreThoseOfAnyScript) {
  const auto path = std::filesystem::temp_directory_path() / "animeme_words_of_file.txt";
  test::spill(path,
              "1\n00:00:00,500 --> 00:00:02,500\nbin blue\n\n2\n00:00:03,000 --> "
              "00:00:04,000\nat f\n");
  EXPECT_EQ(*words_of_file(path.string(), {}), "bin blue at f ");
  test::spill(path,
              "start_s\tend_s\tphone\tword\n0\t0.2\tN\tno\n0.2\t0.4\tOW\tno\n0.4\t0.5\tSIL\t\n"
              "0.5\t0.7\tN\tno\n0.7\t0.9\tOW\tno\n");
  const auto words = words_of_file(path.string(), {});
  ASSERT_TRUE(words) << words.error().describe();
  EXPECT_EQ(*words, "no  no ");
  test::spill(path, "start_s\tend_s\tphone\n0\t0.2\tN\n0.2\t0.4\tOW\n");
  EXPECT_EQ(words_of_file(path.string(), {}).error().code, Code::not_found);
  std::filesystem::remove(path);
}

TEST(GetSpoken, MarksOfATextAreNotSaid) {
  SpokenOptions options;
  options.has_text = true;
  std::vector<std::string> warnings;
  tools::Log log;
  log.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  options.text = "Hi Bob. Pam.";
  const auto plain = get_spoken(options, log);
  if (!plain && plain.error().code == Code::unsupported) GTEST_SKIP() << plain.error().describe();
  ASSERT_TRUE(plain) << plain.error().describe();
  EXPECT_TRUE(warnings.empty());
  options.text = "[laughs] Hi Bob. (sighs) *giggles* Pam.";
  const auto spoken = get_spoken(options, log);
  ASSERT_TRUE(spoken);
  EXPECT_EQ(spoken->script, plain->script);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "the mark \"[laughs]\" is not said (--speak-marks says such marks) (3 in all)");
  options.script_reading.speak_marks = true;
  const auto all = get_spoken(options, log);
  ASSERT_TRUE(all);
  EXPECT_GT(all->script.phones.size(), plain->script.phones.size() + 8);
}

TEST(TextToSay, AnOddByteCostsItself) {
  std::vector<std::string> warnings;
  tools::Log log;
  log.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  const auto say = [&](std::string_view bytes) { return text_to_say(bytes, false, log); };
  // A text in UTF-8 stays one.
  EXPECT_EQ(say("Z\xC3\xBCrich.\nK\xF6ln, it\x92s \x80 far"), "Zürich.\nKöln, it’s \uFFFD far");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "line 2: 3 bytes are not UTF-8; read as Windows-1252 where that gives a letter, else "
            "as U+FFFD");
  // A character that was cut, damage.
  EXPECT_EQ(say("Z\xC3\xBCrich und K\xC3"), "Zürich und K\uFFFD");
  EXPECT_EQ(say("Z\xC3\xBCrich \xFF\xFE und"), "Zürich \uFFFD\uFFFD und");
  EXPECT_EQ(warnings.size(), 3u);
  // A text that is not UTF-8 anywhere is of Windows as a whole, which is no fault.
  EXPECT_EQ(say("\x93Z\xFCrich\x94 isn\x92t K\xF6ln"), "“Zürich” isn’t Köln");
  // What another program has lost already.
  EXPECT_EQ(say("I don\uFFFDt \uFFFD know\uFFFD"), "I don’t \uFFFD know\uFFFD");
  EXPECT_EQ(warnings.size(), 3u);
}

TEST(LineToSay, AMarkOfUtf16IsDamageUnlessTheLineIsUtf16) {
  std::vector<std::string> warnings;
  tools::Log log;
  log.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  const auto say = [&](std::string_view bytes) { return line_to_say(bytes, false, log); };
  EXPECT_EQ(say("\xFF\xFEHello there."), "Hello there.");
  EXPECT_EQ(say("\xFE\xFF"
                "Z\xC3\xBCrich"),
            "Zürich");
  EXPECT_EQ(say("\xFF\xFE"), "");
  EXPECT_EQ(warnings.size(), 3u);
  EXPECT_EQ(say(std::string_view("\xFF\xFEJ\0a\0.\0", 8)), "Ja.");
  EXPECT_EQ(say("Zürich"), "Zürich");
  EXPECT_EQ(warnings.size(), 3u);
}

TEST(TextToSay, MarksOfAnyLanguageAreNotSaid) {
  const auto say = [](std::string_view text) { return text_to_say(text, false); };
  EXPECT_EQ(say("[lacht] Das ist gut. [zwinkert] Ja!"), "Das ist gut. Ja!");
  EXPECT_EQ(say("Ja, *lacht* das (seufzt) ist gut [hustet]. [Tür knallt]"), "Ja, das ist gut. ");
  EXPECT_EQ(say("[笑] 你好。[音乐]"), "你好。");
  EXPECT_EQ(say("[Applaudissements]\nMerci !"), "\nMerci !");
  // These are said.
  for (const char* text : {"[He] came, and [she] went. See [1].", "Press [Enter] to go on.",
                           "[H]e came.", "[The page](http://a.b) is there.", "She has [a] car",
                           "(Kichererbsen) und *nie* [oder so]!", "[wir] kamen"}) {
    EXPECT_EQ(say(text), text);
  }
  EXPECT_EQ(text_to_say("[lacht] Ja", true), "[lacht] Ja");
}

}  // namespace spoken_test
}  // namespace animeme::speech
