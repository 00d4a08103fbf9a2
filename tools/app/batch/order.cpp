// The index in the order of the manifest, and the report.
#include <algorithm>

#include "tools/app/batch/index.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/files/output_file.h"

namespace animeme::batch {

namespace {

constexpr std::size_t kMostShown = 1000;  // rows of the report

// Errors first, then low alignment confidence, then most warnings.
double badness(const Entry& entry) {
  if (!entry.good) return 1e6;
  const double doubt = entry.confidence ? 1 - *entry.confidence : 0;
  return 1000 * doubt + double(std::min<std::size_t>(entry.warnings.size(), 100));
}

class Worst {
 public:
  void add(Entry entry) {
    const double bad = badness(entry);
    if (list_.size() == kMostShown && bad <= list_.back().first) return;
    const auto at =
        std::upper_bound(list_.begin(), list_.end(), bad,
                         [](double value, const auto& one) { return value > one.first; });
    list_.insert(at, {bad, std::move(entry)});
    if (list_.size() > kMostShown) list_.pop_back();
  }
  const std::vector<std::pair<double, Entry>>& list() const { return list_; }

 private:
  std::vector<std::pair<double, Entry>> list_;
};

std::string cells_of(const Entry& entry) {
  std::string notes = entry.error;
  for (const std::string& warning : entry.warnings) notes += (notes.empty() ? "" : "; ") + warning;
  const auto cell = [](const std::string& text) {
    return "<td>" + tools::escape_xml(text) + "</td>";
  };
  return cell(entry.id) + cell(entry.good ? "ok" : "error") + cell(notes) +
         cell(entry.confidence ? tools::format("%.2f", *entry.confidence) : "") +
         cell(entry.seconds ? tools::format("%.1f", *entry.seconds) : "") +
         cell(std::to_string(entry.bytes));
}

std::string report_page(const Totals& totals, const Worst& worst) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Batch</title>\n"
      "<style>body{font:15px sans-serif;margin:2em}table{border-collapse:collapse}"
      "td,th{padding:.3em .7em;text-align:left;border-bottom:1px solid #ccc}"
      ".error{background:#fdd}</style>\n";
  page += tools::format(
      "<h1>Batch</h1><p>%llu clips: %llu done, %llu failed, %llu missing, %llu with warnings; "
      "%.1f min of speech, %llu bytes.</p>\n",
      static_cast<unsigned long long>(totals.rows), static_cast<unsigned long long>(totals.good),
      static_cast<unsigned long long>(totals.failed),
      static_cast<unsigned long long>(totals.missing),
      static_cast<unsigned long long>(totals.with_warnings), totals.seconds / 60,
      static_cast<unsigned long long>(totals.bytes));
  page += tools::format(
      "<p>The worst %zu, worst first:</p>\n<table><tr><th>id<th>state<th>what<th>"
      "confidence<th>seconds<th>bytes</tr>\n",
      worst.list().size());
  for (const auto& [bad, entry] : worst.list()) {
    page += std::string(entry.good ? "<tr>" : "<tr class=\"error\">") + cells_of(entry) + "</tr>\n";
  }
  return page + "</table></html>\n";
}

}  // namespace

Result<Totals> put_in_order(Manifest& manifest,
                            const std::function<const Index*(std::string_view id)>& index_of,
                            const std::string& to, const std::string& report) {
  if (auto begun = manifest.rewind(); !begun) return begun.error();
  Totals totals;
  Worst worst;
  tools::OutputFile file(to);
  if (auto done = file.write(index_header()); !done) return done.error();
  for (;;) {
    const Result<std::optional<Row>> row = manifest.next();
    if (!row) return row.error();
    if (!*row) break;
    const std::string_view id = (*row)->at("id");
    const Index* index = index_of(id);
    if (index == nullptr) continue;
    ++totals.rows;
    const Index::Known* known = index->find(id);
    if (known == nullptr) {
      ++totals.missing;
      continue;
    }
    const Result<std::string> line = index->line(*known);
    if (!line) return line.error();
    if (auto done = file.write(*line); !done) return done.error();
    std::optional<Entry> entry =
        read_index_line(std::string_view(*line).substr(0, line->size() - 1));
    if (!entry) return make_error(Code::syntax, "a line of the index is damaged").in_file(to);
    ++(entry->good ? totals.good : totals.failed);
    totals.with_warnings += entry->warnings.empty() ? 0 : 1;
    totals.seconds += entry->seconds.value_or(0);
    totals.bytes += entry->bytes;
    worst.add(*std::move(entry));
  }
  if (auto done = file.publish(); !done) return done.error();
  if (auto done = tools::write_file(report, report_page(totals, worst)); !done) return done.error();
  return totals;
}

}  // namespace animeme::batch
