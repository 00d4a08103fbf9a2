// animeme edit, as its command line runs it: cuts, joins, changes and parts of other files. The
// first line says how: words of an option's letter and its value. Behind it, a byte is the share of
// what follows that is the first file; the rest is the second one. What is written can be read.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/text.h"
#include "tests/fuzz/require.h"
#include "tools/app/commands/command.h"
#include "tools/app/commands/parse_line.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/container.h"

using animeme::test::require;

namespace {

using namespace animeme;

constexpr std::size_t kMostBytes = 20000, kMostLine = 200, kMostWords = 8;
constexpr const char* kOptions[] = {"at",    "from",   "to",   "offset",     "rate",  "speed",
                                    "scale", "smooth", "fade", "cross-fade", "quant", "take"};
constexpr const char* kFlags[] = {"--copy", "--mirror", "--no-sound"};
constexpr const char* kOutputs[] = {"out.fba", "out.fap", "out.bap", "out.mkv"};

// In memory where the system has such a folder.
struct Folder {
  std::string path;
  Folder() {
    std::string made = "/dev/shm/fuzz_edit_XXXXXX";
    if (::mkdtemp(made.data()) == nullptr) {
      made = (std::filesystem::temp_directory_path() / "fuzz_edit_XXXXXX").string();
      require(::mkdtemp(made.data()) != nullptr);
    }
    path = made;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code failed;
    std::filesystem::remove_all(path, failed);
  }
  std::string file(const std::string& name) const { return path + "/" + name; }
};

void write(const std::string& path, std::span<const std::uint8_t> bytes) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  require(file != nullptr);
  if (!bytes.empty()) require(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size());
  require(std::fclose(file) == 0);
}

// The words of the command line that the first line stands for.
std::vector<std::string> words_of(std::string_view line, const Folder& folder) {
  std::vector<std::string> words = {folder.file("a.fba")};
  std::string output = kOutputs[0];
  std::size_t begin = 0;
  while (begin < line.size() && words.size() < kMostWords) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    const auto letter = std::size_t(static_cast<unsigned char>(word[0]));
    std::string value(word.substr(1));
    if (letter >= 'a') {
      const std::string name = kOptions[(letter - 'a') % std::size(kOptions)];
      if (name == "take") {
        // No other file is read.
        if (value.find_first_of("=/") != value.npos) continue;
        value += "=" + folder.file("b.fba");
      }
      words.push_back("--" + name + "=" + value);
    } else if (letter == '+') {
      words.push_back(folder.file("b.fba"));
    } else if (letter >= '0' && letter <= '9') {
      output = kOutputs[(letter - '0') % std::size(kOutputs)];
    } else {
      words.emplace_back(kFlags[letter % std::size(kFlags)]);
    }
  }
  words.push_back("-o" + folder.file(output));
  return words;
}

void check_output(const std::string& path) {
  if (!std::filesystem::exists(path)) return;
  const auto bytes = tools::read_file(path);
  require(bytes.has_value());
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const std::string ending = std::filesystem::path(path).extension();
  if (ending == ".fba") require(fba::decode(*bytes).has_value());
  if (ending == ".fap") require(fap::read_text(text).has_value());
  if (ending == ".bap") require(fba::read_bap_text(text).has_value());
  if (ending == ".mkv") require(media::read_container(std::span(*bytes)).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size > kMostBytes) return 0;
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::size_t end = all.find('\n');
  if (end == all.npos || end > kMostLine || end + 1 >= size) return 0;
  const std::span<const std::uint8_t> rest(data + end + 2, size - end - 2);
  const std::size_t first = rest.size() * (std::size_t(data[end + 1]) + 1) / 256;
  write(folder.file("a.fba"), rest.first(first));
  write(folder.file("b.fba"), rest.subspan(first));
  for (const char* output : kOutputs) ::unlink(folder.file(output).c_str());

  const std::vector<std::string> words = words_of(all.substr(0, end), folder);
  std::vector<const char*> line = {tools::kEdit.name};
  for (const std::string& word : words) line.push_back(word.c_str());
  tools::set_quiet(true);
  tools::OptionTable program("fuzz_edit", "", "");
  tools::OptionTable table(tools::kEdit.name, tools::kEdit.summary, "");
  const tools::Action action = tools::kEdit.add(table);
  const tools::ParsedLine parsed = tools::parse_line(program, &table, line);
  if (parsed.action != tools::ParsedLine::Action::run) {
    require(parsed.action != tools::ParsedLine::Action::fail || !parsed.problem.empty());
    return 0;
  }
  const auto code = action.run(action.options.get());
  if (!code) require(!code.error().message.empty());
  if (code && *code == tools::kOk) check_output(words.back().substr(2));
  return 0;
}
