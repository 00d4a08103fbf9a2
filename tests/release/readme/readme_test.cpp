// Each example of each README runs as it stands, from the top of the tree, and writes what it says.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <map>
#include <regex>

#include "tests/release/readme/examples.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme {
namespace readme_test {

namespace fs = std::filesystem;
using test::Example;
using test::TempDir;

constexpr const char* kFolders[] = {"codec", "conformance", "dam", "fap", "tests", "tools"};

std::vector<Example> all_examples() {
  const fs::path top = test::kSourceFolder;
  std::vector<std::string> files{"README.md", "tools/cookbook.md"};
  for (const char* folder : kFolders) {
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const std::string path = entry.path().lexically_relative(top).string();
      const bool theirs = path.find("node_modules") != std::string::npos;
      if (!theirs && entry.path().filename() == "README.md") files.push_back(path);
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Example> all;
  for (const std::string& file : files) {
    for (Example& one : test::examples_of(file, test::slurp(top / file))) {
      all.push_back(std::move(one));
    }
  }
  return all;
}

// A tree of which the examples may change the top and their samples. It has the folders of the
// sources alone: an example that writes hello.mp4 must not write the user's file through a link.
void make_tree(const fs::path& folder) {
  for (const char* name : kFolders) {
    fs::create_symlink(fs::path(test::kSourceFolder) / name, folder / name);
  }
}

// A port of this machine; of 0 any that is free. 0: it is taken.
int bound(int type, int port) {
  const int socket = ::socket(AF_INET, type, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool done = ::bind(socket, reinterpret_cast<sockaddr*>(&address), size) == 0;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(socket);
  return done ? ntohs(address.sin_port) : 0;
}

// An even one, as RTP wants it, with the one behind it. Linux gives odd ones first.
int free_port() {
  for (int i = 0; i < 1000; ++i) {
    const int port = bound(SOCK_DGRAM, 0) & ~1;
    if (port > 1024 && bound(SOCK_DGRAM, port) != 0 && bound(SOCK_DGRAM, port + 1) != 0 &&
        bound(SOCK_STREAM, port) != 0) {
      return port;
    }
  }
  return 0;
}

// Ports that nobody has instead of those that are written: tests run beside each other.
std::string with_free_ports(std::string line) {
  static std::map<std::string, std::string> ports;
  const std::regex address("127\\.0\\.0\\.1:([0-9]+)");
  for (std::smatch found; std::regex_search(line, found, address);) {
    std::string& port = ports[found[1]];
    if (port.empty()) port = std::to_string(free_port());
    line = found.prefix().str() + "localhost_:" + port + found.suffix().str();
  }
  return std::regex_replace(line, std::regex("localhost_"), "127.0.0.1");
}

// What a line names to be written.
std::vector<std::string> outputs_of(const std::string& line) {
  const std::regex option(
      " (?:-o|--sdp|--picture|--report|--write-keys|--save-poses|--accumulate) ([^ ;&|]+)");
  std::vector<std::string> files;
  for (std::sregex_iterator at(line.begin(), line.end(), option), end; at != end; ++at) {
    if ((*at)[1] != "-" && (*at)[1].str().find('{') == std::string::npos) files.push_back((*at)[1]);
  }
  return files;
}

bool is_there(const fs::path& path) {
  if (fs::is_directory(path)) return !fs::is_empty(path);
  return fs::exists(path) && fs::file_size(path) > 0;
}

class Examples : public testing::TestWithParam<Example> {};

TEST_P(Examples, Run) {
  const Example& example = GetParam();
  const TempDir dir;
  make_tree(dir.path());
  const std::string bin = std::string(test::kBinaryFolder) + "/bin";
  std::string script = "set -euo pipefail\ncd " + test::quoted(dir.path().string()) +
                       "\nPATH=" + test::quoted(bin) + ":$PATH\n";
  for (const std::string& line : example.lines) script += with_free_ports(line) + "\n";
  test::spill(dir / "example.sh", script + "wait\n");
  const auto result = test::run_command({"timeout", "300", "bash", dir / "example.sh"});
  if (result.err.find("built without") != std::string::npos) GTEST_SKIP() << result.err;
  const std::string where = example.readme + ":" + std::to_string(example.line);
  ASSERT_EQ(result.exit_code, 0) << where << "\n" << script << result.err;
  for (const std::string& line : example.lines) {
    for (const std::string& file : outputs_of(line)) {
      EXPECT_TRUE(is_there(dir.path() / file) || is_there(dir.path() / "try" / file))
          << where << ": " << file << " of " << line;
    }
  }
  for (const std::string& line : example.left_out)
    std::cout << where << " left out: " << line << "\n";
}

std::string name_of(const testing::TestParamInfo<Example>& info) {
  std::string name = info.param.readme.substr(0, info.param.readme.rfind('.'));
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name + "_" + std::to_string(info.param.line);
}

INSTANTIATE_TEST_SUITE_P(Readme, Examples, testing::ValuesIn(all_examples()), name_of);

TEST(Extraction, FindsWhatThereIs) {
  const auto examples = test::examples_of("a", R"(# a
    animeme one \
      -o 1   # with a comment
    other | animeme two "# no comment" # needs a thing

    my_tts && animeme three   # all that it needs
        #!/bin/sh
        a file

## b

    cp -r tools/release/samples try && cd try   # samples

    animeme four

    animeme five
```sh
animeme six
```
```cpp
animeme seven
```
## c
    only this
## d
    $ animeme eight
    says animeme nine
)");
  ASSERT_EQ(examples.size(), 5u);
  EXPECT_THAT(examples[0].lines,
              testing::ElementsAre("animeme one    -o 1", "my_tts && animeme three"));
  EXPECT_THAT(examples[0].left_out, testing::ElementsAre("other | animeme two \"# no comment\""));
  EXPECT_THAT(examples[1].lines,
              testing::ElementsAre("cp -r tools/release/samples try && cd try", "animeme four"));
  EXPECT_THAT(examples[2].lines,
              testing::ElementsAre("cp -r tools/release/samples try && cd try", "animeme five"));
  EXPECT_THAT(examples[3].lines,
              testing::ElementsAre("cp -r tools/release/samples try && cd try", "animeme six"));
  EXPECT_THAT(examples[4].lines, testing::ElementsAre("animeme eight"));
}

TEST(Extraction, AllOfTheReadmeAndTheCookbook) {
  std::size_t lines = 0, left_out = 0;
  for (const Example& one : all_examples()) {
    if (one.readme != "README.md" && one.readme != "tools/cookbook.md") continue;
    for (const std::string& line : one.lines) lines += test::runs_animeme(line) ? 1 : 0;
    left_out += one.left_out.size();
  }
  EXPECT_GT(lines, 45u);
  EXPECT_LE(left_out, 1u);  // the microphone
}

}  // namespace readme_test
}  // namespace animeme
