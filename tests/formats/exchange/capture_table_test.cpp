// Captures of any tracker as one kind of table: column maps, JSON, a row a point, foreign files.
#include "tools/formats/exchange/capture_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/script/table_text_internal.h"
#include "tests/support/landmark_tables.h"
#include "tools/formats/exchange/arkit.h"

namespace animeme::exchange {
namespace capture_table_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ColumnMap, RulesAreRead) {
  const auto plain = parse_column_rule("jaw=jawOpen");
  ASSERT_TRUE(plain) << plain.error().describe();
  EXPECT_EQ(plain->name, "jaw");
  EXPECT_EQ(plain->meaning, "jawOpen");
  EXPECT_EQ(plain->factor, 1);
  const auto percent = parse_column_rule(" a = b=jawOpen * 0.01 ");
  ASSERT_TRUE(percent) << percent.error().describe();
  EXPECT_EQ(percent->name, "a = b") << "the last = parts them";
  EXPECT_EQ(percent->factor, 0.01);
  const auto all = parse_column_rule("mouthL_*=8.3_*");
  ASSERT_TRUE(all) << all.error().describe();
  EXPECT_EQ(all->meaning, "8.3_*");
  for (const char* good : {"a=-", "a=x_61", "a=8.3_y", "a=nasion_x", "a=fap3", "a=open_jaw",
                           "a=time_s", "a=confidence", "mark=8.3", "p*=x_*"}) {
    EXPECT_TRUE(parse_column_rule(good)) << good;
  }
  for (const char* bad : {"", "a", "=", "a=", "=jawOpen", "a=jawOpn", "a=fap1", "a=99.9_x",
                          "a=jawOpen*", "a=jawOpen*0", "a=jawOpen*x", "a=jawOpen*1e999"}) {
    EXPECT_FALSE(parse_column_rule(bad)) << bad;
  }
}

TEST(ColumnMap, TablesOfRules) {
  const auto map = read_column_map("column;meaning;factor\n# a note\njaw;jawOpen;0.01\nt;time_s\n");
  ASSERT_TRUE(map) << map.error().describe();
  ASSERT_EQ(map->size(), 2U);
  EXPECT_EQ((*map)[0].factor, 0.01);
  EXPECT_EQ(read_column_map("").error().code, Code::truncated);
  const auto bad = read_column_map("jaw,jawOpen\nlips\n");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where.line, 2);
}

TEST(ColumnMap, RenamesMultipliesAndLeavesOut) {
  const auto out = rename_columns("T,Jaw,x\n\n0,10,a\n1,,b\n2,30\n",
                                  {{"t", "time_s", 1}, {"JAW", "jawOpen", 0.1}, {"x", "-", 1}});
  ASSERT_TRUE(out) << out.error().describe();
  EXPECT_EQ(*out, "time_s,jawOpen\n\n0,1\n1,\n2,30\n") << "lines keep their numbers";
  const auto none = rename_columns("a,b\n1,2\n", {{"c", "jawOpen", 1}});
  EXPECT_THAT(none.error().message, HasSubstr("no column is called 'c'; there are: a, b"));
  const auto word = rename_columns("a,b\n1,two\n", {{"b", "jawOpen", 2}});
  EXPECT_EQ(word.error().where.line, 2);
}

TEST(CaptureTable, AStarStandsForTheAxes) {
  const auto table = capture_table(
      "time_s,L.X,L.Y,R.X,R.Y,N.x,N.y,C.x,C.y\n0,1,2,3,4,5,6,7,8\n",
      {{{"L.*", "8.3_*", 1}, {"R.*", "8.4_*", 1}, {"N.*", "9.15_*", 1}, {"C.*", "2.1_*", 1}}});
  ASSERT_TRUE(table) << table.error().describe();
  EXPECT_EQ(table->kind, CaptureKind::landmarks);
  EXPECT_THAT(table->table, HasSubstr("time_s,8.3_X,8.3_Y,8.4_X,8.4_Y,9.15_x"));
}

// The frames of a wide table of MediaPipe as JSON of several makes.
std::string as_json(int kind) {
  const auto table = test::mediapipe(4, 478);
  const auto lines = dam::table_lines(table);
  std::string out = kind == 0   ? "{\"width\": 1280, \"height\": 720, \"frames\": ["
                    : kind == 1 ? "["
                                : "";
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = dam::split_fields(lines[i].text, ',');
    std::string points;
    for (std::size_t p = 0; p < 478; ++p) {
      const auto at = [&](std::size_t axis) { return std::string(fields[1 + 3 * p + axis]); };
      points += (p == 0 ? "" : ",") +
                (kind == 1 ? "[" + at(0) + "," + at(1) + "," + at(2) + "]"
                           : "{\"x\":" + at(0) + ",\"y\":" + at(1) + ",\"z\":" + at(2) + "}");
    }
    const std::string ms = std::to_string(40 * (i - 1));
    if (kind != 2 && i > 1) out += ",";
    out += kind == 0   ? "{\"timestamp_ms\":" + ms + ",\"faceLandmarks\":[[" + points + "]]}"
           : kind == 1 ? "{\"t\":" + std::string(fields[0]) + ",\"landmarks\":[" + points + "]}"
                       : "{\"time_s\":" + std::string(fields[0]) +
                             ",\"result\":1,\"faces\":[{\"keypoints\":[" + points + "]}]}\n";
  }
  return out + (kind == 0 ? "]}" : kind == 1 ? "]" : "");
}

TEST(CaptureTable, JsonOfMediaPipe) {
  LandmarkImportOptions options;
  options.neutral = "0";
  options.face.smooth = 0;
  options.table.size = PictureSize{1280, 720};
  const auto want = import_landmarks(test::mediapipe(4, 478), options);
  ASSERT_TRUE(want) << want.error().describe();
  for (int kind = 0; kind < 3; ++kind) {
    const auto table = capture_table(as_json(kind));
    ASSERT_TRUE(table) << kind << table.error().describe();
    EXPECT_EQ(table->kind, CaptureKind::landmarks);
    EXPECT_EQ(table->layout, fap::LandmarkLayout::mediapipe);
    EXPECT_EQ(table->size.has_value(), kind == 0);
    options.table.layout = table->layout;
    const auto take = import_landmarks(table->table, options);
    ASSERT_TRUE(take) << kind << take.error().describe();
    ASSERT_EQ(take->face.clip.frames.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(take->face.clip.frames[i].value, want->face.clip.frames[i].value) << kind;
    }
  }
}

TEST(CaptureTable, JsonOfShapes) {
  const char* text =
      "{\"results\":[{\"time\":0,\"faceBlendshapes\":[{\"categories\":[{\"categoryName\":\"_"
      "neutral\","
      "\"score\":0.5},{\"categoryName\":\"jawOpen\",\"score\":0.25}]}]},"
      "{\"time\":0.04,\"blendshapes\":{\"jawOpen\":0.5,\"mouthClose\":1}},"
      "{\"time\":0.08}]}";
  const auto table = capture_table(text);
  ASSERT_TRUE(table) << table.error().describe();
  EXPECT_EQ(table->kind, CaptureKind::arkit);
  EXPECT_EQ(table->table, "time_s,jawOpen,mouthClose\n0,0.25,0\n0.04,0.5,1\n");
  EXPECT_THAT(table->warnings, ElementsAre(HasSubstr("without a face, skipped: 1")));
  EXPECT_TRUE(read_arkit_table(table->table));
}

TEST(CaptureTable, HostileJson) {
  for (const char* text :
       {"{", "[", "[]", "{}", "[[[[[[[[[[]]]]]]]]]]", "{\"frames\": 3}",
        "{\"frames\": [1, null, \"x\"]}", "[{\"landmarks\": [[1,2],[3,4],[5,6],[7,\"8\"]]}]",
        "[{\"landmarks\": {\"a\": 1}}]",
        "[{\"landmarks\":[[1,2],[3,4],[5,6],[7,8]]},{\"landmarks\":[[1,2],[3,4],[5,6],[7,8],[9,1]]}"
        "]",
        "{\"frames\":[{\"landmarks\":[[[[[[[[1,2]]]]]]]]}]}"}) {
    const auto table = capture_table(text);
    ASSERT_FALSE(table) << text;
    EXPECT_FALSE(table.error().message.empty());
  }
  // As deep as a file likes: an error, no stack that ends.
  EXPECT_FALSE(capture_table(std::string(100000, '[')));
}

TEST(CaptureTable, ARowAPoint) {
  const auto table = capture_table(
      "frame,face_id,landmark_index,x,y\n0,1,13.0,1,2\n0,1,14.0,3,4\n0,1,61,5,6\n0,1,291,7,8\n"
      "1,1,14,30,40\n1,1,13,10,20\n");
  ASSERT_TRUE(table) << table.error().describe();
  EXPECT_EQ(table->table,
            "frame,face_id,13_x,13_y,14_x,14_y,61_x,61_y,291_x,291_y\n"
            "0,1,1,2,3,4,5,6,7,8\n1,1,10,20,30,40,,,,\n");
  // Names by a map; frames by what comes again.
  const auto named = capture_table("marker;x;y\nL;1;2\nR;3;4\nskip;0;0\nL;5;6\nR;7;8\n",
                                   {{{"l", "8.3", 1}, {"R", "8.4", 1}, {"skip", "-", 1}}});
  ASSERT_TRUE(named) << named.error().describe();
  EXPECT_EQ(named->table, "8.3_x;8.3_y;8.4_x;8.4_y\n1;2;3;4\n5;6;7;8\n");
  EXPECT_FALSE(capture_table("frame,point,x,y\n0,8.3,1,2\n0,8.3,3,4\n"));
  EXPECT_FALSE(capture_table("frame,point,x,y\n0,8.3,1\n"));
  EXPECT_FALSE(capture_table("frame,point,x,y\n"));
}

TEST(CaptureTable, SaysWhatAFileIs) {
  using namespace std::string_literals;
  const struct {
    std::string text;
    const char* what;
  } cases[] = {
      {"", "empty"},
      {"\n \n", "empty"},
      {"hello\n", "first line is one field"},
      {"PK\x03\x04", "spreadsheet"},
      {"\x1f\x8b\x08", "gunzip"},
      {"\x93NUMPY", "numpy"},
      {"\x80\x04\x95", "pickle"},
      {"HIERARCHY\nROOT Hips\n", "skeletal motion (BVH)"},
      {"ANIMEDAM", "trained model"},
      {"version: 1\nn_points: 68\n", "one picture"},
      {"2.1 talk 25 2\n1 0 0\n", "already FAPs"},
      {"\0\0\1\xBA"s, "FBA stream"},
      {"RIFF\x01\x02", "not text"},
      {"<?xml version=\"1.0\"?>", "XML"},
      {"0.1,0.2,0.3\n", "no column names"},
      {"a,b\n1,2\n", "no column is an ARKit blend shape"},
  };
  for (const auto& one : cases) {
    const auto table = capture_table(one.text);
    ASSERT_FALSE(table) << one.text;
    EXPECT_THAT(table.error().message, HasSubstr(one.what)) << one.text;
  }
}

TEST(CaptureTable, OtherTablesStayAsTheyAre) {
  for (const auto& [text, kind] :
       {std::pair{std::string("time_s,jawOpen,mouthClose\n0,1,2\n"), CaptureKind::arkit},
        {std::string("time_s,jawOpen\n0,1\n"), CaptureKind::arkit},
        {std::string("time_s,fap3_open_jaw\n0,1\n"), CaptureKind::faps},
        {test::openface(2), CaptureKind::landmarks}}) {
    const auto table = capture_table(text);
    ASSERT_TRUE(table) << table.error().describe();
    EXPECT_EQ(table->kind, kind);
    EXPECT_EQ(table->table, text);
    EXPECT_THAT(table->warnings, IsEmpty());
  }
}

}  // namespace capture_table_test
}  // namespace animeme::exchange
