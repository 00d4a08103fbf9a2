// Reading corpora, good and hostile.
#include "dam/corpus/corpus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/support/shared.h"
#include "tests/support/temp_dir.h"

namespace animeme::dam {
namespace corpus_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CorpusFolder : public testing::Test {
 protected:
  void SetUp() override {
    write("utterances.tsv", "id\ttext\tsplit\tmood\na\thi\ttrain\tglad\nb\tho\ttest\tsad\n");
    for (const char* id : {"a", "b"}) {
      write(std::string("phonemes/") + id + ".tsv",
            "start_s\tend_s\tphone\tword\n0\t0.1\tSIL\t\n0.1\t0.2\tAY\thi\n0.2\t0.4\tSIL\t\n");
      write(std::string("fap/") + id + ".csv", curves());
    }
  }
  static std::string curves() {
    std::string text = "time_s,fap3_open_jaw,smile,measured\n";
    for (int i = 0; i < 10; ++i)
      text += "0." + std::string(1, char('0' + i * 4 / 10)) +
              std::string(1, char('0' + i * 4 % 10)) + "," + std::to_string(i) + "," +
              std::to_string(10 - i) + "," + (i == 4 ? "0" : "1") + "\n";
    return text;
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((dir_ / name).parent_path());
    std::ofstream(dir_ / name, std::ios::binary) << text;
  }
  Error error(const CorpusOptions& options = {}) const {
    const auto corpus = read_corpus(dir_, options);
    EXPECT_FALSE(corpus);
    return corpus ? Error{} : corpus.error();
  }

  const test::TempDir temp_;
  const fs::path dir_ = temp_.path();
};

TEST_F(CorpusFolder, IsRead) {
  const auto corpus = read_corpus(dir_);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  ASSERT_EQ(corpus->utterances.size(), 2u);
  const Utterance& a = corpus->utterances[0];
  EXPECT_EQ(a.text, "hi");
  EXPECT_EQ(a.signal.rate, (fap::Rate{25, 1}));
  EXPECT_EQ(a.signal.frames(), 10u);
  EXPECT_EQ(a.signal.at(3, 1), 7);
  EXPECT_FALSE(a.signal.measured[4]);
  EXPECT_EQ(a.script.phones[1].label, "AY");
  EXPECT_THAT(a.fields, testing::Contains(testing::Pair("mood", "glad")));
  EXPECT_EQ(select(*corpus, "mood", "sad").size(), 1u);
  EXPECT_NEAR(corpus->duration(), 0.8, 1e-12);
}

TEST_F(CorpusFolder, SplitsAndControlsAreChosen) {
  CorpusOptions options;
  options.split_value = "test";
  options.controls = {"smile"};
  const auto corpus = read_corpus(dir_, options);
  ASSERT_TRUE(corpus);
  ASSERT_EQ(corpus->utterances.size(), 1u);
  EXPECT_EQ(corpus->utterances[0].id, "b");
  EXPECT_THAT(corpus->utterances[0].signal.names, testing::ElementsAre("smile"));
  options.split_column = "mood";
  options.split_value = "glad";
  EXPECT_EQ(read_corpus(dir_, options)->utterances[0].id, "a");
  options.split_column = "weather";
  EXPECT_EQ(error(options).code, Code::not_found);
  options.split_column = "mood";
  options.split_value = "bored";
  EXPECT_THAT(error(options).describe(), HasSubstr("bored"));
  options = {};
  options.controls = {"nose"};
  EXPECT_THAT(error(options).describe(), HasSubstr("nose"));
}

TEST_F(CorpusFolder, OtherFilesForPhonemesAndControls) {
  fs::remove(dir_ / "fap/a.csv");
  std::string mask = "0 0 1";
  for (int i = 3; i < 68; ++i) mask += " 0";
  std::string clip = "2.1 a 25 10\n";
  for (int i = 0; i < 10; ++i)
    clip += mask + "\n" + std::to_string(i) + " " + std::to_string(7 * i) + "\n";
  write("fap/a.fap", clip);
  CorpusOptions options;
  options.split_value = "train";
  const auto corpus = read_corpus(dir_, options);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  EXPECT_THAT(corpus->utterances[0].signal.names, testing::ElementsAre("fap3_open_jaw"));
  EXPECT_EQ(corpus->utterances[0].signal.at(9, 0), 63);
}

TEST_F(CorpusFolder, MissingFilesAreNamedOrSkipped) {
  fs::remove(dir_ / "fap/b.csv");
  EXPECT_THAT(error().describe(), HasSubstr("b.csv"));
  CorpusOptions options;
  options.skip_missing = true;
  const auto corpus = read_corpus(dir_, options);
  ASSERT_TRUE(corpus);
  EXPECT_EQ(corpus->left_out.skipped, 1u);
  fs::remove(dir_ / "fap/a.csv");
  EXPECT_EQ(error(options).code, Code::not_found);
  fs::remove(dir_ / "utterances.tsv");
  EXPECT_THAT(error().describe(), HasSubstr("utterances.tsv"));
  EXPECT_THAT(error().describe(), HasSubstr("a corpus is a folder that contains it"));
}

TEST_F(CorpusFolder, BadTablesNameFileAndLine) {
  write("utterances.tsv", "name\nx\n");
  EXPECT_THAT(error().describe(), HasSubstr("'id'"));
  write("utterances.tsv", "id\ttext\na\n");
  EXPECT_THAT(error().describe(), HasSubstr("utterances.tsv:2:"));
  write("utterances.tsv", "id\n../a\n");
  EXPECT_EQ(error().code, Code::syntax);
  write("utterances.tsv", "id\na\na\n");
  EXPECT_THAT(error().describe(), HasSubstr("utterances.tsv:3:"));
  write("utterances.tsv", "");
  EXPECT_EQ(error().code, Code::truncated);
}

TEST_F(CorpusFolder, LengthsMustAgree) {
  write("phonemes/a.tsv", "start_s\tend_s\tphone\n0\t0.1\tSIL\n0.1\t2\tAY\n");
  EXPECT_EQ(error().code, Code::out_of_range);
  CorpusOptions options;
  options.any_length = true;
  EXPECT_TRUE(read_corpus(dir_, options));
}

TEST(Curves, Rates) {
  const auto with_step = [](double rate, int decimals) {
    std::string text = "time_s,x\n";
    char line[64];
    for (int i = 0; i < 200; ++i) {
      std::snprintf(line, sizeof line, "%.*f,0\n", decimals, i / rate);
      text += line;
    }
    const auto signal = read_curves(text);
    EXPECT_TRUE(signal) << (signal ? "" : signal.error().describe());
    return signal ? signal->rate : fap::Rate{0, 0};
  };
  EXPECT_EQ(with_step(25, 2), (fap::Rate{25, 1}));
  EXPECT_EQ(with_step(30, 3), (fap::Rate{30, 1}));
  EXPECT_EQ(with_step(60, 3), (fap::Rate{60, 1}));
  EXPECT_EQ(with_step(30000.0 / 1001, 4), (fap::Rate{30000, 1001}));
  EXPECT_EQ(with_step(60000.0 / 1001, 4), (fap::Rate{60000, 1001}));
  EXPECT_EQ(with_step(12.5, 2), (fap::Rate{25, 2}));
}

TEST(Curves, BadTables) {
  const auto code = [](const char* text) {
    const auto signal = read_curves(text);
    EXPECT_FALSE(signal) << text;
    return signal ? Code::internal : signal.error().code;
  };
  EXPECT_EQ(code(""), Code::truncated);
  EXPECT_EQ(code("time_s,x\n0,1\n"), Code::truncated);
  EXPECT_EQ(code("x,y\n0,1\n"), Code::not_found);
  EXPECT_EQ(code("time_s\n0\n1\n"), Code::not_found);
  EXPECT_EQ(code("time_s,x,x\n0,1,1\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,nan\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,inf\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,1e999\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,1,2\n"), Code::syntax);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,1\n0.04,1\n"), Code::out_of_range);
  EXPECT_EQ(code("time_s,x\n0,1\n0.04,1\n0.12,1\n0.16,1\n"), Code::out_of_range);
  EXPECT_EQ(code("time_s,x\n1,1\n1.04,1\n"), Code::out_of_range);
  EXPECT_EQ(code("time_s,x,measured\n0,1,1\n0.04,1,2\n"), Code::syntax);
  const auto late = read_curves("time_s,x\n0,1\n0.04,2\n0.08,zzz\n");
  EXPECT_EQ(late.error().where.line, 4);
}

// ---- blanks ----

/// Rows from the fields behind the time, with the line ends of Windows.
std::string table(const std::string& header, const std::vector<std::string>& rows) {
  std::string text = header + "\r\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    char time[16];
    std::snprintf(time, sizeof time, "%.2f,", 0.04 * double(i));
    text += time + rows[i] + "\r\n";
  }
  return text;
}

TEST(Curves, BlanksAreKeptOnlyIfAskedFor) {
  for (const char* blank : {"", " ", "nan", "NaN", "-nan", "-nan(ind)", "NAN", "inf", "-Infinity",
                            "#N/A", "#DIV/0!", "#NV", "NA", "n/a", "null", "None", "-", "\"\""}) {
    const std::string text =
        table("time_s,x,y", {"1,2", std::string(blank) + ",4", "5,6", "7," + std::string(blank)});
    EXPECT_FALSE(read_curves(text)) << blank;
    std::vector<BlankNote> blanks;
    auto signal = read_curves(text, &blanks);
    ASSERT_TRUE(signal) << blank << ": " << signal.error().describe();
    EXPECT_TRUE(std::isnan(signal->at(1, 0)));
    ASSERT_EQ(blanks.size(), 2u);
    EXPECT_EQ(blanks[0].control, "x");
    EXPECT_EQ(blanks[0].rows, 1u);
    EXPECT_EQ(blanks[0].of, 4u);
    EXPECT_EQ(blanks[0].first_line, 3u);
    EXPECT_EQ(blanks[1].first_line, 5u);
    leave_out_blanks(*signal);
    EXPECT_EQ(signal->at(1, 0), 3);  // between 1 and 5
    EXPECT_EQ(signal->at(3, 1), 6);  // as the last one
    EXPECT_EQ(signal->measured, (std::vector<bool>{true, false, true, false}));
  }
}

TEST(Curves, SpreadsheetsLeaveColumnsAndRows) {
  std::vector<BlankNote> blanks;
  // Columns without name and values, rows of commas, cells that are missing at the end.
  auto signal =
      read_curves("time_s,x,y,measured,,\n0,1,2,1,,\n0.04,3\n0.08,5,6,1\n,,,,,\n", &blanks);
  ASSERT_TRUE(signal) << signal.error().describe();
  EXPECT_THAT(signal->names, testing::ElementsAre("x", "y"));
  EXPECT_EQ(signal->frames(), 3u);
  ASSERT_EQ(blanks.size(), 1u);
  EXPECT_EQ(blanks[0].control, "y");
  EXPECT_FALSE(signal->measured[1]);  // its measured is blank, too
  // A file that was cut off in the middle of a number.
  blanks.clear();
  signal = read_curves("time_s,x,y\n0,1,2\n0.04,3,4\n0.08,5", &blanks);
  ASSERT_TRUE(signal);
  EXPECT_EQ(signal->frames(), 2u);
  EXPECT_TRUE(blanks.empty());
  EXPECT_FALSE(read_curves("time_s,x,y\n0,1,2\n0.04,3,4\n0.08,5"));
}

TEST(Curves, WordsAndTimesAreNoBlanks) {
  std::vector<BlankNote> blanks;
  for (const char* text : {"time_s,x\n0,1\n0.04,abc\n", "time_s,x\n0,1\n0.04,1e999\n",
                           "time_s,x\n0,1\n,2\n", "time_s,x\n0,1\nnan,2\n",
                           "time_s,x\n0,1\n0.04,1,2\n", "time_s,x,measured\n0,1,1\n0.04,1,yes\n"}) {
    const auto signal = read_curves(text, &blanks);
    ASSERT_FALSE(signal) << text;
    EXPECT_EQ(signal.error().where.line, 3) << text;
  }
}

TEST_F(CorpusFolder, RowsWithBlanksAreLeftOutAndNamed) {
  std::string text = curves();
  text.replace(text.find(",3,7,"), 5, ",,7,");
  write("fap/b.csv", text);
  auto corpus = read_corpus(dir_);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  const Signal& signal = corpus->utterances[1].signal;
  EXPECT_EQ(signal.at(3, 0), 3);
  EXPECT_FALSE(signal.measured[3]);
  EXPECT_TRUE(signal.measured[2]);
  ASSERT_EQ(corpus->left_out.blanks.size(), 1u);
  const BlankNote& blank = corpus->left_out.blanks[0];
  EXPECT_EQ(blank.id, "b");
  EXPECT_EQ(blank.control, "fap3_open_jaw");
  EXPECT_EQ(blank.rows, 1u);
  EXPECT_EQ(blank.first_line, 5u);
  CorpusOptions options;  // what is not wanted may be blank
  options.controls = {"smile"};
  corpus = read_corpus(dir_, options);
  ASSERT_TRUE(corpus);
  EXPECT_TRUE(corpus->utterances[1].signal.measured[3]);
  EXPECT_TRUE(corpus->left_out.blanks.empty());
}

TEST_F(CorpusFolder, AControlThatIsBlankThroughout) {
  const auto without_smile = [] {
    std::string text = "time_s,fap3_open_jaw,smile\n";
    for (int i = 0; i < 10; ++i) text += std::to_string(0.04 * i) + "," + std::to_string(i) + ",\n";
    return text;
  };
  write("fap/b.csv", without_smile());
  const auto corpus = read_corpus(dir_);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  ASSERT_EQ(corpus->utterances.size(), 1u);  // the other one is as it was
  EXPECT_EQ(corpus->utterances[0].signal.at(3, 1), 7);
  EXPECT_EQ(corpus->left_out.sentences, 1u);
  EXPECT_EQ(corpus->left_out.blanks[0].rows, 10u);
  write("fap/a.csv", without_smile());
  EXPECT_THAT(error().describe(),
              testing::AllOf(HasSubstr("'smile'"), HasSubstr("every sentence")));
  CorpusOptions options;
  options.controls = {"fap3_open_jaw"};
  EXPECT_EQ(read_corpus(dir_, options)->utterances.size(), 2u);
}

TEST(Corpus, TheSampleThatShips) {
  const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
  ASSERT_TRUE(corpus) << corpus.error().describe();
  EXPECT_EQ(corpus->utterances.size(), 24u);
  EXPECT_EQ(corpus->utterances[0].signal.names.size(), 26u);
  EXPECT_EQ(select(*corpus, "split", "test").size(), 6u);
}

}  // namespace corpus_test
}  // namespace animeme::dam
