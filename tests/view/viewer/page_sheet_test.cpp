// The report of an evaluation on a phone and on a desktop: nothing to scroll sideways, and what
// axe-core says of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dam/evaluation/evaluate.h"
#include "dam/signal/fap_signal.h"
#include "tests/view/viewer/page_support.h"
#include "tools/view/sheet/sheet.h"

namespace animeme::test {
namespace page_sheet_test {

// Names as long as those of real corpora, and phones of every kind.
std::vector<dam::SentencePair> pairs() {
  std::vector<dam::SentencePair> list;
  for (int n = 0; n < 3; ++n) {
    dam::SentencePair pair;
    pair.recorded.id = "speaker_with_a_long_name_session_03_take_" + std::to_string(n);
    pair.recorded.text =
        "bin blue at f two now and the farmer drove his old truck across the field";
    pair.recorded.signal.rate = {25, 1};
    for (int fap = 3; fap <= 13; ++fap) pair.recorded.signal.names.push_back(dam::fap_channel(fap));
    double at = 0;
    for (const char* label : {"SIL", "B", "IH", "N", "S", "OW", "M", "F", "AY", "V", "SIL"}) {
      pair.recorded.script.phones.push_back({at, at + 0.2, label, ""});
      at += 0.2;
    }
    pair.synthesised = pair.recorded.signal;
    for (int i = 0; i < 55; ++i) {
      for (int fap = 3; fap <= 13; ++fap) {
        const double value = 100 * std::sin(0.3 * i + fap);
        pair.recorded.signal.values.push_back(value);
        pair.synthesised.values.push_back(0.7 * value + 8 * n);
      }
    }
    list.push_back(std::move(pair));
  }
  return list;
}

TEST(PageSheet, FitsAPhoneAndHasNoViolations) {
  NEEDS_BROWSER();
  NEEDS_NPM("axe-core");
  const TempDir dir;
  const std::vector<dam::SentencePair> sentences = pairs();
  const auto evaluation = dam::score(sentences);
  ASSERT_TRUE(evaluation) << evaluation.error().describe();
  const TestHead& h = test_head();
  sheet::Sheet sheet;
  sheet.title = "a_model_with_a_long_name_of_its_own.dam";
  sheet.corpus = "/somewhere/in/a/folder/with/a/name/that/does/not/break";
  sheet.pairs = &sentences;
  sheet.evaluation = &*evaluation;
  sheet.head = &h.head;
  sheet.rig = &h.rig;
  const auto html = sheet::make_sheet(sheet);
  ASSERT_TRUE(html) << html.error().describe();
  const Json report = report_of("sheet", *html, dir);
  ASSERT_TRUE(report.contains("checked"));
  EXPECT_EQ(report["violations"], Json::array());
  EXPECT_EQ(report["beyond"], Json::array());
  EXPECT_EQ(report["widths"], Json::parse("[0, 0, 0, 0]"));
  ASSERT_THAT(report["checked"], testing::SizeIs(4));
  for (const Json& checked : report["checked"]) EXPECT_GT(checked, 20);
}

}  // namespace page_sheet_test
}  // namespace animeme::test
