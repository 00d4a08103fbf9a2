// `animeme corpus`: videos, a tracker and what is said become a folder that trains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "tests/app/program/commands.h"
#include "tests/support/landmark_tables.h"
#include "tests/support/shared.h"

namespace animeme {
namespace corpus_test {

namespace fs = std::filesystem;

using test::animeme;
using test::Json;
using test::json_of;
using test::slurp;
using test::spill;
using test::succeeds;
using test::TempDir;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// What a tracker finds in a face with these FAPs: 68 points of a picture, from a frame at rest on.
std::string tracked(const dam::Signal& signal, bool rest_first = false) {
  std::string text = "time_s,confidence";
  for (int i = 0; i < 68; ++i) {
    text += ",x_" + std::to_string(i) + ",y_" + std::to_string(i);
  }
  text += "\n";
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    fap::Frame frame;
    for (std::size_t c = 0; c < signal.names.size(); ++c) {
      const int fap = dam::fap_of_channel(signal.names[c]);
      if (!rest_first || i > 0) frame.set(fap, int(std::lround(signal.at(i, c))));
    }
    text += test::number(signal.time(i), 3) + ",1";
    const auto points = test::landmarks_of(test::moved_face(frame), fap::LandmarkLayout::ibug68);
    for (const fap::Point& point : points) {
      const fap::Point seen = test::Camera{30, {300, -200, 0}, {1, -1, 1}}(point, frame);
      text += "," + test::number(seen[0], 4) + "," + test::number(seen[1], 4);
    }
    text += "\n";
  }
  return text;
}

// Videos with a tracker that knows what is in them, and the scripts of what is said.
struct Studio {
  TempDir dir;
  std::vector<std::string> ids;

  Studio() {
    for (const char* folder : {"videos", "tables", "scripts"}) {
      fs::create_directories(dir / folder);
    }
    const fs::path sample = test::data_dir() / "grid_s1_sample";
    for (const auto& entry : fs::directory_iterator(sample / "fap")) {
      ids.push_back(entry.path().stem().string());
    }
    std::sort(ids.begin(), ids.end());
    ids.resize(8);
    for (const std::string& id : ids) {
      fs::copy(test::data_dir() / "containers/mpeg4_video.mp4", dir / ("videos/" + id + ".mp4"));
      fs::copy(sample / "phonemes" / (id + ".tsv"), dir / ("scripts/" + id + ".tsv"));
      const auto signal = dam::read_curves(slurp(sample / "fap" / (id + ".csv")));
      EXPECT_TRUE(signal);
      if (!signal) continue;
      spill(dir / ("tables/" + id + ".csv"), tracked(*signal));
      spill(dir / "rest.csv", tracked(*signal, true));
    }
    spill(dir / "track.sh", "id=$(basename \"$1\" .mp4); echo $id >>'" + dir / "log" + "'\ncp '" +
                                dir / "tables" + "'/$id.csv \"$2\"\n");
    spill(dir / "log", "");
  }

  std::vector<std::string> arguments(const std::string& out) const {
    return {"corpus",
            dir / "videos",
            dir / "scripts",
            "-o",
            out,
            "--tracker",
            "sh '" + dir / "track.sh" + "' {in} {out}",
            "--neutral-from",
            dir / "rest.csv",
            "--neutral",
            "0",
            "--smooth",
            "0"};
  }
  std::size_t tracks() const {
    const std::string log = slurp(dir / "log");
    return std::size_t(std::count(log.begin(), log.end(), '\n'));
  }
};

TEST(Corpus, FromVideosToASpeakingModel) {
  const Studio studio;
  const std::string out = studio.dir / "me";
  const Json report = json_of(studio.arguments(out));
  EXPECT_EQ(report["sentences"], 8);
  EXPECT_EQ(report["tracked"], 8);
  EXPECT_THAT(report["left_out"], testing::IsEmpty());
  EXPECT_EQ(report["rate"], 25.0);
  EXPECT_GT(report["closures"]["phones"], 3);
  EXPECT_GT(report["closures"]["share"], 0.7);

  // The curves are those that the face was moved by.
  const auto corpus = dam::read_corpus(out);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  ASSERT_EQ(corpus->utterances.size(), 8U);
  for (const dam::Utterance& made : corpus->utterances) {
    const auto want =
        dam::read_curves(slurp(test::data_dir() / "grid_s1_sample/fap" / (made.id + ".csv")));
    ASSERT_TRUE(want);
    ASSERT_EQ(made.signal.frames(), want->frames());
    int compared = 0;
    for (std::size_t c = 0; c < made.signal.names.size(); ++c) {
      const int fap = dam::fap_of_channel(made.signal.names[c]);
      if (fap > 13 && (fap < 51 || fap > 60)) continue;
      for (std::size_t w = 0; w < want->names.size(); ++w) {
        if (made.signal.names[c] != want->names[w]) continue;
        ++compared;
        for (std::size_t i = 0; i < want->frames(); ++i) {
          ASSERT_NEAR(made.signal.at(i, c), want->at(i, w), 1.5) << made.id << " " << fap;
        }
      }
    }
    EXPECT_EQ(compared, 21);
    EXPECT_THAT(made.text, HasSubstr(" ")) << "words of the script";
  }

  // It trains and speaks.
  succeeds({"train", out, "--split", "train", "--controls", "3-13", "-o", studio.dir / "me.dam"});
  succeeds({"speak", "--script", studio.dir / ("scripts/" + studio.ids[0] + ".tsv"), "--model",
            studio.dir / "me.dam", "-o", studio.dir / "talk.fap"});
  const fap::Sequence talk = test::read_clip(studio.dir / "talk.fap");
  int opened = 0;
  for (const fap::Frame& frame : talk.frames) opened = std::max(opened, -frame.value[5]);
  EXPECT_GT(opened, 100);
}

TEST(Corpus, GoesOnAndTellsWhatIsLeftOut) {
  const Studio studio;
  const std::string out = studio.dir / "me";
  const std::string first = studio.ids[0];
  fs::copy(studio.dir / ("videos/" + first + ".mp4"), studio.dir / "videos/unknown.mp4");
  spill(studio.dir / "scripts/unknown.tsv", slurp(studio.dir / ("scripts/" + first + ".tsv")));
  spill(studio.dir / "scripts/nobody.tsv", "start_s\tend_s\tphone\n0\t1\tAA\n");
  fs::remove(studio.dir / ("scripts/" + studio.ids[1] + ".tsv"));
  spill(studio.dir / ("scripts/" + studio.ids[2] + ".tsv"), "start_s\tend_s\tphone\n0\t1\tQQ\n");
  spill(studio.dir / "videos/empty.mp4", "");
  spill(studio.dir / "scripts/empty.tsv", "start_s\tend_s\tphone\n0\t1\tAA\n");

  const Json report = json_of(studio.arguments(out), 1);
  EXPECT_EQ(report["sentences"], 6);
  std::vector<std::string> stages;
  for (const Json& one : report["left_out"]) {
    stages.push_back(one["id"].get<std::string>() + " " + one["stage"].get<std::string>());
  }
  EXPECT_THAT(stages, testing::UnorderedElementsAre("nobody files", studio.ids[1] + " files",
                                                    "unknown track", "empty track",
                                                    studio.ids[2] + " align"));
  for (const char* file : {"report.txt", "report.json", "utterances.tsv", "neutral.face"}) {
    EXPECT_TRUE(fs::exists(fs::path(out) / file)) << file;
  }
  EXPECT_FALSE(fs::exists(fs::path(out) / "fap/unknown.csv"));
  EXPECT_THAT(slurp(fs::path(out) / "report.txt"),
              AllOf(HasSubstr("6 sentences"), HasSubstr("excluded: unknown (track): ")));

  // The rest was tracked and is not tracked again; the same comes out.
  const std::size_t before = studio.tracks();
  const std::string table = slurp(fs::path(out) / "utterances.tsv");
  const Json again = json_of(studio.arguments(out), 1);
  EXPECT_EQ(again["tracked"], 0);
  EXPECT_EQ(again["tracked_before"], 6);
  EXPECT_EQ(studio.tracks(), before + 1) << "the one that failed";
  EXPECT_EQ(slurp(fs::path(out) / "utterances.tsv"), table);

  // Another video under the same name is.
  fs::last_write_time(studio.dir / ("videos/" + first + ".mp4"),
                      fs::file_time_type::clock::now() + std::chrono::seconds(5));
  EXPECT_EQ(json_of(studio.arguments(out), 1)["tracked"], 1);
}

TEST(Corpus, FoldsHaveEachSentenceOnce) {
  const Studio studio;
  std::vector<std::string> arguments = studio.arguments(studio.dir / "me");
  arguments.insert(arguments.end(), {"--folds", "4"});
  succeeds(arguments);
  std::istringstream lines(slurp(studio.dir / "me/utterances.tsv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "id\ttext\tsplit\tfold\tfold1_split\tfold2_split\tfold3_split\tfold4_split\tseconds\t"
            "doubtful");
  std::vector<int> counts(4, 0);
  while (std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, '\t');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 10U) << line;
    const int fold = std::stoi(fields[3]);
    ++counts[std::size_t(fold - 1)];
    for (int i = 1; i <= 4; ++i) {
      EXPECT_EQ(fields[std::size_t(3 + i)], i == fold ? "test" : "train");
    }
    EXPECT_EQ(fields[2], fields[4]);
  }
  EXPECT_THAT(counts, ElementsAre(2, 2, 2, 2));
}

TEST(Corpus, AlignsWhatIsSaid) {
  const TempDir dir;
  fs::create_directories(dir / "tables");
  fs::create_directories(dir / "sound");
  const char* said[] = {"pick up the baby by the big blue boat",
                        "my mother makes more bread on monday"};
  std::string lines = "id,text\n";
  for (int i = 0; i < 2; ++i) {
    const std::string id = "s" + std::to_string(i);
    const auto spoken = animeme({"speak", "--text", said[i], "-o", dir / ("sound/" + id + ".mp4"),
                                 "--save-script", dir / (id + ".tsv")});
    if (spoken.exit_code != 0) GTEST_SKIP() << "built without espeak-ng";
    succeeds({"speak", "--text", said[i], "-o", dir / ("tables/" + id + ".csv")});
    lines += id + "," + said[i] + (i == 0 ? "," : "") + "\n";  // commas belong to the text
  }
  spill(dir / "lines.csv", lines);
  const auto result = animeme({"corpus", dir / "tables", dir / "lines.csv", "--audio",
                               dir / "sound", "-o", dir / "me", "--json"});
  if (result.exit_code == 3 && result.err.find("pocketsphinx") != std::string::npos) {
    GTEST_SKIP() << "built without pocketsphinx, or its model is not installed";
  }
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = Json::parse(result.out);
  EXPECT_EQ(report["aligned"], 2);
  EXPECT_EQ(report["per_sentence"][0]["text"], std::string(said[0]) + ",");
  EXPECT_EQ(report["per_sentence"][1]["script"], "aligned");
  EXPECT_GT(report["closures"]["share"], 0.8);
  const auto corpus = dam::read_corpus(dir / "me");
  ASSERT_TRUE(corpus) << corpus.error().describe();
  const auto truth = dam::read_script(slurp(dir / "s1.tsv"));
  ASSERT_TRUE(truth);
  // M is said four times; the aligner puts most of them near where the voice had it.
  std::vector<double> found, wanted;
  for (const dam::Phone& phone : corpus->utterances[1].script.phones) {
    if (phone.label == "M") found.push_back(phone.start);
  }
  for (const dam::Phone& phone : truth->phones) {
    if (phone.label == "M") wanted.push_back(phone.start);
  }
  ASSERT_EQ(found.size(), wanted.size());
  std::vector<double> off;
  for (std::size_t i = 0; i < found.size(); ++i) off.push_back(std::abs(found[i] - wanted[i]));
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 0.06);
  EXPECT_TRUE(fs::exists(dir / "me/audio/s1.wav"));
}

TEST(Corpus, WhatCannotBe) {
  const TempDir dir;
  fs::create_directories(dir / "videos");
  fs::create_directories(dir / "texts");
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"corpus", dir / "videos", dir / "texts", "-o", dir / "me"});
    return animeme(more);
  };
  const auto nothing = run({});
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.err, HasSubstr("there is no video and no tracker table here"));
  fs::copy(test::data_dir() / "containers/mpeg4_video.mp4", dir / "videos/a.mp4");
  const auto no_text = run({});
  EXPECT_EQ(no_text.exit_code, 3);
  EXPECT_THAT(no_text.err, HasSubstr("a: there is no transcript of this name in"));
  spill(dir / "texts/a.txt", "hello");
  const auto no_tracker = run({});
  EXPECT_EQ(no_tracker.exit_code, 3);
  EXPECT_THAT(no_tracker.err, HasSubstr("a tracker has to find the face in it"));
  EXPECT_FALSE(fs::exists(dir / "me/utterances.tsv"));
  const auto which = run({"--neutral", "0"});
  EXPECT_EQ(which.exit_code, 2);
  EXPECT_THAT(which.err, HasSubstr("name it with --neutral-from"));
}

}  // namespace corpus_test
}  // namespace animeme
