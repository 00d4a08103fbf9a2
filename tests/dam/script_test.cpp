#include "dam/script/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "dam/script/phones.h"
#include "dam/script/textgrid.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace script_test {

using testing::HasSubstr;

constexpr const char* kHeader = "start_s\tend_s\tphone\tword\n";

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string fixture(const std::string& name) {
  return file_text(test::data_dir() / "scripts" / name);
}

Script read(const std::string& text, const ScriptOptions& options = {}) {
  auto script = read_script(text, options);
  if (!script) {
    ADD_FAILURE() << script.error().describe();
    return {};
  }
  EXPECT_TRUE(check_script(*script));
  return *script;
}

Error failure(const std::string& text, const ScriptOptions& options = {}) {
  auto script = read_script(text, options);
  if (script) {
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }
  return script.error();
}

std::string labels(const Script& script) {
  std::string out;
  for (const Phone& phone : script.phones) {
    if (!out.empty()) out += ' ';
    out += phone.label;
  }
  return out;
}

std::string minimal_grid(const std::string& tier_name, const std::string& label) {
  return "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n0\n1\n<exists>\n1\n"
         "\"IntervalTier\"\n\"" +
         tier_name + "\"\n0\n1\n1\n0\n1\n\"" + label + "\"\n";
}

TEST(ScriptTsv, CorpusFormat) {
  const Script script = read(fixture("corpus.tsv"));
  ASSERT_EQ(labels(script), "SIL B IH N SIL");
  EXPECT_EQ(script.phones[1], (Phone{0.25, 0.3, "B", "bin"}));
  EXPECT_EQ(script.duration(), 1.0);
}

TEST(ScriptTsv, ColumnsInAnyOrderAndDurations) {
  const Script script = read(fixture("own_columns.tsv"));
  ASSERT_EQ(labels(script), "SIL B IH N");
  EXPECT_EQ(script.phones[0], (Phone{0, 0.25, "SIL", ""}));  // the gap before the first phone
  EXPECT_EQ(script.phones[3].word, "bin");
  EXPECT_NEAR(script.duration(), 0.5, 1e-12);
}

TEST(ScriptTsv, GapsAreSilenceAndSilencesMerge) {
  const Script script =
      read(std::string(kHeader) +
           "0.1\t0.2\tAA1\ta\n0.4\t0.5\tpau\t\n0.5\t0.6\tsp\tx\n0.8\t0.9\tm\tb\n");
  EXPECT_EQ(labels(script), "SIL AA SIL M");
  EXPECT_EQ(script.phones[2], (Phone{0.2, 0.8, "SIL", ""}));
}

TEST(ScriptTsv, LineEndsAndByteOrderMark) {
  EXPECT_EQ(read("\xEF\xBB\xBFstart\tend\tphone\r\n0\t1\tM\r\n").phones[0].label, "M");
  EXPECT_EQ(read("start\tend\tphone\r0\t1\tM\r").phones[0].label, "M");
}

TEST(ScriptTsv, RoundingWithinAMillisecondIsForgiven) {
  const Script script =
      read(std::string(kHeader) + "0\t0.5\tM\t\n0.4995\t1\tAA\t\n1.0005\t2\tB\t\n");
  ASSERT_EQ(labels(script), "M AA B");
  EXPECT_EQ(script.phones[0].end, 0.4995);
  EXPECT_EQ(script.phones[1].end, 1.0005);
}

TEST(ScriptTsv, ATimelineThatCannotBeIsRefused) {
  struct Case {
    const char* rows;
    Code code;
    int line;
    const char* says;
  };
  const Case cases[] = {
      {"0\t0.5\tM\t\n0.498\t1\tAA\t\n", Code::syntax, 3, "must not overlap"},
      {"0\t0.5\tM\t\n0.6\t1\tAA\t\n0.55\t0.58\tB\t\n", Code::syntax, 4, "sort the phones"},
      {"0\t0.5\tM\t\n0\t1\tAA\t\n", Code::syntax, 3, "\"AA\""},
      {"0.5\t0.5\tM\t\n", Code::truncated, 0, "holds no phones"},
      {"0.5\t0.4\tM\t\n", Code::syntax, 2, "\"M\""},
      {"-0.1\t0.5\tM\t\n", Code::syntax, 2, "before the audio"},
      {"nan\t0.5\tM\t\n", Code::out_of_range, 2, "finite"},
      {"0\tinf\tM\t\n", Code::out_of_range, 2, "finite"},
      {"0\t1e999\tM\t\n", Code::out_of_range, 2, "finite"},
      {"0\t1e9\tM\t\n", Code::out_of_range, 2, "one day"},
      {"0\t0,5\tM\t\n", Code::syntax, 2, "decimal point"},
      {"0\t\tM\t\n", Code::syntax, 2, "end time"},
      {"0\n", Code::syntax, 2, "end time"},
      {"x\t1\tM\t\n", Code::syntax, 2, "start time"},
      {"0\t1\tQX\t\n", Code::not_found, 2, "\"QX\""},
  };
  for (const Case& c : cases) {
    const Error error = failure(kHeader + std::string(c.rows));
    EXPECT_EQ(error.code, c.code) << c.rows << error.describe();
    EXPECT_EQ(error.where.line, c.line) << c.rows;
    EXPECT_THAT(error.message, HasSubstr(c.says)) << c.rows;
  }
}

TEST(ScriptTsv, UnknownLabelsComeWithAHint) {
  const Error error = failure(std::string(kHeader) + "0\t1\tAA\t\n1\t2\tAOO\t\n2\t3\tER\t\n");
  EXPECT_EQ(error.code, Code::not_found);
  EXPECT_EQ(error.where.line, 3);
  EXPECT_THAT(error.message, HasSubstr("\"AOO\""));
  EXPECT_THAT(error.message, HasSubstr("label is AO"));
}

TEST(ScriptTsv, MissingColumnsAndEmptyFiles) {
  EXPECT_THAT(failure("start_s\tphone\n0\tM\n").message, HasSubstr("end_s"));
  EXPECT_EQ(failure("").code, Code::truncated);
  EXPECT_EQ(failure(" \n\t\n").code, Code::truncated);
  EXPECT_EQ(failure(kHeader).code, Code::truncated);
  EXPECT_EQ(failure("# only a comment\n").code, Code::syntax);
  EXPECT_EQ(failure("hello world\n").code, Code::syntax);
  EXPECT_THAT(failure("hello world\n").message, HasSubstr("textgrid"));
  EXPECT_EQ(failure(std::string(100, '\0')).code, Code::syntax);
}

TEST(ScriptAlphabet, IsToldByTheLabels) {
  const std::string head = "start\tend\tphone\n";
  // "S" is sh in X-SAMPA, s in ARPAbet.
  EXPECT_EQ(labels(read(head + "0\t1\tS\n1\t2\t@\n2\t3\ti:\n")), "SH AX IY");
  EXPECT_EQ(labels(read(head + "0\t1\tS\n1\t2\tAX\n2\t3\tIY\n")), "S AX IY");
  EXPECT_EQ(labels(read(head + "0\t1\ty\n1\t2\tø\n2\t3\tɹ\n")), "UW UH R");
  EXPECT_EQ(labels(read(head + "0\t1\tow\n1\t2\tej\n2\t3\tɫ\n")), "OW EY L");  // Montreal aligner
  EXPECT_EQ(labels(read(head + "0\t1\ths\n1\t2\taj\n", {Alphabet::ipa, ""})), "HH S AY");
  EXPECT_EQ(failure(head + "0\t1\t@\n", {Alphabet::arpabet, ""}).code, Code::not_found);
}

TEST(ScriptAlphabet, SegmentsOfTwoPhonesShareTheirTime) {
  const Script script = read("start\tend\tphone\tword\n0\t1\tts\tzu\n1\t2\tuː\tzu\n2\t3\tː\tzu\n");
  ASSERT_EQ(labels(script), "T S UW");
  EXPECT_EQ(script.phones[0], (Phone{0, 0.5, "T", "zu"}));
  EXPECT_EQ(script.phones[1], (Phone{0.5, 1, "S", "zu"}));
  EXPECT_EQ(script.phones[2].end, 3);  // the lone length mark
}

TEST(ScriptTextGrid, LongForm) {
  const Script script = read(fixture("long.TextGrid"));
  ASSERT_EQ(labels(script), "SIL P AY SIL");
  EXPECT_EQ(script.phones[1], (Phone{0.5, 0.625, "P", "say \"pie\""}));
  EXPECT_EQ(script.phones[3].word, "");
}

TEST(ScriptTextGrid, ShortFormInUtf16OfBothByteOrders) {
  const Script little = read(fixture("short_utf16le.TextGrid"));
  ASSERT_EQ(labels(little), "SIL T UW SIL");
  EXPECT_EQ(little.phones[1].word, "Tür");
  EXPECT_EQ(read(fixture("short_utf16be.TextGrid")), little);
}

TEST(ScriptTextGrid, TierIsChosenByName) {
  EXPECT_EQ(labels(read(minimal_grid("Phones", "M"))), "M");
  EXPECT_EQ(labels(read(minimal_grid("bob - phones", "M"))), "M");
  EXPECT_EQ(labels(read(minimal_grid("mouth", "M"))), "M");  // the only tier is the tier
  EXPECT_EQ(labels(read(minimal_grid("mouth", "M"), {Alphabet::automatic, "mouth"})), "M");
  EXPECT_THAT(failure(minimal_grid("mouth", "M"), {Alphabet::automatic, "lips"}).message,
              HasSubstr("\"mouth\""));
  EXPECT_EQ(failure(fixture("long.TextGrid"), {Alphabet::automatic, "notes"}).code,
            Code::unsupported);
}

TEST(ScriptTextGrid, ErrorsNameTheLine) {
  std::string text = fixture("long.TextGrid");
  const std::size_t at = text.find("AY1");
  text.replace(at, 3, "AYY");
  const Error error = failure(text);
  EXPECT_EQ(error.code, Code::not_found);
  const auto newlines = std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
  EXPECT_EQ(error.where.line, newlines + 1);
}

TEST(ScriptTextGrid, DamagedFilesAreRefused) {
  const std::string good = fixture("long.TextGrid");
  for (std::size_t size = 0; size < good.size(); size += 7) {
    std::vector<ScriptNote> notes;
    const auto script = read_script(good.substr(0, size), {}, &notes);
    // What was cut between two entries is read, and said. The point tier at the end may lose its
    // last characters.
    if (script && size < good.rfind('"')) {
      ASSERT_EQ(notes.size(), 1u) << size;
      EXPECT_EQ(notes[0].kind, ScriptNote::Kind::counts);
    }
  }
  EXPECT_EQ(failure("ooBinaryFile\x08TextGrid").code, Code::unsupported);
  EXPECT_EQ(failure("File type = \"ooTextFile\"\nObject class = \"Pitch 1\"\n").code,
            Code::unsupported);
  // A count is only a claim.
  EXPECT_EQ(failure("File type = \"ooTextFile\"\n\"TextGrid\"\n0 1 <exists> 1000000000\n").code,
            Code::truncated);
  EXPECT_EQ(failure("File type = \"ooTextFile\"\n\"TextGrid\"\n0 1 <exists> -1\n").code,
            Code::syntax);
  EXPECT_EQ(failure("File type = \"ooTextFile\"\n\"TextGrid\"\n0 1e999 <exists> 1\n").code,
            Code::out_of_range);
  EXPECT_EQ(failure("File type = \"ooTextFile\"\n\"TextGrid\"\n0 1 <absent>\n").code,
            Code::not_found);
}

TEST(TextGridFile, CommentsAndWordsAreForPeople) {
  const auto grid = parse_textgrid(
      "File type = \"ooTextFile\" ! \"not this\" 5\n\"TextGrid\" from 0 [s] to 2 <exists> 1 tier\n"
      "\"TextTier\" called \"x\" 0 2 with 1 point: 0.5 \"a \"\"b\"\"\"");
  ASSERT_TRUE(grid) << grid.error().describe();
  ASSERT_EQ(grid->tiers.size(), 1u);
  EXPECT_TRUE(grid->tiers[0].points);
  EXPECT_EQ(grid->tiers[0].items[0].text, "a \"b\"");
  const auto again = parse_textgrid(format_textgrid(*grid));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->tiers[0].items[0].text, "a \"b\"");
}

// Whatever is written reads back as the same script, to the last bit of every time.
TEST(ScriptWriters, ReadBackEqual) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return std::size_t(random()) % n; };
  const std::string words[] = {"no", "say \"pie\"", "Tür", "", "it's", "日本", "a b", "0.5", "<x>"};
  for (int round = 0; round < 300; ++round) {
    Script script;
    double time = 0;
    const std::size_t count = 1 + below(40);
    for (std::size_t i = 0; i < count; ++i) {
      Phone phone;
      phone.label = phones()[below(kPhoneCount)].label;
      const bool silent = phone.label == kSilence;
      if (silent && i > 0 && script.phones.back().label == kSilence) continue;
      phone.start = time;
      time += 1e-5 + double(random()) / 4e9;
      phone.end = time;
      if (!silent) phone.word = words[below(std::size(words))];
      script.phones.push_back(phone);
    }
    EXPECT_EQ(read(write_script_tsv(script)), script);
    EXPECT_EQ(read(write_textgrid(script)), script);
  }
}

TEST(ScriptReaders, SurviveDamage) {
  std::mt19937 random(11);
  for (const char* name : {"corpus.tsv", "long.TextGrid", "short_utf16le.TextGrid"}) {
    const std::string good = fixture(name);
    int accepted = 0;
    for (int round = 0; round < 2000; ++round) {
      std::string bad = good;
      for (std::size_t i = 0; i <= random() % 4; ++i) bad[random() % bad.size()] = char(random());
      const auto script = read_script(bad);
      if (!script) continue;
      ++accepted;
      EXPECT_TRUE(check_script(*script));
      const auto again = read_script(write_script_tsv(*script));
      ASSERT_TRUE(again) << again.error().describe() << "\n" << write_script_tsv(*script);
      EXPECT_EQ(*again, *script);
    }
    EXPECT_GT(accepted, 0);
    EXPECT_LT(accepted, 2000);
  }
}

TEST(CheckScript, FindsEveryFault) {
  EXPECT_EQ(check_script({}).error().code, Code::truncated);
  const auto fault = [](Phone second) {
    return check_script({{{0, 1, "M", ""}, std::move(second)}});
  };
  EXPECT_TRUE(fault({1, 2, "AA", ""}));
  EXPECT_THAT(fault({1, 2, "aa", ""}).error().message, HasSubstr("phone 2"));
  EXPECT_FALSE(fault({0.9, 2, "AA", ""}));
  EXPECT_FALSE(fault({1, 1, "AA", ""}));
  EXPECT_FALSE(fault({1, std::nan(""), "AA", ""}));
  EXPECT_FALSE(fault({std::nan(""), 2, "AA", ""}));
  EXPECT_FALSE(fault({1, 1e9, "AA", ""}));
}

TEST(CheckAgainstAudio, NamesBothDurations) {
  Script script{{{0, 2.5, "M", ""}}};
  EXPECT_TRUE(check_against_audio(script, 2.5));
  EXPECT_TRUE(check_against_audio(script, 2.46));
  EXPECT_TRUE(check_against_audio(script, 60));
  const auto refused = check_against_audio(script, 2.44);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("2.5 s"));
  EXPECT_THAT(refused.error().message, HasSubstr("2.44 s"));
  EXPECT_FALSE(check_against_audio(script, std::nan("")));
  // Silence at the end need not be there: flite tells of 0.1 s more than it makes.
  script.phones.push_back({2.5, 2.8, std::string(kSilence), {}});
  EXPECT_TRUE(check_against_audio(script, 2.5));
  EXPECT_FALSE(check_against_audio(script, 2.4));
}

TEST(ScriptCorpus, AllSharedScriptsAreRead) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "needs the reference data (ANIMEME_SHARED)";
  std::size_t files = 0;
  for (const char* set : {"grid_s1", "grid_others"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(shared / "data" / set / "phonemes")) {
      const auto script = read_script(file_text(entry.path()));
      ASSERT_TRUE(script) << entry.path() << ": " << script.error().describe();
      EXPECT_EQ(*read_script(write_textgrid(*script)), *script);
      ++files;
    }
  }
  EXPECT_GE(files, 800u);
}

TEST(SpreadPhones, VowelsTakeLongerAndDiphthongsLongest) {
  TimedLabel word;
  word.start = 1;
  word.end = 2;
  std::vector<TimedLabel> out;
  const std::vector<std::string> labels = {"B", "AY", "T", "IY"};
  spread_phones(word, labels, out);
  ASSERT_EQ(out.size(), 4u);
  const double unit = 1 / (1 + 1.8 + 1 + 1.4);
  double start = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = i == 1 ? 1.8 : i == 3 ? 1.4 : 1;
    EXPECT_NEAR(out[i].start, start, 1e-9) << i;
    EXPECT_NEAR(out[i].end, start + share * unit, 1e-9) << i;
    start = out[i].end;
  }
}

// The header of ESPS ends within 50 lines.
TEST(EspsLabels, AreToldByTheEndOfTheirHeader) {
  for (const auto& [lines, is_one] : {std::pair(0, true), {49, true}, {50, false}}) {
    std::string text;
    for (int i = 0; i < lines; ++i) text += "comment " + std::to_string(i) + "\n";
    text += "#\n0.5 121 B\n0.9 121 AA\n";
    const auto timings = read_timings(text);
    EXPECT_EQ(timings && timings->format == "esps", is_one) << lines;
  }
}

}  // namespace script_test
}  // namespace animeme::dam
