// Shards put together.
#include <cstdio>
#include <filesystem>

#include "tools/app/batch/batch.h"

namespace animeme::batch {

namespace fs = std::filesystem;

namespace {

// The number of shards of the indices in a folder; 0: there are none.
Result<int> shards_in(const std::string& folder) {
  int shards = 0;
  std::error_code failed;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, failed)) {
    const std::string name = file.path().filename().string();
    int shard = 0, all = 0;
    if (std::sscanf(name.c_str(), "index.%d-of-%d.tsv", &shard, &all) != 2) continue;
    if (name != index_name(shard, all)) continue;
    if (shards != 0 && shards != all) {
      return make_error(Code::invalid_argument, "there are shards of " + std::to_string(shards) +
                                                    " and of " + std::to_string(all) +
                                                    "; remove those that are not wanted")
          .in_file(folder);
    }
    shards = all;
  }
  // One shard of one is the whole index, and what was joined before may be joined again.
  if (shards < 1 && fs::exists(fs::path(folder) / index_name(1, 1), failed)) shards = 1;
  if (shards < 1) return make_error(Code::not_found, "there are no shards to join").in_file(folder);
  return shards;
}

Result<void> check_outputs(const Index& index, Manifest& manifest, const Settings& settings,
                           int shard, int shards) {
  if (auto begun = manifest.rewind(); !begun) return begun;
  for (;;) {
    const Result<std::optional<Row>> row = manifest.next();
    if (!row) return row.error();
    if (!*row) return {};
    const std::string id((*row)->at("id"));
    if (shard_of(id, shards) != shard) continue;
    const std::string again = "; run shard " + std::to_string(shard) + "/" +
                              std::to_string(shards) + " again with --resume";
    const Index::Known* known = index.find(id);
    if (known == nullptr) {
      return make_error(Code::not_found, "clip \"" + id + "\" is not done" + again)
          .in_file(index_name(shard, shards));
    }
    const Result<std::string> line = index.line(*known);
    if (!line) return line.error();
    const auto entry = read_index_line(std::string_view(*line).substr(0, line->size() - 1));
    if (!entry || !entry->good || !settings.shared.store.empty()) continue;
    std::uint64_t bytes = 0;
    for (const std::string& name : entry->outputs) {
      std::error_code missing;
      const std::uint64_t size = fs::file_size(settings.shared.out + "/" + name, missing);
      if (missing) return make_error(Code::not_found, "is missing" + again).in_file(name);
      bytes += size;
    }
    if (bytes != entry->bytes) {
      return make_error(Code::io, "its outputs have another size than they had" + again)
          .in_file(id);
    }
  }
}

}  // namespace

Result<Totals> join_batch(const Settings& settings) {
  const std::string& out = settings.shared.out;
  Result<Manifest> manifest =
      Manifest::open(settings.manifest, settings.form, settings.defaults, settings.allow_commands);
  if (!manifest) return manifest.error();
  std::vector<std::string> problems;
  if (auto rows = check_manifest(*manifest, 1, 1, problems); !rows) return rows.error();
  if (!problems.empty()) return problem_error(problems);
  const Result<int> shards = shards_in(out);
  if (!shards) return shards.error();
  std::vector<Index> all;
  for (int shard = 1; shard <= *shards; ++shard) {
    Result<Index> index = Index::open(out + "/" + index_name(shard, *shards), false);
    if (!index) return index.error();
    all.push_back(*std::move(index));
    auto good = check_outputs(all.back(), *manifest, settings, shard, *shards);
    if (!good) return good.error();
  }
  return put_in_order(
      *manifest, [&](std::string_view id) { return &all[std::size_t(shard_of(id, *shards) - 1)]; },
      out + "/index.tsv", out + "/report.html");
}

}  // namespace animeme::batch
