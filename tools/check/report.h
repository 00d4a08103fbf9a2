/// @file
/// The results of a run, for people and for programs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/check/run_suite.h"

namespace animeme::tools {

/// How many cases had each verdict, and so on.
struct Tally {
  std::size_t cases = 0, right = 0, skipped = 0, bad_data = 0;
  std::size_t parameters = 0, encoded_again = 0;  ///< cases with an EPF; written byte for byte
  std::map<Verdict, std::size_t> verdicts;
  bool all_right() const { return right + skipped == cases; }
};
Tally tally(const std::vector<CaseResult>& results);

/// A table by family of features, the cases that are not right, and a closing line.
std::string text_report(const std::vector<CaseResult>& results, bool own);
/// Everything, with every feature.
std::string json_report(const Suite& suite, const std::vector<CaseResult>& results,
                        const std::string& decoder);
/// JUnit XML, one test a case.
std::string junit_report(const Suite& suite, const std::vector<CaseResult>& results);
/// The vocabulary with the number of cases for each feature, as a Markdown table.
std::string coverage_table(const std::vector<const SuiteCase*>& cases);

}  // namespace animeme::tools
