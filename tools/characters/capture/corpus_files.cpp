#include "tools/characters/capture/corpus_files.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "dam/script/table_text_internal.h"
#include "dam/script/timings.h"
#include "fap/detail/text_scanner.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTables[] = {".csv", ".tsv", ".json", ".jsonl", ".ndjson"};
constexpr std::string_view kSounds[] = {".wav", ".flac", ".ogg", ".opus", ".mp3", ".m4a", ".aac"};
constexpr std::string_view kTexts[] = {".txt", ".lab", ".srt", ".vtt"};
constexpr std::string_view kScripts[] = {".textgrid", ".tsv", ".csv", ".json", ".pho",
                                         ".eaf",      ".ctm", ".phn", ".dat"};
constexpr std::string_view kPictures[] = {".png", ".jpg", ".jpeg", ".gif", ".md", ".pdf", ".log"};

template <std::size_t N>
bool is_one(const std::string_view (&list)[N], std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

// The files of a folder, by name; or the file itself.
Result<std::vector<fs::path>> files_at(const std::string& place) {
  std::error_code error;
  std::vector<fs::path> files;
  if (fs::is_regular_file(place, error)) return std::vector<fs::path>{place};
  if (!fs::is_directory(place, error)) {
    return make_error(Code::not_found, "there is no such folder or file").in_file(place);
  }
  for (fs::directory_iterator entry(place, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const std::string name = entry->path().filename().string();
    if (entry->is_regular_file(ignored) && !name.starts_with('.')) files.push_back(entry->path());
  }
  if (error) return make_error(Code::io, error.message()).in_file(place);
  std::sort(files.begin(), files.end());
  return files;
}

Result<void> add_captures(const std::string& place, std::map<std::string, Take>& takes) {
  const auto files = files_at(place);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    const std::string ending = extension_of(file.string());
    if (is_one(kTexts, ending) || ending == ".textgrid" || is_one(kPictures, ending) ||
        ending.empty() || file.filename() == "utterances.tsv") {
      continue;
    }
    Take& take = takes[file.stem().string()];
    std::string& place_of = is_one(kTables, ending)   ? take.table
                            : is_one(kSounds, ending) ? take.sound
                                                      : take.video;
    if (place_of.empty()) place_of = file.string();
  }
  return {};
}

Result<void> add_sounds(const std::string& place, std::map<std::string, Take>& takes) {
  if (place.empty()) return {};
  const auto files = files_at(place);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    const auto take = takes.find(file.stem().string());
    if (take != takes.end()) take->second.sound = file.string();
  }
  return {};
}

Result<void> read_text(const std::string& path, Take& take) {
  const auto text = read_text_file(path, kMostWritten);
  if (!text) return text.error();
  const std::string ending = extension_of(path);
  if (ending != ".srt" && ending != ".vtt") {
    take.text = std::string(dam::trimmed(*text));
    return {};
  }
  dam::ScriptOptions options;
  options.format = "subtitles";
  const auto timings = dam::read_timings(*text, options);
  if (!timings) return timings.error().in_file(path);
  take.text.emplace();
  for (const dam::TimedLabel& label : timings->labels) *take.text += label.label + " ";
  return {};
}

Result<void> add_scripts(const std::string& place, std::map<std::string, Take>& takes,
                         std::vector<LeftOut>& left_out) {
  const auto files = files_at(place);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    const std::string ending = extension_of(file.string());
    const bool text = is_one(kTexts, ending);
    if (!text && !is_one(kScripts, ending)) continue;
    const auto take = takes.find(file.stem().string());
    // A table of a tracker in the same folder is no script.
    if (take != takes.end() && take->second.table == file.string()) continue;
    if (take == takes.end()) {
      left_out.push_back({file.stem().string(), "files", "there is a transcript but no capture"});
    } else if (text) {
      if (auto ok = read_text(file.string(), take->second); !ok) return ok;
    } else if (take->second.script.empty() || ending == ".textgrid") {
      take->second.script = file.string();
    }
  }
  return {};
}

struct ListColumns {
  std::size_t id = 0, text = 1;
  bool header = false;
};

ListColumns list_columns(const std::vector<std::string_view>& first) {
  ListColumns columns;
  std::optional<std::size_t> id, text;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::string name = fap::detail::lower_case(dam::trimmed(first[i]));
    if (name == "id" || name == "name" || name == "file" || name == "clip") id = i;
    if (name == "text" || name == "transcript" || name == "sentence") text = i;
  }
  if (id && text) return {*id, *text, true};
  return columns;
}

Result<void> add_list(const std::string& path, std::map<std::string, Take>& takes,
                      std::vector<LeftOut>& left_out) {
  const auto content = read_text_file(path, kMostWritten);
  if (!content) return content.error();
  const auto lines = dam::table_lines(*content);
  if (lines.empty()) return make_error(Code::truncated, "there is no line").in_file(path);
  char separator = ',';
  for (const char c : {'|', '\t'}) {
    if (lines[0].text.find(c) != std::string_view::npos) separator = c;
  }
  const ListColumns columns = list_columns(dam::split_fields(lines[0].text, separator));
  for (std::size_t i = columns.header ? 1 : 0; i < lines.size(); ++i) {
    const auto at = std::int64_t(lines[i].number);
    auto fields = dam::split_fields(lines[i].text, separator);
    // Commas are part of a text that is the last column.
    if (separator == ',' && fields.size() > 2 && columns.id == 0 && columns.text == 1) {
      fields[1] = lines[i].text.substr(std::size_t(fields[1].data() - lines[i].text.data()));
    }
    if (fields.size() <= std::max(columns.id, columns.text)) {
      return error_at_line(Code::syntax,
                           "a name and what is said are needed, between tabs, | or commas", at)
          .in_file(path);
    }
    fs::path name = std::string(dam::trimmed(fields[columns.id]));
    const bool ending = !takes.contains(name.filename().string());
    const std::string id = ending ? name.stem().string() : name.filename().string();
    const auto take = takes.find(id);
    if (take == takes.end()) {
      left_out.push_back({id, "files", "there is a transcript but no capture"});
      continue;
    }
    if (take->second.text) {
      return error_at_line(Code::syntax, "the name " + id + " is there twice", at).in_file(path);
    }
    take->second.text = std::string(dam::trimmed(fields[columns.text]));
  }
  return {};
}

// A file of one recording alone: a script, subtitles, or a text that does not begin with its name.
Result<bool> add_single(const std::string& path, std::map<std::string, Take>& takes) {
  if (takes.size() != 1) return false;
  auto& [id, take] = *takes.begin();
  const std::string ending = extension_of(path);
  if (ending == ".textgrid" || (is_one(kScripts, ending) && ending != ".tsv" && ending != ".csv")) {
    take.script = path;
    return true;
  }
  if (!is_one(kTexts, ending)) return false;
  if (auto ok = read_text(path, take); !ok) return ok.error();
  if (!take.text->starts_with(id)) return true;
  take.text.reset();
  return false;
}

// What `utterances.tsv` of a corpus can have as id.
bool is_safe(const std::string& id) {
  return id != "." && id != ".." && id.find_first_of("\\:\t") == std::string::npos;
}

}  // namespace

Result<Takes> find_takes(const CorpusPlaces& places) {
  std::map<std::string, Take> takes;
  Takes out;
  if (auto ok = add_captures(places.captures, takes); !ok) return ok.error();
  if (auto ok = add_sounds(places.audio, takes); !ok) return ok.error();
  std::erase_if(
      takes, [](const auto& one) { return one.second.table.empty() && one.second.video.empty(); });
  if (takes.empty()) {
    return make_error(Code::not_found, "there is no video and no tracker table here")
        .in_file(places.captures);
  }
  std::error_code ignored;
  if (fs::is_directory(places.transcripts, ignored)) {
    if (auto ok = add_scripts(places.transcripts, takes, out.left_out); !ok) return ok.error();
  } else {
    const auto single = add_single(places.transcripts, takes);
    if (!single) return single.error();
    if (!*single) {
      if (auto ok = add_list(places.transcripts, takes, out.left_out); !ok) return ok.error();
    }
  }
  for (auto& [id, take] : takes) {
    take.id = id;
    if (!is_safe(id)) {
      out.left_out.push_back({id, "files", "the name has a \\, a : or a tab; rename it"});
    } else if (take.script.empty() && !take.text) {
      out.left_out.push_back(
          {id, "files", "there is no transcript of this name in " + places.transcripts});
    } else {
      out.takes.push_back(std::move(take));
    }
  }
  return out;
}

}  // namespace animeme::tools
