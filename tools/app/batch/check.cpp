// What is wrong with a manifest.
#include <algorithm>

#include "fap/detail/text_scanner.h"
#include "tools/app/batch/batch.h"
#include "tools/app/batch/plan.h"

namespace animeme::batch {

namespace {

constexpr std::size_t kMostProblems = 20;

// A name and where it was met first.
struct Met {
  std::uint64_t hash;
  std::int64_t line;
};

// Lines whose names were met before, at 16 bytes a name.
void find_twice(std::vector<Met>& met, const std::string& file, const char* what,
                std::vector<std::string>& problems) {
  std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.line < b.line;
  });
  std::vector<Met> later;
  for (std::size_t i = 1; i < met.size() && later.size() < kMostProblems; ++i) {
    if (met[i].hash != met[i - 1].hash) continue;
    later.push_back({std::uint64_t(met[i - 1].line), met[i].line});
  }
  std::sort(later.begin(), later.end(), [](const Met& a, const Met& b) { return a.line < b.line; });
  for (const Met& one : later) {
    if (problems.size() >= kMostProblems) return;
    problems.push_back(error_at_line(Code::syntax,
                                     std::string(what) + " is that of line " +
                                         std::to_string(one.hash) +
                                         ", too (letters of either case count as one)",
                                     one.line)
                           .in_file(file)
                           .describe());
  }
}

bool is_ours(const std::string& name) {
  return name == "report.html" || name == "index.tsv" ||
         (name.starts_with("index.") && name.find("-of-") != std::string::npos) ||
         (name.starts_with("report.") && name.find("-of-") != std::string::npos);
}

}  // namespace

Result<std::uint64_t> check_manifest(Manifest& manifest, int shard, int shards,
                                     std::vector<std::string>& problems) {
  std::vector<Met> ids, outputs;
  std::uint64_t rows = 0;
  while (problems.size() < kMostProblems) {
    const Result<std::optional<Row>> row = manifest.next();
    if (!row) {
      if (row.error().code != Code::syntax) return row.error();
      problems.push_back(row.error().describe());
      continue;
    }
    if (!*row) break;
    const std::string id = fap::detail::lower_case(std::string((*row)->at("id")));
    ids.push_back({stable_hash(id), (*row)->line});
    if (const Result<Plan> plan = plan_row(**row, "."); plan) {
      for (const std::string& name : plan->outputs) {
        const std::string lower = fap::detail::lower_case(name);
        outputs.push_back({stable_hash(lower), (*row)->line});
        if (is_ours(lower)) {
          problems.push_back(error_at_line(Code::syntax,
                                           "the output " + name +
                                               " is the name of a file of the "
                                               "batch itself; give the row another id",
                                           (*row)->line)
                                 .in_file(manifest.name())
                                 .describe());
        }
      }
    }
    if (shard_of((*row)->at("id"), shards) == shard) ++rows;
  }
  find_twice(ids, manifest.name(), "the id", problems);
  if (problems.empty()) find_twice(outputs, manifest.name(), "a file that the row makes", problems);
  return rows;
}

Error problem_error(const std::vector<std::string>& problems) {
  std::string text = "the manifest is broken, nothing was done:";
  for (const std::string& one : problems) text += "\n  " + one;
  return make_error(Code::syntax, text);
}

}  // namespace animeme::batch
