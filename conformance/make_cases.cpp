// The maintainers' tool of the conformance suite:
//
//     make_cases generate OUT [--seed N]     writes all generated cases into folders of OUT
//     make_cases describe DIR...             computes the facts in the case.json of each folder
//
// generate: the streams are written by StreamWriter and the expected values are computed from the
// levels; the codec is then asked to decode, and to encode where there are parameters, and every
// difference is an error. describe: DIR/X.fba and the files beside it (see case_file.h) are
// described; title, note and origin of a case.json that is there are kept.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "conformance/describe.h"

namespace animeme::conformance {
namespace {

namespace fs = std::filesystem;

int complain(const std::string& text) {
  std::cerr << "make_cases: " << text << "\n";
  return 3;
}

bool write(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  return bool(out.flush());
}

int generate(const fs::path& folder, std::uint64_t seed) {
  std::vector<MadeCase> cases = make_all_cases(seed);
  for (MadeCase& made : cases) {
    if (auto ok = describe(made); !ok)
      return complain(made.info.name + ": " + ok.error().describe());
    const fs::path place = folder / made.info.name;
    fs::create_directories(place);
    for (const CaseFile& file : made.info.files) {
      if (!write(place / file.name, made.content[file.role])) {
        return complain("cannot write " + (place / file.name).string());
      }
    }
    if (!write(place / "case.json", write_case(made.info)))
      return complain("cannot write case.json");
  }
  std::printf("%zu cases\n", cases.size());
  return 0;
}

int describe_folder(const fs::path& folder) {
  MadeCase made;
  made.info.name = folder.filename().string();
  const auto slurp = [](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  if (fs::exists(folder / "case.json")) {
    Result<Case> old = read_case(slurp(folder / "case.json"));
    if (!old) return complain(folder.string() + ": " + old.error().describe());
    made.info = *old;
    made.info.files.clear();
  }
  for (const std::string& role : file_roles()) {
    const fs::path path = folder / (made.info.name + extension_of_role(role, made.info.damaged));
    if (fs::exists(path)) made.content[role] = slurp(path);
  }
  if (auto ok = describe(made); !ok)
    return complain(folder.string() + ": " + ok.error().describe());
  return write(folder / "case.json", write_case(made.info)) ? 0
                                                            : complain("cannot write case.json");
}

int run(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const char* usage = "generate OUT [--seed N] | describe DIR...";
  if (arguments.size() < 2) return complain(usage), 2;
  if (arguments[0] == "generate") {
    std::uint64_t seed = 1;
    if (arguments.size() == 4 && arguments[2] == "--seed") {
      seed = std::strtoull(arguments[3].c_str(), nullptr, 10) & 0xFFFFFFFF;
    } else if (arguments.size() != 2) {
      return complain(usage), 2;
    }
    return generate(arguments[1], seed);
  }
  if (arguments[0] != "describe") return complain(usage), 2;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const int code = describe_folder(fs::path(arguments[i]).lexically_normal());
    if (code != 0) return code;
  }
  return 0;
}

}  // namespace
}  // namespace animeme::conformance

int main(int argc, char** argv) { return animeme::conformance::run(argc, argv); }
