/// @file
/// The results of a run as text, JSON and JUnit XML.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/app/check/run_suite.h"

namespace animeme::tools {

/// Counts of a run.
struct Tally {
  std::size_t cases = 0,                    ///< all
      right = 0,                            ///< with a right verdict
      skipped = 0,                          ///< not run
      unsettled = 0,                        ///< failed, but CaseResult::counts
      bad_data = 0;                         ///< damaged suite
  std::size_t parameters = 0,               ///< with an EPF
      encoded_again = 0;                    ///< written byte for byte
  std::map<Verdict, std::size_t> verdicts;  ///< how many of each
  /// No failures that count.
  bool all_right() const { return right + skipped + unsettled == cases; }
};
Tally tally(const std::vector<CaseResult>& results);  ///< counts the results of a run

/// A table by feature family, the failed cases, and a summary line.
std::string text_report(const std::vector<CaseResult>& results, bool own);
/// Everything, with every feature.
std::string json_report(const Suite& suite, const std::vector<CaseResult>& results,
                        const std::string& decoder);
/// JUnit XML, one test a case.
std::string junit_report(const Suite& suite, const std::vector<CaseResult>& results);
/// The vocabulary with the number of cases for each feature, as a Markdown table.
std::string coverage_table(const std::vector<const SuiteCase*>& cases);

}  // namespace animeme::tools
