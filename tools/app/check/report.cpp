#include "tools/app/check/report.h"

#include <set>

#include "conformance/features.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"

namespace animeme::tools {
namespace {

using conformance::Family;

// Failed where the standard does not say what is right.
bool is_unsettled(const CaseResult& result) {
  return !result.counts && !is_right(result.verdict) && result.verdict != Verdict::skipped;
}

// How often a feature occurs, and in how many cases that are right.
struct Count {
  std::size_t cases = 0, right = 0;
};

std::map<std::string, Count> by_feature(const std::vector<CaseResult>& results) {
  std::map<std::string, Count> out;
  for (const CaseResult& result : results) {
    if (result.verdict == Verdict::skipped) continue;
    for (const std::string& feature : result.one->info.features) {
      ++out[feature].cases;
      out[feature].right += is_right(result.verdict);
    }
  }
  return out;
}

bool has_family(const conformance::Case& info, const Family& family) {
  for (const std::string& feature : info.features) {
    if (conformance::family_of(feature) == &family) return true;
  }
  return false;
}

std::string family_rows(const std::vector<CaseResult>& results) {
  const auto features = by_feature(results);
  std::string out = format("%-52s %-4s %-4s %9s %6s %6s\n", "feature", "sec.", "mark", "covered",
                           "cases", "right");
  for (const Family& family : conformance::families()) {
    Count count;
    for (const CaseResult& result : results) {
      if (result.verdict == Verdict::skipped || !has_family(result.one->info, family)) continue;
      ++count.cases;
      count.right += is_right(result.verdict);
    }
    if (count.cases == 0) continue;
    std::size_t covered = 0;
    for (const std::string& member : family.members) {
      covered += features.count(std::string(family.name) + "." + member);
    }
    const std::string share = std::to_string(covered) + "/" + std::to_string(family.members.size());
    out += format("%-52.52s %-4s %-4c %9s %6zu %6zu%s\n", std::string(family.title).c_str(),
                  std::string(family.section).c_str(), family.certainty, share.c_str(), count.cases,
                  count.right, count.right < count.cases ? "  <--" : "");
  }
  return out;
}

// The features of which no case at all is right: where to look first.
std::string never_right(const std::vector<CaseResult>& results) {
  std::string out;
  for (const auto& [feature, count] : by_feature(results)) {
    if (count.right == 0) out += (out.empty() ? "" : ", ") + feature;
  }
  return out.empty() ? out : "features without a correct case: " + out + "\n";
}

// Right, but not exact: one line for each reason.
std::string right_but(const std::vector<CaseResult>& results) {
  std::map<std::pair<Verdict, std::string>, std::vector<std::string>> reasons;
  for (const CaseResult& result : results) {
    if (!is_right(result.verdict) || result.verdict == Verdict::exact) continue;
    reasons[{result.verdict, result.detail}].push_back(result.one->info.name);
  }
  constexpr std::size_t kShown = 3;
  std::string out;
  for (const auto& [reason, names] : reasons) {
    out += format("%-8s ", verdict_name(reason.first)) + reason.second + ": ";
    for (std::size_t i = 0; i < names.size() && i < kShown; ++i)
      out += (i > 0 ? ", " : "") + names[i];
    if (names.size() > kShown) out += " and " + std::to_string(names.size() - kShown) + " more";
    out += "\n";
  }
  return out;
}

Json to_json(const CaseResult& result) {
  const conformance::Case& info = result.one->info;
  Json json = {{"name", info.name},
               {"verdict", verdict_name(result.verdict)},
               {"right", is_right(result.verdict)},
               {"detail", result.detail},
               {"seconds", result.end.seconds}};
  if (result.end.how == ChildEnd::How::exited) json["exit_code"] = result.end.code;
  if (result.end.how == ChildEnd::How::crashed) json["signal"] = result.end.code;
  if (!result.difference.parameter.empty()) {
    const FirstDifference& difference = result.difference;
    json["first_difference"] = {{"frame", difference.frame},
                                {"parameter", difference.parameter},
                                {"expected", difference.expected}};
    json["first_difference"]["got"] = difference.missing ? Json() : Json(difference.got);
  }
  if (result.encoded_again) json["encoded_again"] = true;
  if (is_unsettled(result)) json["counts"] = false;
  json["certainty"] = info.certainty;
  json["features"] = info.features;
  return json;
}

// Output of foreign programs may be anything, so ASCII alone is passed on.
std::string xml(std::string text) {
  for (char& c : text) c = c >= 0x20 && c < 0x7F ? c : '?';
  return escape_xml(text);
}

std::string junit_case(const CaseResult& result) {
  const conformance::Case& info = result.one->info;
  std::string out = "  <testcase classname=\"conformance." + xml(info.object) + "\" name=\"" +
                    xml(info.name) + "\" time=\"" + format("%.3f", result.end.seconds) + "\"";
  if (is_right(result.verdict)) return out + "/>\n";
  const bool failure = result.verdict == Verdict::wrong || result.verdict == Verdict::encoder;
  const bool skipped = result.verdict == Verdict::skipped || is_unsettled(result);
  const char* element = skipped ? "skipped" : failure ? "failure" : "error";
  out += std::string(">\n    <") + element + " message=\"" + xml(result.detail) + "\"";
  if (!skipped) {
    out += std::string(" type=\"") + verdict_name(result.verdict) + "\"";
  }
  return out + "/>\n  </testcase>\n";
}

}  // namespace

Tally tally(const std::vector<CaseResult>& results) {
  Tally out;
  for (const CaseResult& result : results) {
    ++out.cases;
    ++out.verdicts[result.verdict];
    out.right += is_right(result.verdict);
    out.skipped += result.verdict == Verdict::skipped;
    out.unsettled += is_unsettled(result);
    out.bad_data += result.verdict == Verdict::bad_data;
    out.parameters += result.one->path.count("parameters");
    out.encoded_again += result.encoded_again;
  }
  return out;
}

std::string text_report(const std::vector<CaseResult>& results, bool own) {
  const Tally sum = tally(results);
  std::string out;
  bool described = false;
  for (const CaseResult& result : results) described |= !result.one->info.features.empty();
  if (described) out += family_rows(results) + "\n";
  out += right_but(results);
  for (const CaseResult& result : results) {
    if (is_right(result.verdict)) continue;
    out +=
        format("%-8s ", verdict_name(result.verdict)) + result.one->info.name + ": " +
        result.detail +
        (is_unsettled(result) ? " (mark " + result.one->info.certainty + ", does not count)" : "") +
        "\n";
  }
  if (!sum.all_right()) out += never_right(results);
  std::string verdicts;
  for (const auto& [verdict, count] : sum.verdicts) {
    verdicts +=
        (verdicts.empty() ? "" : ", ") + std::to_string(count) + " " + verdict_name(verdict);
  }
  out += std::to_string(sum.right) + " of " + std::to_string(sum.cases) + " cases right (" +
         verdicts + ")";
  if (sum.unsettled > 0) {
    out += "; " + std::to_string(sum.unsettled) +
           " others are not settled by the standard and do not count (--count all)";
  }
  if (own && sum.encoded_again > 0) {
    out += "; " + std::to_string(sum.encoded_again) + " of " + std::to_string(sum.parameters) +
           " streams re-encoded byte for byte";
  }
  return out + "\n";
}

std::string json_report(const Suite& suite, const std::vector<CaseResult>& results,
                        const std::string& decoder) {
  const Tally sum = tally(results);
  Json json = {{"suite", suite.name},
               {"decoder", decoder},
               {"cases", sum.cases},
               {"right", sum.right},
               {"skipped", sum.skipped},
               {"unsettled", sum.unsettled},
               {"encoded_again", sum.encoded_again}};
  for (const auto& [verdict, count] : sum.verdicts) json["verdicts"][verdict_name(verdict)] = count;
  json["features"] = Json::object();
  const auto features = by_feature(results);
  for (const Family& family : conformance::families()) {
    for (const std::string& member : family.members) {
      const std::string id = std::string(family.name) + "." + member;
      const auto found = features.find(id);
      const Count count = found == features.end() ? Count() : found->second;
      json["features"][id] = {{"cases", count.cases}, {"right", count.right}};
    }
  }
  json["results"] = json_list(results, to_json);
  // What foreign programs print need not be UTF-8.
  return pretty(json) + "\n";
}

std::string junit_report(const Suite& suite, const std::vector<CaseResult>& results) {
  const Tally sum = tally(results);
  std::size_t failures = 0;
  double seconds = 0;
  std::string cases;
  for (const CaseResult& result : results) {
    failures += !is_unsettled(result) &&
                (result.verdict == Verdict::wrong || result.verdict == Verdict::encoder);
    seconds += result.end.seconds;
    cases += junit_case(result);
  }
  const std::size_t skipped = sum.skipped + sum.unsettled;
  const std::size_t errors = sum.cases - sum.right - skipped - failures;
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"" + xml(suite.name) +
         "\" tests=\"" + std::to_string(sum.cases) + "\" failures=\"" + std::to_string(failures) +
         "\" errors=\"" + std::to_string(errors) + "\" skipped=\"" + std::to_string(skipped) +
         "\" time=\"" + format("%.3f", seconds) + "\">\n" + cases + "</testsuite>\n";
}

std::string coverage_table(const std::vector<const SuiteCase*>& cases) {
  std::map<std::string, std::size_t> count;
  std::map<const Family*, std::size_t> in_family;
  for (const SuiteCase* one : cases) {
    std::set<const Family*> seen;
    for (const std::string& feature : one->info.features) {
      ++count[feature];
      seen.insert(conformance::family_of(feature));
    }
    for (const Family* family : seen) ++in_family[family];
  }
  std::string out =
      "| feature | section | mark | cases | members (cases) |\n|---|---|---|---|---|\n";
  for (const Family& family : conformance::families()) {
    std::string members;
    std::size_t covered = 0, least = 0, most = 0;
    for (const std::string& member : family.members) {
      const std::size_t n = count[std::string(family.name) + "." + member];
      least = covered == 0 && members.empty() ? n : std::min(least, n);
      most = std::max(most, n);
      covered += n > 0;
      members += (members.empty() ? "" : ", ") + member + " (" + std::to_string(n) + ")";
    }
    if (family.members.size() > 20) {
      members = std::to_string(covered) + " of " + std::to_string(family.members.size()) + ", " +
                family.members.front() + " to " + family.members.back() + " (" +
                std::to_string(least) + " to " + std::to_string(most) + ")";
    }
    out += "| `" + std::string(family.name) + "` " + std::string(family.title) + " | " +
           std::string(family.section) + " | " + family.certainty + " | " +
           std::to_string(in_family[&family]) + " | " + members + " |\n";
  }
  return out + std::to_string(cases.size()) + " cases\n";
}

}  // namespace animeme::tools
