// `animeme evaluate --report`: a character on one page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace sheet_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(Sheet, HasEverythingAndLoadsNothing) {
  const TempDir dir;
  const fs::path corpus = dir.path() / "corpus";
  fs::copy(data_dir() / "grid_s1_sample", corpus, fs::copy_options::recursive);
  // What is said in a sentence comes from outside.
  std::string rows = slurp((corpus / "utterances.tsv").string());
  const std::size_t text = rows.find("bin ");
  ASSERT_NE(text, std::string::npos);
  rows.replace(text, 3, "<script>alert(1)</script>");
  spill((corpus / "utterances.tsv").string(), rows);
  const auto result =
      animeme({"evaluate", "builtin", corpus.string(), "--report", dir / "me.html", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string html = slurp(dir / "me.html");
  const Json json = Json::parse(result.out);
  char nrmse[16];
  std::snprintf(nrmse, sizeof nrmse, "%.2f", double(json["mean_nrmse"]));
  EXPECT_THAT(html, HasSubstr(std::string("<th>error</th><td class=\"n\">") + nrmse));
  EXPECT_EQ(count(html, "<iframe "), 3u);
  EXPECT_EQ(count(html, "<svg"), 1u) << "curves";
  for (const char* part :
       {"P, B, M closed", "On the head", "Phones", "Controls", "fap3_open_jaw", "Outliers"})
    EXPECT_THAT(html, HasSubstr(part));
  EXPECT_EQ(count(html, "<script"), 0u) << "but in frames, escaped";
  EXPECT_EQ(count(html, "src=\"http") + count(html, "href=\"http") + count(html, "=&quot;http"),
            0u);
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, HasSubstr("'wasm-unsafe-eval'")) << "frames inherit it, and heads need it";
  const auto again =
      animeme({"evaluate", "builtin", corpus.string(), "--report", dir / "you.html"});
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_TRUE(html == slurp(dir / "you.html")) << "not the same twice";
}

TEST(Sheet, CharactersWithoutAFaceAndOneSentence) {
  const TempDir dir;
  const fs::path corpus = dir.path() / "corpus";
  fs::create_directories(corpus / "fap");
  fs::create_directories(corpus / "phonemes");
  std::string curve = "time_s,snout\n";
  for (int i = 0; i < 50; ++i)
    curve += std::to_string(i / 25.0) + "," + std::to_string(i % 7) + "\n";
  spill((corpus / "fap" / "a.csv").string(), curve);
  spill((corpus / "phonemes" / "a.tsv").string(),
        "start_s\tend_s\tphone\n0\t0.5\tSIL\n0.5\t1.0\tAA\n1.0\t1.5\tM\n1.5\t2\tSIL\n");
  spill((corpus / "utterances.tsv").string(), "id\ttext\na\tam\n");
  succeeds({"train", corpus.string(), "-o", dir / "snout.dam"});
  succeeds({"evaluate", dir / "snout.dam", corpus.string(), "--report", dir / "snout.html"});
  const std::string html = slurp(dir / "snout.html");
  EXPECT_THAT(html, HasSubstr("neither FAPs nor ARKit shapes"));
  EXPECT_EQ(count(html, "<iframe"), 0u);
  EXPECT_THAT(html, HasSubstr("1: record more")) << "one AA in training";
  const auto wrong =
      animeme({"evaluate", dir / "snout.dam", corpus.string(), "--report", dir / "a.pdf"});
  EXPECT_EQ(wrong.exit_code, 2);
}

}  // namespace sheet_test
}  // namespace animeme::test
