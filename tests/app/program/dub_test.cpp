// animeme dub: a table of languages becomes files, one with all of them, and a report.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "tests/app/program/batch_support.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"

namespace animeme {
namespace dub_test {

namespace fs = std::filesystem;
using test::animeme;
using test::json_of;
using test::spill;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;
using testing::Not;

std::string cue(int number, double start, double end, const std::string& text) {
  const auto clock = [](double seconds) {
    char out[32];
    const int ms = int(seconds * 1000 + 0.5);
    std::snprintf(out, sizeof out, "00:%02d:%02d,%03d", ms / 60000, ms / 1000 % 60, ms % 1000);
    return std::string(out);
  };
  return std::to_string(number) + "\n" + clock(start) + " --> " + clock(end) + "\n" + text + "\n\n";
}

// Subtitles in several languages, of which the German third one is far too long.
void write_subtitles(const TempDir& dir) {
  spill(dir / "de.srt",
        cue(1, 0.3, 2, "Guten Morgen, meine Freunde!") + cue(2, 2.4, 4.5, "Ich komme vom Meer.") +
            cue(3, 5, 5.6, "Mein Bruder wartet schon seit vielen Jahren am Hafen auf das Boot."));
  spill(dir / "fr.srt",
        cue(1, 0.3, 2, "Bonjour, mes amis !") + cue(2, 2.4, 4.5, "Je viens de la mer."));
  spill(dir / "es.srt",
        cue(1, 0.3, 2, "Buenos días, amigos.") + cue(2, 2.4, 4.5, "Vengo del mar."));
}

std::vector<std::string> dub_line(const std::string& table, const std::string& out,
                                  const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"dub", table, "-o", out, "-q"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

TEST(Dub, EachLanguageAndOneFileWithAll) {
  const TempDir dir;
  write_subtitles(dir);
  succeeds(
      {"speak", "--text", "Good morning, my friends. I come from the sea.", "-o", dir / "en.mp4"});
  const std::string folder = dir.path().string() + "/";
  spill(dir / "film.csv", "language,input,subtitles,options\nen," + folder + "en.mp4,,\nde,," +
                              folder + "de.srt,\"--mood joy\"\nfr,," + folder + "fr.srt,\n");
  const auto told = json_of(dub_line(dir / "film.csv", dir / "out", {"--over", dir / "en.mp4"}));
  EXPECT_EQ(told["failed"], 0);
  ASSERT_EQ(told["languages"].size(), 3u);
  EXPECT_EQ(told["languages"][0]["state"], "original");
  const auto& german = told["languages"][1];
  EXPECT_EQ(german["cues"], 3);
  EXPECT_EQ(german["late_cues"], 1);
  EXPECT_GT(int(german["cut_characters"]), 20);
  EXPECT_EQ(german["closures"]["phones"], german["closures"]["closed"]);
  EXPECT_GT(int(german["closures"]["phones"]), 3);

  // The film has what each file has.
  const auto info = json_of({"info", dir / "out/film.mp4"});
  std::string languages;
  for (const auto& track : info["tracks"])
    if (track["kind"] == "face") languages += track.value("language_tag", "") + " ";
  EXPECT_EQ(languages, "en de fr ");
  for (const char* lang : {"de", "fr"}) {
    const std::string alone = dir / "out/" + lang + ".mp4";
    succeeds({"demux", alone, "-o", dir / "a.fba", "-o", dir / "a.wav", "-o", dir / "a.TextGrid"});
    succeeds({"demux", dir / "out/film.mp4", "--track", std::string("lang=") + lang, "-o",
              dir / "b.fba", "-o", dir / "b.wav", "-o", dir / "b.TextGrid"});
    for (const char* ending : {".fba", ".wav", ".TextGrid"})
      EXPECT_EQ(test::slurp(dir / "a" + ending), test::slurp(dir / "b" + ending)) << lang << ending;
  }

  // The page has a menu of them.
  const auto page_said = animeme({"view", dir / "out/film.mp4", "-o", dir / "film.html", "--json"});
  EXPECT_THAT(page_said.out, HasSubstr("\"languages\": 3"));
  EXPECT_THAT(test::slurp(dir / "film.html"), HasSubstr("id=\"track2sound\""));
  EXPECT_THAT(page_said.err, Not(HasSubstr("warning")));

  // Each cue in its time, or told; worst first; the same in all three.
  const auto report = test::Json::parse(test::slurp(dir / "out/report.json"));
  ASSERT_EQ(report["cues"].size(), 5u);
  EXPECT_EQ(report["cues"][0]["lang"], "de");
  EXPECT_EQ(report["cues"][0]["cue"], 3);
  for (const auto& one : report["cues"]) {
    const double speed = one["speed"], end = double(one["said"]) + double(one["made"]);
    EXPECT_GE(speed, 0.8 - 1e-9);
    EXPECT_LE(speed, 1.3 + 1e-9);
    const double wanted = double(one["start"]) + double(one["wanted"]);
    if (one["cut_characters"] == 0)
      EXPECT_LE(end, wanted + 0.03);
    else
      EXPECT_NEAR(double(one["late"]), end - wanted, 1e-6);
    EXPECT_TRUE(one["confidence"].is_null());
  }
  const std::string csv = test::slurp(dir / "out/report.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_THAT(csv, HasSubstr("\"Bonjour, mes amis !\""));
  const std::string page = test::slurp(dir / "out/report.html");
  EXPECT_THAT(page, HasSubstr("lang=\"fr\">Bonjour, mes amis !<"));
  EXPECT_LT(page.find("vielen Jahren"), page.find("Bonjour"));
  for (const char* outside : {"http:", "https:", "<script", "<link", "src=", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside))) << outside;
  // Every cell has its name on narrow screens.
  std::size_t cells = 0, named = 0;
  for (std::size_t at = 0; (at = page.find("<td", at)) != page.npos; ++at) ++cells;
  for (std::size_t at = 0; (at = page.find("<td role=\"cell\" data-name=\"", at)) != page.npos;
       ++at)
    ++named;
  EXPECT_EQ(cells, named);

  // The smile of the options, and what was changed, is made again; the rest is not.
  spill(dir / "fr.srt", cue(1, 0.3, 2, "Salut, mes amis !"));
  const auto again =
      json_of(dub_line(dir / "film.csv", dir / "out", {"--over", dir / "en.mp4", "--resume"}));
  EXPECT_EQ(again["done_now"], 1);
  EXPECT_EQ(again["skipped"], 1);
  EXPECT_EQ(again["languages"][2]["cues"], 1);
  EXPECT_NE(again["film"]["made_from"], told["film"]["made_from"]);
  succeeds(dub_line(dir / "film.csv", dir / "quiet", {"--over", dir / "en.mp4", "--jobs", "1"}));
  EXPECT_TRUE(test::contents(dir / "out") == test::contents(dir / "quiet"));
}

TEST(Dub, PeopleInTwoLanguages) {
  const TempDir dir;
  spill(dir / "de.vtt",
        "WEBVTT\n\n00:00.300 --> 00:01.500\n<v Ann>Guten Tag.\n\n00:02.000 --> 00:03.500\n"
        "<v Bob>Wie geht es Ihnen?\n");
  spill(dir / "fr-ann.srt", cue(1, 0.3, 1.5, "Bonjour."));
  spill(dir / "fr-bob.srt", cue(1, 2, 3.5, "Comment allez-vous ?"));
  const std::string folder = dir.path().string() + "/";
  // A list of objects, and a person whose name has a comma.
  spill(dir / "film.json", R"([{"lang": "de", "speaker": "Ann", "subtitles": ")" + folder +
                               R"(de.vtt"},
 {"lang": "de", "speaker": "Bob", "subtitles": ")" +
                               folder + R"(de.vtt", "voice": "f3"},

 {"lang": "fr", "speaker": "Ann", "subtitles": ")" +
                               folder + R"(fr-ann.srt"},
 {"lang": "fr", "speaker": "Bob, Jr.", "subtitles": ")" +
                               folder + R"(fr-bob.srt"}])");
  const auto told = json_of(dub_line(dir / "film.json", dir / "out", {"--film", "two.mkv"}));
  ASSERT_EQ(told["languages"].size(), 4u);
  for (const auto& one : told["languages"]) {
    EXPECT_EQ(one["cues"], 1) << one;
    EXPECT_EQ(one["late_cues"], 0) << one;
  }
  EXPECT_TRUE(fs::exists(dir / "out/de-Ann.mp4"));
  EXPECT_TRUE(fs::exists(dir / "out/fr-Bob, Jr..mp4"));
  const auto report = test::Json::parse(test::slurp(dir / "out/report.json"));
  for (const auto& one : report["cues"])
    EXPECT_NEAR(double(one["said"]), one["speaker"] == "Ann" ? 0.3 : 2.0, 1e-6) << one;
  succeeds({"demux", dir / "out/two.mkv", "--track", "lang=fr,speaker=Bob\\, Jr.", "-o",
            dir / "bob.fba"});
  succeeds({"demux", dir / "out/fr-Bob, Jr..mp4", "-o", dir / "alone.fba"});
  EXPECT_EQ(test::slurp(dir / "bob.fba"), test::slurp(dir / "alone.fba"));
}

// A recording that was made somewhere else is put into the times of the subtitles.
TEST(Dub, ARecordedVoice) {
  const TempDir dir;
  succeeds({"speak", "--text",
            "Maybe Peter will bring a big map. My mother hopes that both of you are happy.", "-o",
            dir / "voice.mp4"});
  const auto demuxed = animeme({"demux", dir / "voice.mp4", "-o", dir / "voice.wav"});
  ASSERT_EQ(demuxed.exit_code, 0) << demuxed.err;
  const auto aligned = animeme({"align", "--audio", dir / "voice.wav", "--transcript", "Maybe",
                                "--min-confidence", "0", "-o", dir / "a.TextGrid"});
  if (aligned.err.find("without pocketsphinx") != std::string::npos) GTEST_SKIP() << aligned.err;
  spill(dir / "late.srt", cue(1, 3, 6, "Maybe Peter will bring a big map.") +
                              cue(2, 7, 8.2, "My mother hopes that both of you are happy."));
  const std::string folder = dir.path().string() + "/";
  spill(dir / "film.tsv",
        "lang\taudio\tsubtitles\ttranscript\tid\n"
        "en\t" +
            folder + "voice.wav\t" + folder +
            "late.srt\t\tmoved\n"
            "en-gb\t" +
            folder +
            "voice.wav\t\t"
            "Maybe Peter will bring a big map. My mother hopes that both of you are "
            "happy.\tsaid\n"
            "en-us\t" +
            folder + "voice.wav\t\t\theard\n");
  const auto told = json_of(dub_line(dir / "film.tsv", dir / "out"));
  EXPECT_EQ(told["failed"], 0) << told;
  const auto report = test::Json::parse(test::slurp(dir / "out/report.json"));
  ASSERT_EQ(report["cues"].size(), 4u);
  std::size_t moved = 0;
  for (const auto& one : report["cues"]) {
    EXPECT_TRUE(one["confidence"].is_number()) << one;
    EXPECT_EQ(one["closures"]["phones"], one["closures"]["closed"]) << one;
    if (one["id"] != "moved") continue;
    ++moved;
    EXPECT_NEAR(double(one["said"]), one["cue"] == 1 ? 3.0 : 7.0, 1e-6);
    EXPECT_GT(double(one["confidence"]), 0.3);
    if (one["cue"] == 1) {
      EXPECT_DOUBLE_EQ(double(one["speed"]), 1);
    } else {
      EXPECT_GT(double(one["speed"]), 1.2);
    }
  }
  EXPECT_EQ(moved, 2u);
  // What was in its time already is written as it is.
  succeeds({"demux", dir / "out/said.mp4", "-o", dir / "said.wav"});
  EXPECT_GT(fs::file_size(dir / "said.wav"), fs::file_size(dir / "voice.wav") * 9 / 10);
}

// A slip of the pen in a subtitle does not take the language with it.
TEST(Dub, ASubtitleThatEndsBeforeItBeginsIsSaidAndTold) {
  const TempDir dir;
  spill(dir / "de.srt",
        cue(1, 0.3, 2, "Guten Morgen!") + cue(2, 3, 2.5, "Wer ist da?") + cue(3, 5, 6, "Niemand."));
  spill(dir / "film.csv", "lang,subtitles\nde," + (dir / "de.srt") + "\n");
  const auto told = json_of(dub_line(dir / "film.csv", dir / "out"));
  EXPECT_EQ(told["languages"][0]["cues"], 3);
  ASSERT_EQ(told["languages"][0]["warnings"].size(), 1u);
  EXPECT_THAT(std::string(told["languages"][0]["warnings"][0]),
              HasSubstr("line 6: \"Wer ist da?\" ends before it begins"));
  EXPECT_THAT(test::slurp(dir / "out/report.html"), HasSubstr("ends before it begins"));
}

TEST(Dub, OnePartThatFails) {
  const TempDir dir;
  write_subtitles(dir);
  const std::string folder = dir.path().string() + "/";
  const std::string head = "lang,subtitles\nde," + folder + "de.srt\nfr," + folder;
  spill(dir / "film.csv", head + "nowhere.srt\n");
  const auto told = json_of(dub_line(dir / "film.csv", dir / "out"), 1);
  EXPECT_EQ(told["failed"], 1);
  EXPECT_FALSE(told.contains("film"));
  EXPECT_FALSE(fs::exists(dir / "out/film.mp4"));
  EXPECT_THAT(test::slurp(dir / "out/report.html"), HasSubstr("nowhere.srt"));
  spill(dir / "film.csv", head + "fr.srt\n");
  const auto again = json_of(dub_line(dir / "film.csv", dir / "out", {"--resume"}));
  EXPECT_EQ(again["done_now"], 1);
  EXPECT_TRUE(fs::exists(dir / "out/film.mp4"));
  // Of two people whose subtitles say other things, none is a voice.
  spill(dir / "phones.tsv", "lang\tsubtitles\nen\t" + folder + "p.tsv\n");
  spill(dir / "p.tsv", "start_s\tend_s\tphone\n0\t1\tAA\n");
  json_of(dub_line(dir / "phones.tsv", dir / "phones"), 1);
  EXPECT_THAT(test::slurp(dir / "phones/report.json"), HasSubstr("give subtitles"));
}

// Of a desktop and a phone, in light and dark: with subtitles that are too long, and a row that
// failed.
TEST(DubPage, AxeFindsNoViolations) {
  const std::string scripts = std::string(test::kSourceFolder) + "/tests/readers/js/";
  if (!test::has_program("chromium") || !test::has_program("node") ||
      !fs::exists(scripts + "node_modules/axe-core")) {
    GTEST_SKIP() << "chromium, node or axe-core is missing (tools/setup.sh full installs them)";
  }
  const TempDir dir;
  write_subtitles(dir);
  const std::string folder = dir.path().string() + "/";
  spill(dir / "film.csv", "lang,subtitles,speaker\nde," + folder + "de.srt,\nes," + folder +
                              "es.srt,Ana María\nfr," + folder + "nowhere.srt,\n");
  json_of(dub_line(dir / "film.csv", dir / "out"), 1);
  const auto said =
      test::run_command({"node", scripts + "page_axe.js", dir / "out/report.html", "1200", "390"});
  const auto report = test::Json::parse(said.out, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << said.err;
  ASSERT_TRUE(report.contains("checked"));
  EXPECT_EQ(report["violations"], test::Json::array());
  EXPECT_EQ(report["wide"], test::Json::array()) << "it scrolls sideways";
  ASSERT_EQ(report["checked"].size(), 4u);
  for (const auto& checked : report["checked"]) EXPECT_GT(int(checked), 20);
}

TEST(Dub, TellsWhatIsWrongWithATable) {
  const TempDir dir;
  spill(dir / "de.srt", cue(1, 0.3, 2, "Hallo!"));
  const auto said = [&](const std::string& text, const std::string& name = "t.csv",
                        const std::vector<std::string>& more = {}) {
    spill(dir / name, text);
    const auto result = animeme(dub_line(dir / name, dir / "out", more));
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_FALSE(fs::exists(dir / "out")) << text;
    return result.err;
  };
  EXPECT_THAT(said(""), HasSubstr("t.csv: the manifest is empty"));
  EXPECT_THAT(said("lang\n"), HasSubstr("the table has no rows"));
  EXPECT_THAT(said("lang,text\n"),
              HasSubstr("t.csv:1:6: there is no column \"text\"; columns are"));
  EXPECT_THAT(said("subtitles\nde.srt\n"), HasSubstr("t.csv:2: the row has no lang"));
  EXPECT_THAT(said("lang;subtitles\nGerman!;de.srt\n"), HasSubstr("is no language tag"));
  EXPECT_THAT(said("lang,audio\nde,\n"), HasSubstr("t.csv:2: the row has nothing to say"));
  EXPECT_THAT(said("lang,subtitles\nde,a.srt\nde,b.srt\n"),
              HasSubstr("t.csv:3: the id is that of line 2"));
  EXPECT_THAT(said("lang,subtitles\nde,\"a.srt\n"),
              HasSubstr("t.csv:2: a quote that does not end"));
  EXPECT_THAT(said("lang,subtitles\nde,\"a\"b\n"), HasSubstr("t.csv:2:4: something stands behind"));
  EXPECT_THAT(said("lang,subtitles,id\nde,a.srt,film\n"), HasSubstr("a file of the dub itself"));
  EXPECT_THAT(said("lang,subtitles,transcript\nde,a.srt,Hallo\n"), HasSubstr("give one of them"));
  EXPECT_THAT(said("lang,subtitles,tts\nde,a.srt,touch x\n"), HasSubstr("--allow-commands"));
  EXPECT_THAT(said("lang,subtitles,options\nde,a.srt,--tts=x\n"), HasSubstr("--allow-commands"));
  EXPECT_THAT(said("[{\"lang\": \"de\", \"subtitles\": \"a.srt\"},\n {\"lang\": }]", "t.json"),
              HasSubstr("t.json:2:"));
  EXPECT_THAT(said("[{\"lang\": \"de\"", "t.json"), HasSubstr("the list does not end"));
  EXPECT_THAT(said("\n  [\n{\"lang\": \"de\",\n\"subtitles\": \"a\"}, 5]", "t.json"),
              HasSubstr("t.json:4: the list has something that is no object"));
  for (const char* name : {"x", "a/b.mp4", ".mp4", "film.avi"}) {
    spill(dir / "t.csv", "lang,subtitles\nde,de.srt\n");
    EXPECT_EQ(animeme(dub_line(dir / "t.csv", dir / "out", {"--film", name})).exit_code, 2) << name;
  }
  EXPECT_EQ(animeme(dub_line(dir / "t.csv", dir / "out", {"--name", "{language}"})).exit_code, 2);
  const auto checked = animeme({"dub", dir / "t.csv", "-o", dir / "out", "--check"});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("1 rows, 0 problems"));
}

// A program that speaks has a sound of its own speed, which is stretched.
TEST(Dub, VoicesOfOtherPrograms) {
  const TempDir dir;
  const std::string program = std::string(test::kBinaryFolder) + "/bin/animeme";
  spill(dir / "tts.sh", "#!/bin/sh\ncat > \"$1.txt\"\n" + test::quoted(program) +
                            " speak -q --text-file \"$1.txt\" --lang \"$2\" -o \"$1.mp4\" "
                            "--save-script \"$3.TextGrid\" && mv \"$3.TextGrid\" \"$3\" && " +
                            test::quoted(program) + " demux -q \"$1.mp4\" -o \"$1\"\n");
  fs::permissions(dir / "tts.sh", fs::perms::owner_all);
  spill(dir / "de.srt",
        cue(1, 0.3, 1.3, "Ich komme vom weiten Meer.") + cue(2, 2, 4, "Guten Morgen."));
  spill(dir / "film.csv", "lang,subtitles\nde," + (dir / "de.srt") + "\n");
  const auto good =
      json_of(dub_line(dir / "film.csv", dir / "good",
                       {"--set", "tts=" + (dir / "tts.sh") + " {wav} {lang} {script}"}));
  ASSERT_EQ(good["failed"], 0) << good << test::slurp(dir / "good/report.json");
  const auto report = test::Json::parse(test::slurp(dir / "good/report.json"));
  for (const auto& one : report["cues"]) {
    if (one["cue"] != 1) continue;
    EXPECT_GT(double(one["speed"]), 1.05);
    EXPECT_LE(double(one["speed"]), 1.3 + 1e-9);
  }
}

// SIGKILL at random times; ANIMEME_KILLS: more of it, by hand.
TEST(Dub, KilledAndResumedEqualsAQuietRun) {
  const char* more = std::getenv("ANIMEME_KILLS");
  const int kills = more != nullptr ? std::atoi(more) : 8;
  const TempDir dir;
  write_subtitles(dir);
  succeeds({"speak", "--text", "Good morning, my friends.", "-o", dir / "en.mp4"});
  std::string table = "lang,subtitles,id,input\nen,,," + (dir / "en.mp4") + "\n";
  for (const char* lang : {"de", "fr", "es"})
    for (const char* part : {"a", "b"})
      table += std::string(lang) + (*part == 'b' ? "-x-other" : "") + "," + (dir / "") + lang +
               ".srt," + part + "/" + lang + ",\n";
  spill(dir / "film.csv", table);
  const std::vector<std::string> options = {"--over", dir / "en.mp4"};
  const auto before = std::chrono::steady_clock::now();
  succeeds(dub_line(dir / "film.csv", dir / "quiet", options));
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  std::mt19937 random(11);
  const std::string program = std::string(test::kBinaryFolder) + "/bin/animeme",
                    manifest = dir / "film.csv", out = dir / "killed", over = dir / "en.mp4";
  for (int i = 0; i < kills; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_RDWR);
      ::dup2(null, STDERR_FILENO);
      ::execl(program.c_str(), "animeme", "dub", manifest.c_str(), "-o", out.c_str(), "--over",
              over.c_str(), "--resume", nullptr);
      ::_exit(127);
    }
    const double wait = std::uniform_real_distribution<>(0, 1.5 * took)(random);
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }
  auto again = options;
  again.emplace_back("--resume");
  succeeds(dub_line(manifest, out, again));
  EXPECT_TRUE(test::contents(dir / "quiet") == test::contents(out));
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(!name.starts_with('.') || name.ends_with(".lock")) << entry.path();
  }
}

}  // namespace dub_test
}  // namespace animeme
