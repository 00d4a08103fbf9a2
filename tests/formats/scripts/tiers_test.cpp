// Tiers of TextGrids by the names of programs, by number, by speaker; counts that are wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "dam/script/script.h"
#include "dam/script/textgrid.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace tiers_test {

using testing::HasSubstr;
using Labels = std::vector<const char*>;

// A tier of intervals of 0.1 s.
dam::TextGridTier tier(const std::string& name, const Labels& labels) {
  dam::TextGridTier made{name, false, {}};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    made.items.push_back({double(i) / 10, double(i + 1) / 10, labels[i], 0, 0});
  }
  return made;
}

std::string grid(std::vector<dam::TextGridTier> tiers) {
  return dam::format_textgrid({0, 1, std::move(tiers), {}});
}

std::string read(const std::string& text, const std::string& name = {},
                 const std::string& speaker = {}) {
  dam::ScriptOptions options;
  options.tier = name;
  options.speaker = speaker;
  const auto timings = read_labels(text, options);
  if (!timings) return timings.error().describe();
  std::string out;
  for (const dam::TimedLabel& label : timings->labels) {
    out += out.empty() ? "" : " ";
    out += label.label.empty() ? "-" : label.is_word ? "<" + label.label + ">" : label.label;
    out += label.word.empty() ? "" : "/" + label.word;
  }
  return out;
}

TEST(Tiers, TheOnlyOneIsTheTier) {
  EXPECT_EQ(read(grid({tier("", {"B", "AA1", "B"})})), "B AA1 B");
  EXPECT_EQ(read(grid({tier("whatever", {"my", "puppy", ""})})), "<my> <puppy> -");
  dam::TextGridTier points = tier("notes", {"x"});
  points.points = true;
  EXPECT_EQ(read(grid({points, tier("silences", {"B", "AA"})})), "B AA");
}

TEST(Tiers, ByNumberAndInAnyCase) {
  const std::string two =
      grid({tier("", {"B", "AA"}), tier("Lips", {"M", "AA"}), tier("1", {"P"})});
  EXPECT_THAT(read(two), HasSubstr("name or number (--tier)"));
  EXPECT_EQ(read(two, "1"), "P");  // a name before a number
  EXPECT_EQ(read(two, "2"), "M AA");
  EXPECT_EQ(read(two, "lips"), "M AA");
  EXPECT_EQ(read(two, " LIPS "), "M AA");
  for (const char* none : {"0", "4", "1.5", "-1", "nan", "inf", "lip"}) {
    EXPECT_THAT(read(two, none), HasSubstr("its tiers are")) << none;
  }
}

TEST(Tiers, OfKnownPrograms) {
  // WebMAUS, with its words, and alone.
  const auto ort = tier("ORT-MAU", {"", "Bob"}), kan = tier("KAN-MAU", {"<p:>", "b Q b"});
  const auto mau = tier("MAU", {"<usb>", "b", "Q"});
  EXPECT_EQ(read(grid({ort, kan, mau})), "- b/Bob Q");
  EXPECT_EQ(read(grid({ort, kan})), "<p:> B/Bob AO/Bob B/Bob");
  EXPECT_EQ(read(grid({tier("KAN", {"bQb"}), tier("x", {"y"})})), "B AO B");
  EXPECT_EQ(read(grid({tier("ORT", {"Oh", "no"}), tier("x", {"y"})})), "<Oh> <no>");
  // SPPAS.
  EXPECT_EQ(read(grid({tier("TokensAlign", {"#", "my"}), tier("PhonAlign", {"#", "m", "aI"})})),
            "# m/my aI");
  // FAVE.
  EXPECT_EQ(read(grid({tier("Interviewer - phone", {"{BR}", "sp", "B"}),
                       tier("Interviewer - word", {"{BR}", "sp", "Bob"})})),
            "- sp B/Bob");
}

TEST(Tiers, OfSpeakers) {
  const std::string two =
      grid({tier("Ann - phones", {"B", "AA"}), tier("Ann - words", {"bah", "bah"}),
            tier("Bob_phones", {"M", "IY"}), tier("Bob_words", {"me", "me"})});
  EXPECT_THAT(read(two), HasSubstr("more than one tier holds phones"));
  EXPECT_EQ(read(two, {}, "ann"), "B/bah AA/bah");
  EXPECT_EQ(read(two, {}, "Bob"), "M/me IY/me");
  EXPECT_THAT(read(two, {}, "Pam"), HasSubstr("no tier holds what \"Pam\" says"));
  EXPECT_EQ(read(two, "BOB_WORDS"), "<me> <me>");
}

TEST(Tiers, HoldWhatIsThereWhateverTheyCount) {
  const std::string good = grid({tier("words", {"Bob", "my"}), tier("phones", {"B", "AA", "M"})});
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"intervals: size = 3", "intervals: size = 1"},
           {"intervals: size = 3", "intervals: size = 30"},
           {"intervals: size = 2", "intervals: size = 0"},
           {"intervals: size = 2", "intervals: size = 900000000"},
           {"\nsize = 2", "\nsize = 1"},
           {"\nsize = 2", "\nsize = 7"}}) {
    std::string bad = good;
    ASSERT_NE(bad.find(from), std::string::npos);
    bad.replace(bad.find(from), from.size(), to);
    EXPECT_EQ(read(bad), "B/Bob AA/my M") << to;
    const auto timings = read_labels(bad);
    ASSERT_TRUE(timings && timings->notes.size() == 1) << to;
    EXPECT_THAT(timings->notes[0].describe(), HasSubstr("; these are read")) << to;
    EXPECT_GT(timings->notes[0].line, 0);
  }
  EXPECT_TRUE(read_labels(good)->notes.empty());
  const auto cut = read_labels(good.substr(0, good.rfind("        intervals [3]")));
  ASSERT_TRUE(cut);
  EXPECT_THAT(cut->notes[0].describe(), HasSubstr("3 entries and holds 2"));
}

}  // namespace tiers_test
}  // namespace animeme::scripts
