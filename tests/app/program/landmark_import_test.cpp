// `animeme import` of tracked landmarks: 68 points, MediaPipe, feature points.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "dam/corpus/corpus.h"
#include "dam/script/table_text_internal.h"
#include "dam/signal/fap_signal.h"
#include "tests/support/landmark_tables.h"
#include "tests/support/shared.h"

namespace animeme {
namespace landmark_import_test {

using test::acted;
using test::animeme;
using test::Camera;
using test::expect_faps;
using test::import;
using test::Imported;
using test::mediapipe;
using test::moved_face;
using test::number;
using test::sixty_eight;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(ImportLandmarks, NamesOfColumns) {
  const std::function<std::string(int, char)> names[] = {
      [](int i, char axis) { return std::string(1, axis) + std::to_string(i); },
      [](int i, char axis) { return std::string(1, axis) + "_" + std::to_string(i + 1); },
      [](int i, char axis) { return "landmark_" + std::to_string(i) + "_" + axis; },
      [](int i, char axis) { return "LM" + std::to_string(i + 1) + std::string(1, axis); },
      [](int i, char axis) { return std::to_string(i) + "_" + std::string(1, axis); },
      [](int i, char axis) {
        return std::string(1, char(axis - 'a' + 'A')) + "_" + std::to_string(i);
      }};
  for (const auto& name : names) {
    const Imported take =
        import(sixty_eight(10, name), {"--rate", "25", "--neutral", "0", "--smooth", "0"});
    EXPECT_EQ(take.clip.rate, (fap::Rate{25, 1}));
    EXPECT_EQ(take.clip.frames.size(), 10U) << name(0, 'x');
    expect_faps(take.clip, {3, 5, 12, 13, 19, 20, 31, 32, 50}, 1);
    EXPECT_FALSE(take.clip.frames[0].mask[49]);
  }
}

TEST(ImportLandmarks, MediaPipe) {
  const Imported take =
      import(mediapipe(8, 478), {"--size", "1280x720", "--neutral", "0", "--smooth", "0"});
  expect_faps(take.clip, {3, 5, 12, 18, 19, 23, 24, 25, 26, 31, 39, 41, 42, 48, 49, 50, 63}, 1);
  EXPECT_THAT(take.talk, Not(HasSubstr("warning")));
  const Imported few = import(mediapipe(3, 468), {"--size", "1280x720", "--neutral", "0"});
  EXPECT_FALSE(few.clip.frames[0].mask[23]);
  EXPECT_TRUE(few.clip.frames[0].mask[18]);
}

TEST(ImportLandmarks, TheShapeOfThePictureIsGuessed) {
  for (const auto& [width, height, name] : {std::tuple{1280, 720, "16:9"},
                                            {640, 480, "4:3"},
                                            {512, 512, "1:1"},
                                            {480, 640, "3:4"},
                                            {1080, 1920, "9:16"}}) {
    const Imported take =
        import(mediapipe(4, 478, width, height), {"--neutral", "0", "--smooth", "0"});
    EXPECT_THAT(take.talk, HasSubstr(name));
    expect_faps(take.clip, {3, 5, 12, 19, 31, 48, 49, 50}, 1);
  }
}

TEST(ImportLandmarks, FeaturePointsByTheirNames) {
  std::string text = "timestamp";
  const std::vector<std::string> ids = {"2.1",  "2.2",  "2.3",  "3.1",   "3.2", "3.3",
                                        "3.4",  "3.7",  "3.8",  "8.3",   "8.4", "9.3",
                                        "9.15", "3.11", "3.12", "nasion"};
  for (const std::string& id : ids) text += "," + id + "_x," + id + "_y," + id + "_z";
  text += ",note\n";
  for (int i = 0; i < 10; ++i) {
    text += number(i * 0.04, 2);
    const auto face = moved_face(acted(i));
    for (const std::string& id : ids) {
      const fap::Point seen = Camera{}(face.find(id)->second, acted(i));
      const bool lost = i == 4 && id == "2.3";
      for (const double value : seen) text += "," + (lost ? std::string("nan") : number(value));
    }
    text += ",hello\n";
  }
  const Imported take = import(text, {"--neutral", "0-0", "--smooth", "0", "--no-repair"});
  expect_faps(take.clip, {3, 14, 15, 19, 20, 48, 49, 50}, 1);
  EXPECT_FALSE(take.clip.frames[4].mask[5]);
  EXPECT_TRUE(take.clip.frames[5].mask[5]);
  EXPECT_THAT(take.talk, AllOf(HasSubstr("ignored: note"), HasSubstr("missing points: 1\n")));
}

TEST(ImportLandmarks, FacesAreTakenOneByOne) {
  std::string text = "timestamp,face_id";
  const auto name = [](int i, char axis) { return std::string(1, axis) + std::to_string(i); };
  std::string table = sixty_eight(6, name);
  std::string out;
  std::size_t begin = 0;
  for (int line = 0; begin < table.size(); ++line) {
    const std::size_t end = table.find('\n', begin);
    const std::string row = table.substr(begin, end - begin);
    const std::string start = line == 0 ? "timestamp;face_id;" : "";
    if (line == 0) out += start + row + "\n";
    for (int face = 1; line > 0 && face <= 2; ++face) {
      out += number((line - 1) * 0.04, 2) + ";" + std::to_string(face) + ";" + row + "\n";
    }
    begin = end + 1;
  }
  EXPECT_THAT(import(out, {"--neutral", "0"}).talk,
              AllOf(HasSubstr("6 frames"), HasSubstr("rows of other faces, skipped: 6")));
  EXPECT_EQ(import(out, {"--neutral", "0", "--face", "2"}).clip.frames.size(), 6U);
}

// Recorded speech: 40 lip points and two of the chin as MediaPipe found them, the head taken off by
// others, and the FAPs that others made of them (channels.tsv: which point, which axis, which
// unit). The points of the head are put where the units of that face have them.
TEST(ImportLandmarks, RecordedLips) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  const auto folder = test::shared_dir() / "data" / "grid_s1";
  const auto facts = nlohmann::json::parse(test::slurp(folder / "neutral.json"));
  const auto& rest = facts["neutral_px"];
  const double eyes = 0.8;  // height of their middle
  const double nose = eyes + double(facts["fapu_px"]["ENS"]);
  const double half = double(facts["fapu_px"]["IRISD"]) / 2;
  const double side = double(facts["fapu_px"]["ES"]) / 2;
  const std::string head_names =
      ",x33,y33,x263,y263,x133,y133,x362,y362,x168,y168,x2,y2,x386,y386,x374,y374,x159,y159,x145,"
      "y145";
  std::string head;
  for (const char* id : {"33", "263", "133", "362", "168"}) {
    head += "," + number(rest[id][0]) + "," + number(rest[id][1]);
  }
  head += ",0," + number(nose);
  for (const double x : {side, -side}) {
    for (const double y : {eyes - half, eyes + half}) head += "," + number(x) + "," + number(y);
  }
  for (const char* id : {"bbal9a", "bbaszn", "bbwg2p"}) {
    std::istringstream lips(test::slurp(folder / "lips" / (std::string(id) + ".csv")));
    std::string line;
    std::getline(lips, line);
    std::string table = line + head_names + "\n";
    // The neutral face first, a frame before the clip.
    table += "-0.04";
    for (const std::string_view name : dam::split_fields(line, ',')) {
      if (name.starts_with("time")) continue;
      table += "," + number(rest[std::string(name.substr(1))][name[0] == 'x' ? 0 : 1]);
    }
    table += head + "\n";
    while (std::getline(lips, line)) table += line + head + "\n";
    const Imported take =
        import(table, {"--layout", "mediapipe", "--flat", "--neutral", "0", "--smooth", "0"});
    const auto want = dam::read_curves(test::slurp(folder / "fap" / (std::string(id) + ".csv")));
    ASSERT_TRUE(want) << want.error().message;
    ASSERT_EQ(take.clip.frames.size(), want->frames() + 1);
    int compared = 0;
    for (std::size_t c = 0; c < want->names.size(); ++c) {
      const int fap = dam::fap_of_channel(want->names[c]);
      if (fap == 14 || fap == 16 || fap == 17) continue;  // depth
      double largest = 0;
      for (std::size_t i = 0; i < want->frames(); ++i) {
        const fap::Frame& frame = take.clip.frames[i + 1];
        ASSERT_TRUE(frame.mask[std::size_t(fap)]) << fap;
        largest = std::max(largest, std::abs(frame.value[std::size_t(fap)] - want->at(i, c)));
      }
      // The table has hundredths of a pixel, half a unit of MNS, and so has the neutral face.
      EXPECT_LT(largest, 4) << id << " " << want->names[c];
      ++compared;
    }
    EXPECT_EQ(compared, 23);
  }
}

TEST(ImportLandmarks, BadTables) {
  const TempDir dir;
  const auto name = [](int i, char axis) { return std::string(1, axis) + std::to_string(i); };
  const std::string good = sixty_eight(3, name);
  std::string letters = good;
  letters.replace(letters.rfind(';') + 1, 3, "abc");
  std::string short_row = good;
  short_row.resize(short_row.rfind(';'));
  std::string twice = good;
  twice.replace(0, 2, "x1");
  std::string fewer = good;
  fewer.replace(fewer.find("x8"), 2, "qq");
  const std::string head = good.substr(0, good.find('\n') + 1);
  const struct {
    std::string text;
    std::vector<std::string> options;
    int exit_code;
    const char* what;
  } cases[] = {
      {good, {}, 3, "no column has the times"},
      {letters, {"--rate", "25"}, 3, ":4:"},
      {letters, {"--rate", "25"}, 3, "y67 is 'abc"},
      {short_row, {"--rate", "25"}, 3, "135 fields where the header has 136"},
      {twice, {"--rate", "25", "--layout", "68"}, 3, ":1:7: the column x1 is there twice"},
      {fewer, {"--rate", "25", "--layout", "68"}, 3, "the point 2.1 has no column for its x"},
      {"x0;y0;x1;y1\n1;2;3;4\n",
       {"--rate", "25", "--flat"},
       3,
       "2 numbered points are not a known layout"},
      {head, {"--rate", "25"}, 3, "no row after the header"},
      {good, {"--rate", "25", "--neutral", "9"}, 3, "its frames are 0 to 2"},
      {good, {"--rate", "25", "--neutral", "x"}, 3, "--neutral: 'x'"},
      {good, {"--rate", "25", "--smooth", "2"}, 2, "--smooth"},
      {good, {"--rate", "25", "--size", "big"}, 2, "--size"},
      {good, {"--rate", "25", "--layout", "98"}, 2, "--layout"},
      {"time_s,jawOpen,jawLeft\n0,0,0\n0.04,0,0\n", {"--mirrored"}, 2, "blend shapes"},
  };
  for (const auto& one : cases) {
    spill(dir / "take.csv", one.text);
    std::vector<std::string> arguments = {"import", dir / "take.csv", "--exact", "-o",
                                          dir / "take.fap"};
    arguments.insert(arguments.end(), one.options.begin(), one.options.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, one.exit_code) << one.what << "\n" << result.err;
    EXPECT_THAT(result.err, HasSubstr(one.what));
    EXPECT_THAT(dir.files(), ElementsAre("take.csv")) << one.what;
  }
}

}  // namespace landmark_import_test
}  // namespace animeme
