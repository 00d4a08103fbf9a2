// animeme batch in trouble: Ctrl-C, more rows than memory should notice, manifests and rows that
// are broken.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "tests/app/program/batch_support.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace batch_trouble_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using namespace std::string_literals;

/// The program in a process group of its own, as a shell starts it.
pid_t start(const std::vector<std::string>& arguments) {
  std::vector<std::string> line{std::string(test::kBinaryFolder) + "/bin/animeme"};
  line.insert(line.end(), arguments.begin(), arguments.end());
  std::vector<char*> words;
  for (std::string& word : line) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::setpgid(0, 0);
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
  ::execv(words[0], words.data());
  ::_exit(127);
}

TEST(BatchTrouble, CtrlCFinishesWhatRunsAndNothingElse) {
  const TempDir dir;
  spill(dir / "text", "Hello world");
  spill(dir / "fetch.sh",
        "#!/bin/sh\ntouch \"$0.begun\"\nuntil [ -e \"$0.go\" ]; do sleep 0.05; "
        "done\ncp \"${1#slow://}\" \"$2\"\n");
  fs::permissions(dir / "fetch.sh", fs::perms::owner_all);
  std::string table =
      "id\ttext\ttext_file\toutputs\nfirst\t\tslow://" + (dir / "text") + "\t.mp4 .fba .tsv\n";
  for (int i = 0; i < 10; ++i) table += "row" + std::to_string(i) + "\tHello\t\t.fba\n";
  spill(dir / "m.tsv", table);
  const std::vector<std::string> more = {"--jobs", "1", "--fetch",
                                         (dir / "fetch.sh") + " {uri} {file}"};
  const pid_t child = start(batch_line(dir / "m.tsv", dir / "out", more));
  while (!fs::exists(dir / "fetch.sh.begun") && ::kill(child, 0) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(-child, SIGINT);  // in the middle of the first row
  spill(dir / "fetch.sh.go", "");
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  auto made = contents(dir / "out");
  EXPECT_THAT(made["index.tsv"], HasSubstr("first\tok\tfirst.mp4|first.fba|first.tsv\t"));
  EXPECT_THAT(made["index.tsv"], testing::Not(HasSubstr("row")));
  EXPECT_EQ(made.size(), 4U);
  for (const auto& entry : fs::directory_iterator(dir / "out"))  // folders and parts, too
    EXPECT_TRUE(made.contains(entry.path().filename().string()) ||
                entry.path().extension() == ".lock")
        << entry.path();

  auto again = more;
  again.emplace_back("--resume");
  const auto now = json_of(batch_line(dir / "m.tsv", dir / "out", again));
  EXPECT_EQ(now["skipped"], 1);
  EXPECT_EQ(now["done_now"], 10);
  succeeds(batch_line(dir / "m.tsv", dir / "quiet", more));
  EXPECT_EQ(contents(dir / "out"), contents(dir / "quiet"));
}

/// Megabytes at most of a command and of its workers.
double peak_of(const std::vector<std::string>& arguments, int exit_code) {
  const pid_t child = start(arguments);
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == exit_code) << status;
  return double(used.ru_maxrss) / 1024;
}

// 32 bytes a row, and as much again while tables grow, to find what is twice.
TEST(BatchTrouble, MemoryDoesNotGrowWithTheRows) {
  const TempDir dir;
  succeeds({"speak", "--text", "Hi", "-o", dir / "hi.fba"});
  double peaks[2][2] = {};
  for (int large = 0; large < 2; ++large) {
    std::string table = "id\tinput\toutputs\n";
    for (int i = 0; i < (large != 0 ? 20'000 : 2'000); ++i)  // one of twenty has something to do
      table += "part" + std::to_string(i % 7) + "/a_clip_with_a_name_" + std::to_string(i) + "\t" +
               (i % 20 != 0 ? "/nowhere.fba" : dir / "hi.fba") + "\t.fap\n";
    const std::string manifest = dir / ("m" + std::to_string(large) + ".tsv");
    spill(manifest, table);
    const std::string out = dir / ("out" + std::to_string(large));
    peaks[0][large] = peak_of(batch_line(manifest, out, {"--check"}), 0);
    peaks[1][large] = peak_of(batch_line(manifest, out, {"--jobs", "2"}), 1);
  }
  for (const auto& peak : peaks) EXPECT_LT(peak[1] - peak[0], 4) << peak[0] << " MB at first";
}

TEST(BatchTrouble, BrokenManifestsOfManyKinds) {
  const TempDir dir;
  const std::string head = "id\ttext\toutputs\n", good = "a\tA\t.fba\n";
  const auto said = [&](const std::string& text, const std::string& name,
                        const std::vector<std::string>& more = {}) {
    spill(dir / name, text);
    const auto result = animeme(batch_line(dir / name, dir / "out", more));
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_FALSE(fs::exists(dir / "out")) << text;
    return result.err;
  };
  const struct {
    std::string name, text, message;
  } kinds[] = {
      {"m.tsv", "\xEF\xBB\xBF", "m.tsv:1:1: there is no column"},
      {"m.tsv", "id\ttext\tid\n" + good, "m.tsv:1:9: column \"id\" is there twice"},
      {"m.tsv", head + "a\tA\0B\t.fba\n"s, "m.tsv:2:4: a zero byte"},
      {"m.tsv", head + "a\t" + std::string(1 << 21, 'x') + "\t.fba\n",
       "m.tsv:2: the line is longer"},
      {"m.tsv", "\xFF\xFEi\0d\0\n\0"s, "m.tsv:1"},
      {"m.tsv", "\x1F\x8B\x08\x00\x01\x02\n"s, "m.tsv:1"},
      {"m.tsv", "id,text,outputs\na,A,.fba\n", "m.tsv:1:1: there is no column \"id,text,outputs\""},
      {"m.tsv", head + good + ".hidden\tA\t.fba\n", "m.tsv:3:1: id "},
      {"m.tsv", head + "a\\b\tA\t.fba\n" + std::string(300, 'x') + "\tA\t.fba\n",
       "m.tsv:3:1: the id is longer than"},
      {"m.tsv", head + good + "a\tB\t.mp4\n", "m.tsv:3: the id is that of line 2"},
      {"m.jsonl", "[\n{\"id\": \"a\"},\n5]\n", "m.jsonl:3: the list has something"},
      {"m.jsonl", "[\n{\"id\": \"a\"}\n", "m.jsonl:3: the list does not end"},
      {"m.jsonl", "{\"id\": \"a\"}\n[{\"id\": \"b\"}]\n", "m.jsonl:2:1: this is no JSON object"},
      {"m.csv", "id,text\na,\"A\"b\n", "m.csv:2:3: something stands behind a quote"},
      {"m.csv", "id,text\na,\"A\nB\n", "m.csv:2: a quote that does not end"},
      {"m.jsonl", "\"id\"\n", "m.jsonl:1:1: this is no JSON object"},
      {"m.jsonl", "{\"id\": \"a\", \"text\": \"open\n", "m.jsonl:1:"},
      {"m.jsonl", "{\"id\": \"a\", \"text\": {\"en\": \"A\"}}\n", "m.jsonl:1: \"text\" must be"},
      {"m.jsonl", "{\"id\": \"a\", \"txt\": \"A\"}\n", "m.jsonl:1:13: there is no column \"txt\""},
      {"m.jsonl", "{\"id\": \"a\\u0000b\"}\n", "m.jsonl:1: a zero byte in \"id\""},
      {"m.jsonl", "{\"text\": \"A\"}\n", "m.jsonl:1"},
      {"m.jsonl", std::string(100000, '[') + "\n", "m.jsonl:1"},
      {"m.txt", "a.fba\nb/a.fba\na.fap\n", "m.txt:2: the id is that of line 1"},
  };
  for (const auto& kind : kinds) EXPECT_THAT(said(kind.text, kind.name), HasSubstr(kind.message));
  EXPECT_THAT(said("a\tb\n", "m.txt", {"--set", "texts=A"}), HasSubstr("texts"));
  const auto folder = animeme(batch_line(dir.path().string(), dir / "out"));
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_THAT(folder.err, HasSubstr("this is a folder"));
  EXPECT_EQ(animeme(batch_line(dir / "none.tsv", dir / "out")).exit_code, 3);
}

TEST(BatchTrouble, AnyDamageToAManifestIsTakenOrTold) {
  const TempDir dir;
  const std::string
      table = "id\ttext\tlang\toutputs\na/one\tA b c\ten\t.fba .vtt\nb\t\"D\"\tde\t.mp4\n",
      lines = R"({"id": "a/one", "text": "A b\tc", "outputs": [".fba", ".vtt"]})"
              "\n"
              R"({"id": "b", "text": "D", "lang": "de"})"
              "\n";
  std::mt19937 engine(3);
  const auto below = [&](std::size_t n) { return std::size_t(engine()) % n; };
  for (int i = 0; i < 60; ++i) {
    const std::string name = i % 2 != 0 ? "m.jsonl" : "m.tsv";
    std::string text = i % 2 != 0 ? lines : table;
    for (std::size_t n = below(4) + 1; n > 0 && !text.empty(); --n) {
      const std::size_t at = below(text.size());
      const char byte =
          "\t\n\r\"\\{}[]:,./\0\xFF\xC3"
          "a"[below(17)];
      switch (below(3)) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.insert(at, 1, byte);
          break;
        default:
          text.erase(at, below(9));
      }
    }
    spill(dir / name, text);
    const auto result = animeme(batch_line(dir / name, dir / "out", {"--check"}));
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3) << result.exit_code << "\n" << text;
    if (result.exit_code == 3) {
      EXPECT_THAT(result.err, HasSubstr(name + ":")) << text;
    }
    EXPECT_FALSE(fs::exists(dir / "out"));
  }
}

TEST(BatchTrouble, WhatIsWrongWithARowIsAnErrorOfThisRow) {
  const TempDir dir;
  const struct {
    const char *fields, *message;  // text, input, lang, options, outputs
  } rows[] = {
      {"\t\t\t\t.fba", "nothing to say"},
      {"A\tb.fba\t\t\t.fba", "both an input and speech"},
      {"A\t\t\t\t", "has no outputs"},
      {"A\t\t\t\t/", "is no ending"},
      {"A\t\t\t\t.fba/x", "is no ending"},
      {"A\t\t\t\t.zip", "no command makes"},
      {"A\t\t\t\tdance:.fba", "no command makes"},
      {"A\t\t\t\t\".fba", "not closed"},
      {"A\t\t\t-o x.fba\t.fba", "column options has -o"},
      {"A\t\t\t--json\t.fba", "column options has --json"},
      {"A\t\t\t--nonsense\t.fba", "speak: "},
      {"A\t\tqqq\t\t.fba", "qqq"},
      {"\tnone.fba\t\t\t.fap", "none.fba"},
      {"\tm.tsv\t\t\tspeak:.fba", "needs speech"},
  };
  std::string table = "id\ttext\tinput\tlang\toptions\toutputs\n";
  for (std::size_t i = 0; i < std::size(rows); ++i)
    table += "bad" + std::to_string(i) + "\t" + rows[i].fields + "\n";
  spill(dir / "m.tsv", table + "good\tA\t\t\t\t.fba\n");
  const auto now = json_of(batch_line(dir / "m.tsv", dir / "out"), 1);
  EXPECT_EQ(now["ok"], 1);
  EXPECT_EQ(now["failed"], std::size(rows));
  const std::string index = slurp(dir / "out/index.tsv");
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    const std::size_t begin = index.find("bad" + std::to_string(i) + "\terror\t");
    ASSERT_NE(begin, index.npos) << i;
    EXPECT_THAT(index.substr(begin, index.find('\n', begin) - begin), HasSubstr(rows[i].message));
  }
  EXPECT_TRUE(fs::exists(dir / "out/good.fba"));
}

}  // namespace batch_trouble_test
}  // namespace animeme::test
