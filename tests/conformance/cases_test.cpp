// The committed suite: complete, undamaged, described rightly, and made again byte for byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "conformance/analyse.h"
#include "conformance/describe.h"
#include "conformance/features.h"
#include "conformance/sha256.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme::conformance {
namespace cases_test {

namespace fs = std::filesystem;
using test::slurp;

const fs::path kCases = fs::path(test::kBinaryFolder) / "conformance" / "cases";
const fs::path kTree = fs::path(test::kSourceFolder) / "conformance" / "cases";

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kTree)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

MadeCase load(const std::string& name) {
  Result<Case> info = read_case(slurp(kTree / name / "case.json"));
  EXPECT_TRUE(info) << name << ": " << info.error().describe();
  MadeCase made;
  if (!info) return made;
  made.info = *info;
  for (const CaseFile& file : info->files) {
    made.content[file.role] = slurp(kCases / name / file.name);
  }
  return made;
}

TEST(Cases, AreCompleteAndSayWhatTheStreamsHold) {
  const std::vector<std::string> names = case_names();
  ASSERT_GE(names.size(), 200u);
  for (const std::string& name : names) {
    MadeCase made = load(name);
    EXPECT_EQ(made.info.name, name);
    const std::string committed = slurp(kTree / name / "case.json");
    const auto ok = describe(made);
    EXPECT_TRUE(ok) << name << ": " << ok.error().describe();
    EXPECT_EQ(write_case(made.info), committed) << name;
    EXPECT_FALSE(made.info.title.empty()) << name;
    std::set<std::string> listed = {"case.json"};
    for (const CaseFile& file : made.info.files) listed.insert(file.name);
    for (const auto& entry : fs::directory_iterator(kCases / name)) {
      EXPECT_TRUE(listed.contains(entry.path().filename().string())) << entry.path();
    }
  }
}

TEST(Cases, CoverTheVocabulary) {
  std::set<std::string> covered;
  for (const std::string& name : case_names()) {
    for (const std::string& feature : load(name).info.features) covered.insert(feature);
  }
  for (const Family& family : families()) {
    for (const std::string& member : family.members) {
      const std::string feature = std::string(family.name) + "." + member;
      EXPECT_TRUE(covered.contains(feature)) << feature;
    }
  }
}

TEST(Cases, AreGeneratedByteForByte) {
  const test::TempDir dir;
  const auto made = test::run_command(
      {std::string(test::kBinaryFolder) + "/bin/make_cases", "generate", dir.path().string()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  int cases = 0;
  for (const auto& folder : fs::directory_iterator(dir.path())) {
    ++cases;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const fs::path same = kCases / folder.path().filename() / entry.path().filename();
      EXPECT_TRUE(fs::exists(same)) << same << ": run conformance/pack.sh";
      EXPECT_TRUE(slurp(entry.path()) == slurp(same)) << same << ": run conformance/pack.sh";
    }
  }
  int committed = 0;
  for (const std::string& name : case_names()) {
    committed += load(name).info.origin.starts_with("conformance/make_cases");
  }
  EXPECT_EQ(cases, committed);
}

TEST(Cases, AnotherSeedGivesOtherStreamsWithTheSameFeatures) {
  const std::vector<MadeCase> first = make_all_cases(1);
  const std::vector<MadeCase> second = make_all_cases(20260);
  ASSERT_EQ(first.size(), second.size());
  int different = 0;
  std::set<std::string> covered;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].info.name, second[i].info.name);
    different += first[i].content.at("stream") != second[i].content.at("stream");
    MadeCase made = second[i];
    const auto ok = describe(made);
    EXPECT_TRUE(ok) << made.info.name << ": " << ok.error().describe();
    covered.insert(made.info.features.begin(), made.info.features.end());
  }
  EXPECT_GT(different, 100);
  for (const Family& family : families()) {
    for (const std::string& member : family.members) {
      const std::string feature = std::string(family.name) + "." + member;
      EXPECT_TRUE(covered.contains(feature)) << feature;
    }
  }
}

TEST(Describe, FindsAWrongExpectation) {
  MadeCase made = load("quant_07");
  std::string& text = made.content["face"];
  text[text.size() - 2] = text[text.size() - 2] == '7' ? '8' : '7';
  EXPECT_FALSE(describe(made));
}

TEST(Describe, FindsADamageThatIsNone) {
  MadeCase made = load("quant_07");
  made.info.damaged = true;
  made.info.errors = {"syntax"};
  const auto result = describe(made);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, testing::HasSubstr("reports no error"));
}

TEST(Describe, FindsAnErrorOfAnotherKind) {
  MadeCase made = load("bad_dct_face");
  made.info.errors = {"syntax"};
  const auto result = describe(made);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, testing::HasSubstr("another kind"));
}

TEST(Describe, FindsOtherParameters) {
  MadeCase made = load("quant_07");
  std::string& epf = made.content["parameters"];
  const std::size_t at = epf.find("GDR 0");
  ASSERT_NE(at, std::string::npos);
  epf[at + 4] = '1';
  EXPECT_FALSE(describe(made));
}

TEST(Analyse, SeesWhereASecondEncoderDiffers) {
  // The rewrite of one stream, held against another of the same length.
  MadeCase made = load("quant_07");
  const std::string& stream = made.content["stream"];
  std::vector<std::uint8_t> bytes(stream.begin(), stream.end());
  auto decoded = fba::decode(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_TRUE(analyse(bytes, *decoded).same_when_rewritten);
  bytes[40] ^= 4;
  const StreamFacts facts = analyse(bytes, *decoded);
  EXPECT_FALSE(facts.same_when_rewritten);
  EXPECT_EQ(facts.first_difference_bit, 40 * 8 + 5);
}

TEST(CaseFile, RefusesWhatIsNoCase) {
  const std::string good = slurp(kTree / "quant_07" / "case.json");
  EXPECT_TRUE(read_case(good));
  const auto without = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return read_case(text.replace(at, part.size(), instead));
  };
  EXPECT_FALSE(read_case(""));
  EXPECT_FALSE(read_case("[]"));
  EXPECT_FALSE(read_case(good.substr(0, good.size() / 2)));
  EXPECT_FALSE(without("\"title\"", "\"titel\""));
  EXPECT_FALSE(without("\"decode\"", "\"perhaps\""));
  EXPECT_FALSE(without("\"planes\": ", "\"planes\": \"x\" , \"y\": "));
  EXPECT_FALSE(without("\"stream\": {", "\"river\": {"));
  EXPECT_FALSE(without("\"name\": \"quant_07.fba\"", "\"name\": \"../quant_07.fba\""));
}

TEST(Features, AreOneListWithoutRepetition) {
  std::set<std::string> ids;
  for (const Family& family : families()) {
    for (const std::string& member : family.members) {
      const std::string id = std::string(family.name) + "." + member;
      EXPECT_TRUE(ids.insert(id).second) << id;
      ASSERT_NE(family_of(id), nullptr);
      EXPECT_EQ(family_of(id)->name, family.name);
    }
  }
  EXPECT_EQ(family_of("quant.32"), nullptr);
  EXPECT_EQ(certainty_of(std::vector<std::string>{"object.face", "quant.1"}), 'S');
  EXPECT_EQ(certainty_of(std::vector<std::string>{"range_rescaled.face", "object.face"}), '?');
}

}  // namespace cases_test
}  // namespace animeme::conformance
