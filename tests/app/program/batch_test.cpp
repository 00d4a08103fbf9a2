// animeme batch: many rows in one go equal the single commands, are resumed, cut up and joined.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/app/program/batch_support.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace batch_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSample = std::string(test::kSourceFolder) + "/tests/data/grid_s1_sample";

std::string short_clips(int count) {
  const char* words[] = {"Good morning", "Guten Abend", "Bonjour", "A boat", "Vier Pferde"};
  const char* languages[] = {"en", "de", "fr", "en", "de"};
  std::string table = "id\ttext\tlang\toutputs\n";
  for (int i = 0; i < count; ++i) {
    table += "part" + std::to_string(i % 3) + "/clip" + std::to_string(i) + "\t" + words[i % 5] +
             " " + std::to_string(i) + "\t" + languages[i % 5] +
             (i % 2 ? "\t.fba .tsv\n" : "\tfba, tsv\n");
  }
  return table;
}

TEST(Batch, EqualsTheSingleCommands) {
  const TempDir dir;
  const std::string script = kSample + "/phonemes/prac8p.tsv", clip = kSample + "/fap/prac8p.csv";
  spill(dir / "m.tsv",
        "\xEF\xBB\xBFid\ttext\tscript\tinput\tlang\tvoice\toptions\tencode_options\toutputs\r\n"
        "hi\tHello world\t\t\ten\tf3\t--rate 30\t\t.mp4 .vtt .svg .fba .csv\r\n"
        "\r\n"
        "de/tag\tGuten Tag\t\t\tde\t\t\t\t.fba\r\n"
        "dash\t-5 degrees\t\t\t\t\t\t\t.fap\r\n"
        "said\t\t" +
            script +
            "\t\t\t\t--default-ranges\t\t.fba export:.livelink.csv\r\n"
            "coded\t\t\t" +
            clip + "\t\t\t\t--quant 4 --preset live --default-ranges\t.fba\r\n");
  succeeds(batch_line(dir / "m.tsv", dir / "out"));
  const std::string one = dir / "one";
  fs::create_directories(one + "/de");
  succeeds({"speak", "--text", "Hello world", "--lang", "en+f3", "--rate", "30", "-o",
            one + "/hi.mp4", "--save-script", one + "/hi.vtt"});
  for (const char* ending : {".fba", ".csv"})
    succeeds({"speak", "--text", "Hello world", "--lang", "en+f3", "--rate", "30", "-o",
              one + "/hi" + ending});
  // The title of a plot is the file's name as it was given.
  succeeds({"speak", "--text", "Guten Tag", "--lang", "de", "-o", one + "/de/tag.fba"});
  succeeds({"speak", "--text=-5 degrees", "-o", one + "/dash.fap"});
  succeeds({"speak", "--script", script, "-o", one + "/said.fba", "--default-ranges"});
  succeeds({"export", one + "/said.fba", "-o", one + "/said.livelink.csv"});
  succeeds({"encode", clip, "--quant", "4", "--preset", "live", "--default-ranges", "-o",
            one + "/coded.fba"});
  succeeds({"encode", clip, "--quant", "4", "--preset", "live", "-o", dir / "own_ranges.fba"});
  EXPECT_LT(fs::file_size(one + "/coded.fba"), fs::file_size(dir / "own_ranges.fba"));
  auto made = contents(dir / "out");
  EXPECT_THAT(made["index.tsv"], HasSubstr("de/tag\tok\tde/tag.fba\t"));
  EXPECT_THAT(made["report.html"], HasSubstr("5 clips: 5 done"));
  EXPECT_GT(made["hi.svg"].size(), 1000U);
  for (const char* name : {"index.tsv", "report.html", "hi.svg"}) made.erase(name);
  EXPECT_TRUE(made == contents(one));
}

TEST(Batch, ARowThatFailsIsARowAndWhatChangedIsDoneAgain) {
  const TempDir dir;
  spill(dir / "a.txt", "One");
  spill(dir / "m.jsonl", R"({"id": "a", "text_file": ")" + (dir / "a.txt") +
                             R"(", "outputs": [".fba"]})"
                             "\n"
                             R"({"id": "b", "text_file": "/nowhere.txt", "outputs": ".fba"})"
                             "\n"
                             R"({"id": "c", "text": "Three", "outputs": ".fba"})");
  const auto now = json_of(batch_line(dir / "m.jsonl", dir / "out"), 1);
  EXPECT_EQ(now["ok"], 2);
  EXPECT_EQ(now["failed"], 1);
  EXPECT_GT(now["steps"]["voice"]["bytes"], now["steps"]["coding"]["bytes"]);
  EXPECT_GT(now["steps"]["voice"]["cpu_seconds"], 0);
  EXPECT_THAT(slurp(dir / "out/index.tsv"), HasSubstr("b\terror\t\t\t0\t\t\t/nowhere.txt: "));
  EXPECT_THAT(animeme(batch_line(dir / "m.jsonl", dir / "out")).err, HasSubstr("--resume"));
  // One input has changed, one output has gone: two are done again, with the one that failed.
  auto again = json_of(batch_line(dir / "m.jsonl", dir / "out", {"--resume"}), 1);
  EXPECT_EQ(again["skipped"], 2);
  spill(dir / "a.txt", "Another text");
  again = json_of(batch_line(dir / "m.jsonl", dir / "out", {"--resume"}), 1);
  EXPECT_EQ(again["skipped"], 1);
  fs::remove(dir / "out/c.fba");
  again = json_of(batch_line(dir / "m.jsonl", dir / "out", {"--resume"}), 1);
  EXPECT_EQ(again["skipped"], 1);
  EXPECT_TRUE(fs::exists(dir / "out/c.fba"));
  again = json_of(
      batch_line(dir / "m.jsonl", dir / "out", {"--resume", "--set", "options=--rate 30"}), 1);
  EXPECT_EQ(again["skipped"], 0);
}

TEST(Batch, ARowSpeaksOnceWhateverItWrites) {
  const TempDir dir;
  spill(dir / "say.sh", "#!/bin/sh\necho said >>\"$0.log\"\ncp \"$1\" \"$2\"\n");
  fs::permissions(dir / "say.sh", fs::perms::owner_all);
  succeeds({"speak", "--text", "Hello", "-o", dir / "voice.mp4"});
  succeeds({"demux", dir / "voice.mp4", "--audio", dir / "voice.wav"});
  spill(dir / "m.tsv", "id\ttext\ttts\toutputs\na\tHello\t" + (dir / "say.sh") + " " +
                           (dir / "voice.wav") +
                           " {wav}\t.livelink.csv .fba .mp4 .tsv export:.visemes.csv\n");
  succeeds(batch_line(dir / "m.tsv", dir / "out", {"--allow-commands"}));
  EXPECT_EQ(slurp(dir / "say.sh.log"), "said\n");
  EXPECT_EQ(contents(dir / "out").size(), 7U);  // with the index and the report
}

TEST(Batch, ShardsInAnyOrderEqualOneRun) {
  const TempDir dir;
  spill(dir / "m.tsv", short_clips(12));
  succeeds(batch_line(dir / "m.tsv", dir / "whole"));
  const auto join = batch_line(dir / "m.tsv", dir / "parts", {"--join"});
  for (const char* shard : {"3/3", "1/3"}) {
    succeeds(batch_line(dir / "m.tsv", dir / "parts", {"--shard", shard}));
  }
  EXPECT_EQ(animeme(join).exit_code, 3);
  succeeds(batch_line(dir / "m.tsv", dir / "parts", {"--shard", "2/3", "--jobs", "1"}));
  succeeds(join);
  EXPECT_EQ(contents(dir / "whole"), contents(dir / "parts"));
  succeeds(batch_line(dir / "m.tsv", dir / "whole", {"--join"}));  // one shard of one
  EXPECT_EQ(contents(dir / "whole"), contents(dir / "parts"));
  const std::string lost = dir / "parts/part0/clip0.fba";
  fs::remove(lost);
  EXPECT_THAT(animeme(join).err, HasSubstr("part0/clip0.fba: is missing; run shard"));
}

// Killed at random times and resumed; ANIMEME_KILLS and ANIMEME_CLIPS: more of it, by hand.
TEST(Batch, KilledAndResumedEqualsAQuietRun) {
  const char* more = std::getenv("ANIMEME_KILLS");
  const char* many = std::getenv("ANIMEME_CLIPS");
  const int kills = more != nullptr ? std::atoi(more) : 8;
  const TempDir dir;
  spill(dir / "m.tsv", short_clips(many != nullptr ? std::atoi(many) : 40));
  const auto before = std::chrono::steady_clock::now();
  succeeds(batch_line(dir / "m.tsv", dir / "quiet"));
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  std::mt19937 random(5);
  const std::string program = std::string(test::kBinaryFolder) + "/bin/animeme",
                    manifest = dir / "m.tsv", out = dir / "killed";
  for (int i = 0; i < kills; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_RDWR);
      ::dup2(null, STDERR_FILENO);
      ::execl(program.c_str(), "animeme", "batch", manifest.c_str(), "-o", out.c_str(), "--resume",
              nullptr);
      ::_exit(127);
    }
    const double wait = std::uniform_real_distribution<>(0, 1.5 * took / kills)(random);
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }
  // A line that was torn.
  std::ofstream(out + "/index.tsv", std::ios::app) << "part0/clip0\tok\tpart";
  succeeds(batch_line(manifest, out, {"--resume"}));
  EXPECT_TRUE(contents(dir / "quiet") == contents(out));
}

TEST(Batch, TellsWhatIsWrongWithAManifest) {
  const TempDir dir;
  const auto said = [&](const std::string& text, const std::string& name = "m.tsv") {
    spill(dir / name, text);
    const auto result = animeme({"batch", dir / name, "-o", dir / "out"});
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_FALSE(fs::exists(dir / "out")) << text;
    return result.err;
  };
  const std::string head = "id\ttext\toutputs\n", good = "a\tA\t.fba\n";
  EXPECT_THAT(said(""), HasSubstr("m.tsv: the manifest is empty"));
  EXPECT_THAT(said("id\ttexts\n"), HasSubstr("m.tsv:1:4: there is no column \"texts\""));
  EXPECT_THAT(said("text\n"), HasSubstr("m.tsv:1: there is no column \"id\""));
  EXPECT_THAT(said(head + good + "\n" + good), HasSubstr("m.tsv:4: the id is that of line 2"));
  EXPECT_THAT(said(head + good + "A\tA\t.fba\n"), HasSubstr("m.tsv:3: the id is that of line 2"));
  EXPECT_THAT(said(head + "a\tA\t.b.fba\na.b\tB\t.fba\n"),
              HasSubstr("m.tsv:3: a file that the row makes is that of line 2"));
  for (const char* id : {"../x", "/etc/x", "a/../../x", "a//b", ".x", "a/.", "."}) {
    EXPECT_THAT(said(head + id + "\tA\t.fba\n"), HasSubstr("m.tsv:2:1: id ")) << id;
  }
  EXPECT_THAT(said("text\tid\nA\t..\n"), HasSubstr("m.tsv:2:3: "));
  EXPECT_THAT(said(head + "\tA\t.fba\n"), HasSubstr("m.tsv:2:1: the row has no id"));
  EXPECT_THAT(said(head + "a\tA\t.fba\tmore\n"), HasSubstr("m.tsv:2:10: more fields"));
  EXPECT_THAT(said("{\"id\": 1}\n{\"id\": ]\n", "m.jsonl"), HasSubstr("m.jsonl:2:8: "));
  EXPECT_THAT(said(head + "index\tA\t.tsv\n"), HasSubstr("the name of a file of the batch"));
}

// A manifest comes from others: it names no programs unless the user says so.
TEST(Batch, AManifestRunsNoPrograms) {
  const TempDir dir;
  spill(dir / "say.sh", "#!/bin/sh\ntouch \"$0.ran\"\n");
  fs::permissions(dir / "say.sh", fs::perms::owner_all);
  const std::string say = dir / "say.sh";
  spill(dir / "m.tsv", "id\ttext\ttts\toutputs\na\tOne\t" + say + "\t.fba\n");
  spill(dir / "o.tsv", "id\ttext\toptions\toutputs\na\tOne\t--tts=" + say + "\t.fba\n");
  spill(dir / "o.jsonl",
        R"({"id": "a", "text": "One", "outputs": ".fba", "options": ["--tts", ")" + say + "\"]}\n");
  for (const char* name : {"m.tsv", "o.tsv", "o.jsonl"}) {
    const auto result = animeme(batch_line(dir / name, dir / "out"));
    EXPECT_NE(result.exit_code, 0) << name;
    EXPECT_THAT(result.err, HasSubstr("--allow-commands")) << name;
    EXPECT_FALSE(fs::exists(say + ".ran")) << name;
    animeme(batch_line(dir / name, dir / "trusted", {"--allow-commands"}));
    EXPECT_TRUE(fs::remove(say + ".ran")) << name;
    fs::remove_all(dir / "trusted");
  }
  spill(dir / "t.tsv", "id\ttext\toutputs\na\tOne\t.fba\n");
  animeme(batch_line(dir / "t.tsv", dir / "set", {"--set", "tts=" + say}));
  EXPECT_TRUE(fs::exists(say + ".ran"));
}

TEST(Batch, AWorkerThatDiesIsAnErrorOfItsRow) {
  const TempDir dir;
  spill(dir / "m.tsv",
        "id\ttext\ttts\toutputs\na\tOne\t\t.fba\nb\tTwo\tsh -c 'kill -9 $PPID'\t.fba\n"
        "c\tThree\t\t.fba\nd\tFour\t\t.fba\n");
  const auto now =
      json_of(batch_line(dir / "m.tsv", dir / "out", {"--jobs", "1", "--allow-commands"}), 1);
  EXPECT_EQ(now["ok"], 3);
  EXPECT_THAT(slurp(dir / "out/index.tsv"), HasSubstr("b\terror\t\t\t0\t\t\tcrashed by signal 9"));
  EXPECT_FALSE(fs::exists(dir / "out/.batch-1-of-1"));
}

TEST(Batch, HooksRunWithoutAShell) {
  const TempDir dir;
  fs::create_directories(dir / "shop");
  spill(dir / "copy.sh",
        "#!/bin/sh\ncp \"" + dir.path().string() + "/shop/${1#shop://}\" \"$2\"\n");
  spill(dir / "put.sh", "#!/bin/sh\ncp \"$1\" \"" + dir.path().string() + "/shop/${2#shop://}\"\n");
  for (const char* one : {"copy.sh", "put.sh"}) fs::permissions(dir / one, fs::perms::owner_all);
  spill(dir / "shop/text.txt", "Hello");
  const std::string odd = "shop/a $(touch bad); x.txt";
  spill(dir / odd, "World");
  const std::string table =
      "id\ttext_file\toutputs\na\tshop://text.txt\t.fba\nb\tshop://" + odd.substr(5) + "\t.fba\n";
  const auto result =
      animeme({"batch", "-", "-o", dir / "out", "--fetch", (dir / "copy.sh") + " {uri} {file}",
               "--store", (dir / "put.sh") + " {file} {uri}", "--to", "shop://"},
              table);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(dir / "shop/a.fba"));
  EXPECT_TRUE(fs::exists(dir / "shop/b.fba"));
  EXPECT_FALSE(fs::exists(dir / "out/b.fba"));
  EXPECT_FALSE(fs::exists("bad"));
}

// All that a playlist names, before the playlist itself.
TEST(Batch, StoresPlaylistsWithTheirSegments) {
  const TempDir dir;
  spill(dir / "put.sh",
        "#!/bin/sh\nset -e\nto=\"" + dir.path().string() +
            "/shop/${2#shop://}\"\nmkdir -p \"$(dirname \"$to\")\"\ncp \"$1\" \"$to\"\n"
            "echo \"$2\" >>\"" +
            dir.path().string() + "/order\"\n");
  fs::permissions(dir / "put.sh", fs::perms::owner_all);
  const auto result = animeme({"batch", "-", "-o", dir / "out", "--store",
                               (dir / "put.sh") + " {file} {uri}", "--to", "shop://"},
                              "id\ttext\toutputs\na\tHello\t.m3u8\n");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto face = animeme({"info", dir / "shop/a.m3u8"});
  EXPECT_EQ(face.exit_code, 0) << face.err;
  EXPECT_TRUE(fs::exists(dir / "shop/a_hls/face-00001.m4s"));
  const std::string order = slurp(dir / "order");
  EXPECT_TRUE(order.ends_with("shop://a.m3u8\n")) << order;
  EXPECT_FALSE(fs::exists(dir / "out/a_hls"));
}

}  // namespace batch_test
}  // namespace animeme::test
