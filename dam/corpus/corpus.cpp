#include "dam/corpus/corpus.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "dam/corpus/rows_internal.h"
#include "dam/script/table_text_internal.h"
#include "dam/signal/fap_signal.h"
#include "fap/detail/whole_file.h"
#include "fap/text.h"

namespace animeme::dam {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestMismatch = 0.5;  // seconds between the ends of script and signal

Error error_in(const fs::path& file, Code code, std::string message, std::size_t line = 0) {
  return {code, std::move(message), {file.string(), std::int64_t(line), 0, -1}};
}

constexpr const char* kWantedByRow =
    "cannot open this file, which a row of utterances.tsv requires";

/// `missing`: the sentence for a file that cannot be opened.
Result<std::string> read_file(const fs::path& path, const char* missing = kWantedByRow) {
  auto text = fap::detail::read_whole_text(path);
  if (text) return text;
  Error error = text.error();
  if (error.code == Code::not_found) error.message = missing;
  return std::move(error).in_file(path.string());
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// An identifier becomes part of a path, so it must not lead elsewhere.
bool safe_id(std::string_view id) {
  return !id.empty() && id != "." && id != ".." &&
         id.find_first_of(std::string_view("/\\:\0", 4)) == std::string_view::npos;
}

Result<std::vector<Utterance>> read_rows(const fs::path& path, const CorpusOptions& options) {
  const auto text =
      read_file(path, "cannot open this table; a corpus is a folder that contains it");
  if (!text) return text.error();
  auto rows = parse_rows(*text, options);
  if (!rows) return std::move(rows).error().in_file(path.string());
  return rows;
}

Result<Script> read_phonemes(const fs::path& folder, const std::string& id) {
  fs::path path = folder / "phonemes" / (id + ".tsv");
  if (!is_file(path) && is_file(folder / "phonemes" / (id + ".TextGrid")))
    path.replace_extension(".TextGrid");
  const auto text = read_file(path);
  if (!text) return text.error();
  auto script = read_script(*text);
  if (!script) return std::move(script).error().in_file(path.string());
  return script;
}

Result<Signal> read_fap_signal(const std::string& text) {
  const auto clip = fap::read_text(text);
  if (!clip) return clip.error();
  return to_signal(*clip);
}

Result<Signal> keep_controls(Signal signal, const std::vector<std::string>& names) {
  if (names.empty() || names == signal.names) return signal;
  Signal kept;
  kept.rate = signal.rate;
  kept.names = names;
  kept.measured = signal.measured;
  std::vector<std::size_t> from;
  for (const std::string& name : names) {
    const auto at = std::find(signal.names.begin(), signal.names.end(), name);
    if (at == signal.names.end())
      return make_error(Code::not_found, "there is no control '" + name + "'");
    from.push_back(std::size_t(at - signal.names.begin()));
  }
  kept.values.reserve(signal.frames() * names.size());
  for (std::size_t i = 0; i < signal.frames(); ++i)
    for (const std::size_t c : from) kept.values.push_back(signal.at(i, c));
  return kept;
}

/// Reads the files of rows; the first sentence sets controls and rate.
class CorpusReader {
 public:
  CorpusReader(const fs::path& folder, const CorpusOptions& options)
      : folder_(folder), options_(options), names_(options.controls) {}

  bool has_controls(const std::string& id) const {
    return is_file(curves(id, ".csv")) || is_file(curves(id, ".fap"));
  }

  /// False: no row of the sentence is without a blank.
  Result<bool> read(Utterance& u) {
    const fs::path csv = curves(u.id, ".csv"), fap_text = curves(u.id, ".fap");
    const bool is_fap = !is_file(csv) && is_file(fap_text);
    const fs::path& path = is_fap ? fap_text : csv;
    auto script = read_phonemes(folder_, u.id);
    if (!script) return script.error();
    const auto text = read_file(path);
    if (!text) return text.error();
    std::vector<BlankNote> blanks;
    auto signal = is_fap ? read_fap_signal(*text) : read_curves(*text, &blanks);
    if (signal && names_.empty()) names_ = signal->names;
    if (signal) signal = keep_controls(std::move(*signal), names_);
    if (!signal) return std::move(signal).error().in_file(path.string());
    u.script = std::move(*script);
    u.signal = std::move(*signal);
    note_blanks(u.id, std::move(blanks));
    leave_out_blanks(u.signal);
    if (auto ok = check(u, path); !ok) return ok.error();
    const auto& measured = u.signal.measured;
    const bool any =
        measured.empty() || std::find(measured.begin(), measured.end(), true) != measured.end();
    if (!any) ++left_out_.sentences;
    return any;
  }

  /// At the end. An error if nothing but blanks was there of some control.
  Result<LeftOut> left_out() && {
    for (const std::string& name : names_)
      if (const auto all = wholly_blank_.find(name);
          all != wholly_blank_.end() && all->second == read_)
        return error_in(
            folder_ / options_.controls_folder, Code::not_found,
            "the control '" + name + "' is blank in every sentence; choose other controls");
    if (read_ > 0 && left_out_.sentences == read_)
      return error_in(folder_ / options_.controls_folder, Code::not_found,
                      "no sentence has a row without a blank; choose fewer controls");
    return std::move(left_out_);
  }

 private:
  void note_blanks(const std::string& id, std::vector<BlankNote> blanks) {
    ++read_;
    for (BlankNote& blank : blanks) {
      if (std::find(names_.begin(), names_.end(), blank.control) == names_.end()) continue;
      if (blank.rows == blank.of) ++wholly_blank_[blank.control];
      blank.id = id;
      left_out_.blanks.push_back(std::move(blank));
    }
  }

  fs::path curves(const std::string& id, const char* extension) const {
    return folder_ / options_.controls_folder / (id + extension);
  }

  Result<void> check(const Utterance& u, const fs::path& path) {
    const double length = u.signal.rate.seconds(double(u.signal.frames()));
    const double gap = u.script.duration() - length;
    if (!options_.any_length && std::abs(gap) > kLongestMismatch)
      return error_in(path, Code::out_of_range,
                      "the signal lasts " + std::to_string(length) + " s but its phonemes " +
                          std::to_string(u.script.duration()) +
                          " s; correct the times or allow any length");
    if (first_.empty()) {
      first_ = u.id;
      rate_ = u.signal.rate;
    }
    if (!(u.signal.rate == rate_))
      return error_in(path, Code::out_of_range,
                      "the frame rate differs from that of sentence '" + first_ + "'; resample it");
    return {};
  }

  const fs::path& folder_;
  const CorpusOptions& options_;
  std::vector<std::string> names_;
  std::string first_;
  fap::Rate rate_;
  LeftOut left_out_;
  std::size_t read_ = 0;                             // sentences
  std::map<std::string, std::size_t> wholly_blank_;  // sentences, by control
};

// Whatever else the corpus has.
int shard_of_sentence(std::string_view id, int shards) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a, whose low bits alone are poor
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return int((hash ^ (hash >> 32)) % std::uint64_t(shards)) + 1;
}

}  // namespace

Result<std::vector<Utterance>> parse_rows(std::string_view text, const CorpusOptions& options) {
  const auto lines = table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const auto header = split_fields(lines[0].text, '\t');
  const auto id = find_column(header, "id");
  const auto words = find_column(header, "text");
  const auto split = find_column(header, options.split_column);
  if (!id) return error_at_line(Code::not_found, "the header has no column 'id'; add one", 1);
  if (!options.split_value.empty() && !split)
    return error_at_line(Code::not_found,
                         "the header has no column '" + options.split_column +
                             "'; choose another split column or read all rows",
                         1);
  std::vector<Utterance> rows;
  std::set<std::string> seen;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = split_fields(lines[i].text, '\t');
    if (fields.size() != header.size())
      return error_at_line(Code::syntax,
                           std::to_string(fields.size()) +
                               " fields where the "
                               "header has " +
                               std::to_string(header.size()) + "; complete the line",
                           std::int64_t(lines[i].number));
    Utterance u;
    u.id = trimmed(fields[*id]);
    if (!safe_id(u.id) || !seen.insert(u.id).second)
      return error_at_line(Code::syntax,
                           "the id '" + u.id +
                               "' is empty, used twice or not "
                               "usable as a file name; change it",
                           std::int64_t(lines[i].number));
    if (words) u.text = fields[*words];
    for (std::size_t f = 0; f < fields.size(); ++f) u.fields.emplace_back(header[f], fields[f]);
    if (options.split_value.empty() || trimmed(fields[*split]) == options.split_value)
      rows.push_back(std::move(u));
  }
  if (rows.empty())
    return make_error(Code::not_found, options.split_value.empty()
                                           ? "the table has no rows"
                                           : "no row has '" + options.split_value +
                                                 "' in column '" + options.split_column + "'");
  return rows;
}

std::size_t Corpus::frames() const {
  std::size_t n = 0;
  for (const Utterance& u : utterances) n += u.signal.frames();
  return n;
}

double Corpus::duration() const {
  return utterances.empty() ? 0.0 : utterances[0].signal.rate.seconds(double(frames()));
}

Result<Corpus> read_corpus(const fs::path& folder, const CorpusOptions& options) {
  Corpus corpus;
  auto left_out =
      visit_corpus(folder, options, [&](Utterance u, std::size_t, std::size_t) -> Result<void> {
        corpus.utterances.push_back(std::move(u));
        return {};
      });
  if (!left_out) return left_out.error();
  corpus.left_out = std::move(*left_out);
  return corpus;
}

Result<LeftOut> visit_corpus(const fs::path& folder, const CorpusOptions& options,
                             const SentenceVisitor& visit) {
  auto rows = read_rows(folder / "utterances.tsv", options);
  if (!rows) return rows.error();
  std::erase_if(*rows, [&](const Utterance& u) {
    return shard_of_sentence(u.id, options.shards) != options.shard;
  });
  CorpusReader reader(folder, options);
  std::size_t skipped = 0;
  for (std::size_t row = 0; row < rows->size(); ++row) {
    Utterance& u = (*rows)[row];
    if (options.skip_missing && !reader.has_controls(u.id)) {
      ++skipped;
      continue;
    }
    const auto complete = reader.read(u);
    if (!complete) return complete.error();
    if (!*complete) continue;
    if (auto ok = visit(std::move(u), row, rows->size()); !ok) return ok.error();
  }
  if (skipped > 0 && skipped == rows->size())
    return error_in(folder / options.controls_folder, Code::not_found,
                    "no row has a control file in this folder");
  auto left_out = std::move(reader).left_out();
  if (left_out) left_out->skipped = skipped;
  return left_out;
}

std::vector<Utterance> select(const Corpus& corpus, std::string_view column,
                              std::string_view value) {
  std::vector<Utterance> chosen;
  for (const Utterance& u : corpus.utterances)
    for (const auto& [name, field] : u.fields)
      if (name == column && field == value) chosen.push_back(u);
  return chosen;
}

}  // namespace animeme::dam
