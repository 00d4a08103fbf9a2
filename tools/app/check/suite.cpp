#include "tools/app/check/suite.h"

#include <algorithm>

#include "conformance/sha256.h"
#include "tools/formats/files/files.h"
#include "tools/formats/programs/children.h"

namespace animeme::tools {
namespace {

namespace fs = std::filesystem;
using conformance::Case;
using conformance::CaseFile;

constexpr double kUnpackSeconds = 120;

bool is_archive(const fs::path& path) { return path.string().ends_with(".tar.xz"); }

Result<std::unique_ptr<ScratchFolder>> unpack(const fs::path& archive) {
  auto folder = ScratchFolder::make();
  if (!folder) return folder;
  auto log = ScratchFolder::make();
  if (!log) return log;
  Children children(kUnpackSeconds);
  ChildJob job;
  job.arguments = {"tar", "-C", (*folder)->path().string(), "-xf", fs::absolute(archive).string()};
  job.out = ((*log)->path() / "out").string();
  job.err = ((*log)->path() / "err").string();
  if (auto ok = children.start(0, job); !ok) return ok.error();
  const ChildEnd end = children.wait().end;
  if (end.how == ChildEnd::How::exited && end.code == 0) return folder;
  return make_error(Code::io, "this archive cannot be unpacked with tar and xz")
      .in_file(archive.string());
}

// All files below a folder, sorted, so that the order does not depend on the file system.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->is_regular_file(error)) out.push_back(it->path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

// The data of a case lie beside its case.json, or unpacked in a folder of its name.
fs::path find_file(const fs::path& beside, const std::vector<fs::path>& unpacked,
                   const std::string& case_name, const std::string& file) {
  if (fs::exists(beside / file)) return beside / file;
  for (const fs::path& folder : unpacked) {
    if (fs::exists(folder / case_name / file)) return folder / case_name / file;
  }
  return {};
}

Result<SuiteCase> load_case(const fs::path& json, const std::vector<fs::path>& unpacked) {
  Result<std::string> text = read_text_file(json.string());
  if (!text) return text.error();
  Result<Case> info = conformance::read_case(*text);
  if (!info) return info.error().in_file(json.string());
  SuiteCase one;
  one.info = std::move(*info);
  for (const CaseFile& file : one.info.files) {
    one.path[file.role] = find_file(json.parent_path(), unpacked, one.info.name, file.name);
  }
  return one;
}

// Finds a case by the names of its files; none if there is no expected result.
bool bare_case(const fs::path& stream, SuiteCase& one) {
  const fs::path base = stream.parent_path() / stream.stem();
  one.described = false;
  one.info.name = base.filename().string();
  one.info.title = one.info.name;
  for (const bool damaged : {false, true}) {
    for (const char* role : {"face", "body"}) {
      const fs::path path = base.string() + conformance::extension_of_role(role, damaged);
      if (one.path.count(role) != 0 || !fs::exists(path)) continue;
      one.path[role] = path;
      one.info.damaged = damaged;
    }
  }
  if (one.path.empty()) return false;
  const bool face = one.path.count("face") != 0;
  one.info.object = one.path.count("body") == 0 ? "face" : face ? "both" : "body";
  for (const std::string& role : conformance::file_roles()) {
    const fs::path path = base.string() + conformance::extension_of_role(role, one.info.damaged);
    if (fs::exists(path)) one.path[role] = path;
  }
  for (const auto& [role, path] : one.path) {
    one.info.files.push_back({role, path.filename().string(), {}, 0});
  }
  return true;
}

}  // namespace

Result<Suite> load_suite(const std::string& place) {
  std::error_code ignored;
  Suite suite;
  suite.name = fs::path(place).lexically_normal().filename().string();
  if (suite.name.empty() || suite.name == ".") suite.name = "conformance";
  std::vector<fs::path> archives;
  fs::path folder;
  if (fs::is_directory(place, ignored)) {
    folder = place;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      if (is_archive(entry.path())) archives.push_back(entry.path());
    }
    std::sort(archives.begin(), archives.end());
  } else if (fs::is_regular_file(place, ignored) && is_archive(place)) {
    archives.push_back(place);
  } else {
    return make_error(Code::not_found, "a folder of cases or a .tar.xz of them is needed")
        .in_file(place);
  }
  std::vector<fs::path> unpacked;
  for (const fs::path& archive : archives) {
    auto scratch = unpack(archive);
    if (!scratch) return scratch.error();
    unpacked.push_back((*scratch)->path());
    suite.unpacked.push_back(std::move(*scratch));
  }

  std::vector<fs::path> files;
  if (!folder.empty()) files = files_below(folder);
  for (const fs::path& extra : unpacked) {
    for (fs::path& path : files_below(extra)) files.push_back(std::move(path));
  }
  for (const fs::path& path : files) {
    if (path.filename() != "case.json") continue;
    Result<SuiteCase> one = load_case(path, unpacked);
    if (!one) return one.error();
    suite.cases.push_back(std::move(*one));
  }
  if (suite.cases.empty()) {
    for (const fs::path& path : files) {
      SuiteCase one;
      if (path.extension() == ".fba" && bare_case(path, one)) suite.cases.push_back(std::move(one));
    }
  }
  if (suite.cases.empty()) {
    return make_error(Code::not_found,
                      "no cases in here: neither case.json files nor X.fba with X.dec.fap or "
                      "X.dec.bap")
        .in_file(place);
  }
  std::sort(suite.cases.begin(), suite.cases.end(),
            [](const SuiteCase& a, const SuiteCase& b) { return a.info.name < b.info.name; });
  for (std::size_t i = 1; i < suite.cases.size(); ++i) {
    if (suite.cases[i].info.name == suite.cases[i - 1].info.name) {
      return make_error(Code::syntax, "two cases are named " + suite.cases[i].info.name)
          .in_file(place);
    }
  }
  return suite;
}

void verify(SuiteCase& one) {
  for (const CaseFile& file : one.info.files) {
    const fs::path& path = one.path.at(file.role);
    if (path.empty()) {
      one.problem = file.name + " is missing";
    } else if (const auto bytes = read_file(path.string()); !bytes) {
      one.problem = bytes.error().describe();
    } else if (!file.sha256.empty() && conformance::sha256(*bytes) != file.sha256) {
      one.problem = file.name + " is not the file of case.json (its SHA-256 differs)";
    }
    if (!one.problem.empty()) return;
  }
}

}  // namespace animeme::tools
