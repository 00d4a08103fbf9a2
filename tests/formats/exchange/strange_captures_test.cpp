// Captures as other programs write them: percent, timecodes of several kinds, JSON of any
// structure, action units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/capture_table.h"
#include "tools/formats/exchange/motion.h"

namespace animeme::exchange {
namespace strange_captures_test {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string format(const char* text, auto... values) {
  char out[160];
  std::snprintf(out, sizeof out, text, values...);
  return out;
}

std::size_t channel(std::string_view name) {
  return std::size_t(fap::find_arkit(name).value_or(0));
}

// As `animeme import` reads it.
Result<Imported> imported(std::string_view text, const ArkitOptions& options = {}) {
  auto table = capture_table(text);
  if (!table) return table.error();
  EXPECT_EQ(table->kind, CaptureKind::arkit);
  auto read = read_arkit_table(table->table, options);
  if (!read) return read;
  read->warnings.insert(read->warnings.begin(), table->warnings.begin(), table->warnings.end());
  return read;
}

ArkitCurves weights(std::string_view text, const ArkitOptions& options = {}) {
  auto table = capture_table(text);
  EXPECT_TRUE(table) << table.error().describe();
  if (!table) return {};
  auto read = read_arkit_weights(table->table, options);
  EXPECT_TRUE(read) << read.error().describe();
  return read ? *read : ArkitCurves{};
}

TEST(StrangeCaptures, PercentIsScaled) {
  std::string text = "time_s,jawOpen,eyeBlinkLeft,headYaw\n";
  for (int i = 0; i < 30; ++i) text += format("%.4f,%d,10,0.3\n", i / 30.0, 20 + 2 * i);
  const ArkitCurves curves = weights(text);
  ASSERT_EQ(curves.frames.size(), 30u);
  EXPECT_NEAR(curves.frames[29][channel("jawOpen")], 0.78, 1e-9);
  EXPECT_NEAR(curves.frames[3][channel("eyeBlinkLeft")], 0.1, 1e-9);
  EXPECT_NEAR(curves.frames[3][channel("headYaw")], 0.3, 1e-9) << "angles have their own unit";
  EXPECT_THAT(imported(text)->warnings, Contains(HasSubstr("percent")));
}

// One wild value makes no percentages of the others.
TEST(StrangeCaptures, AGlitchIsNoPercentage) {
  std::string text = "time_s,jawOpen,mouthClose\n";
  for (int i = 0; i < 60; ++i) text += format("%.4f,%g,0.1\n", i / 60.0, i == 7 ? 40.0 : 0.5);
  const ArkitCurves curves = weights(text);
  EXPECT_NEAR(curves.frames[20][channel("jawOpen")], 0.5, 1e-9);
  EXPECT_THAT(imported(text)->warnings, Contains(HasSubstr("jawOpen is 40")));
}

TEST(StrangeCaptures, DegreesAreScaled) {
  std::string text = "time_s,jawOpen,mouthClose,headYaw\n";
  for (int i = 0; i < 30; ++i) text += format("%.4f,0.5,0,%d\n", i / 30.0, i);
  EXPECT_NEAR(weights(text).frames[29][channel("headYaw")], 29 * M_PI / 180, 1e-9);
  EXPECT_THAT(imported(text)->warnings, Contains(HasSubstr("degrees")));
}

// The other eye rests, it does not blink as well.
TEST(StrangeCaptures, OneSideAloneMoves) {
  const auto take = imported("time_s,jawOpen,eyeBlinkLeft\n0,0.2,0.7\n0.0333,0.2,0.7\n");
  ASSERT_TRUE(take) << take.error().describe();
  const fap::Frame& frame = take->clip.frames[0];
  EXPECT_TRUE(frame.mask[20]);
  EXPECT_EQ(frame.value[20], 0);
  EXPECT_GT(frame.value[19], 300);
}

// All of these are 600 rows, 60 a second.
std::string rows_of_timecodes(const std::function<std::string(int row)>& time, int rows = 600) {
  std::string text = "Timecode,BlendShapeCount,JawOpen,MouthClose\n";
  for (int i = 0; i < rows; ++i) text += time(i) + format(",61,%.4f,0\n", i / 1000.0);
  return text;
}

void expect_all_rows(const std::string& text, double rate, std::size_t rows = 600) {
  const auto take = imported(text);
  ASSERT_TRUE(take) << take.error().describe();
  ASSERT_EQ(take->clip.frames.size(), rows);
  EXPECT_EQ(take->clip.frames.back().number, std::int64_t(rows) - 1);
  EXPECT_NEAR(take->clip.rate.frames_per_second(), rate, 1e-6);
  EXPECT_THAT(take->warnings, Not(Contains(HasSubstr("skipped"))));
}

TEST(StrangeCaptures, TimecodesWithMilliseconds) {
  // The frame, rounded down wrongly now and then, and milliseconds of the second.
  expect_all_rows(rows_of_timecodes([](int i) {
                    const int ms = int(i * 1000.0 / 60);
                    return format("00:00:%02d:%02d.%03d", ms / 1000, ms % 1000 * 60 / 1000,
                                  ms % 1000);
                  }),
                  60);
  // Milliseconds of the second alone, with and without fractions.
  expect_all_rows(rows_of_timecodes([](int i) {
                    const double ms = i * 1000.0 / 30;
                    return format("00:00:%02d:%07.3f", int(ms / 1000), std::fmod(ms, 1000));
                  }),
                  30);
  expect_all_rows(rows_of_timecodes([](int i) {
                    const int ms = i * 40;
                    return format("00:00:%02d:%03d", ms / 1000, ms % 1000);
                  }),
                  25);
  // Frames and fractions of a frame, as Live Link Face writes them.
  expect_all_rows(
      rows_of_timecodes([](int i) { return format("10:59:%02d:%02d.250", 50 + i / 60, i % 60); }),
      60);
}

// Drop-frame: labels 00 and 01 are left out at the start of each minute but the tenth.
TEST(StrangeCaptures, DropFrameTimecodesHaveNoGaps) {
  expect_all_rows(rows_of_timecodes(
                      [](int i) {
                        const int label = i + 1000 + (i + 1000 >= 1800 ? 2 : 0);
                        return format("01:00:%02d;%02d", label / 30, label % 30)
                            .replace(3, 5, format("%02d:%02d", label / 1800, label / 30 % 60));
                      },
                      1600),
                  30000 / 1001.0, 1600);
  // Thirty seconds behind the start, a picture is 0.03 s later than its label.
  const auto take = imported(rows_of_timecodes(
      [](int i) { return format("00:01:%02d;%02d", (i + 2) / 60, (i + 2) % 60); }, 1800));
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_EQ(take->clip.rate, (fap::Rate{60000, 1001}));
}

// Whichever rate: the frame and milliseconds of the second, and milliseconds without zeros.
TEST(StrangeCaptures, TimecodesWithMillisecondsOfAllRates) {
  for (const int rate : {24, 25, 30, 48, 50, 60, 100, 120}) {
    const auto text_of = [&](auto last_field) {
      return rows_of_timecodes([&](int i) {
        const double seconds = double(i) / rate + 1e-9;
        return format("03:00:%02d:", int(seconds)) + last_field(seconds - std::floor(seconds));
      });
    };
    expect_all_rows(text_of([&](double part) {
                      return format("%02d.%03d", int(part * rate), int(part * 1000));
                    }),
                    rate);
    expect_all_rows(text_of([](double part) { return format("%d", int(part * 1000)); }), rate);
  }
}

// The labels of these have three digits, too.
TEST(StrangeCaptures, TimecodesOfFastCameras) {
  for (const int rate : {120, 200, 240}) {
    expect_all_rows(rows_of_timecodes([&](int i) {
                      return format("00:00:%02d:%03d", (i + 7) / rate, (i + 7) % rate);
                    }),
                    rate);
  }
}

TEST(StrangeCaptures, FormsOfTimes) {
  const struct {
    const char* name;
    std::function<std::string(double seconds)> time;
  } forms[] = {
      {"Time (s)", [](double s) { return format("%.4f", s); }},
      {"time [ms]", [](double s) { return format("%.2f", s * 1000); }},
      {"timestampMs", [](double s) { return format("%.0f", 1.7e12 + s * 1000); }},
      {"time_ns", [](double s) { return format("%.0f", s * 1e9); }},
      {"t", [](double s) { return format("%.4f", s); }},
      {"elapsed", [](double s) { return format("%.4fs", s); }},
      {"time", [](double s) { return format("%.1f ms", s * 1000); }},
      {"time", [](double s) { return format("59:%07.4f", 50 + s); }},
      {"time",
       [](double s) { return format("\"09:00:%02d,%03d\"", int(s), int(s * 1000) % 1000); }},
      {"Timestamp", [](double s) { return format("2024-02-29 12:00:%07.4f", s); }},
      {"Timestamp", [](double s) { return format("2024-02-29T12:00:%07.4f+02:00", s); }},
      {"date_time", [](double s) {  // midnight passes, and the year
         return format(s < 1 ? "2023-12-31T23:59:%07.4fZ" : "2024-01-01T00:00:%07.4fZ",
                       s < 1 ? 59 + s : s - 1);
       }}};
  for (const auto& form : forms) {
    std::string text = std::string(form.name) + ",JawOpen,MouthClose\n";
    for (int i = 0; i < 90; ++i) text += form.time(i / 30.0 + 1e-9) + format(",%g,0\n", i / 100.0);
    const auto take = imported(text);
    ASSERT_TRUE(take) << form.name << take.error().describe();
    EXPECT_EQ(take->clip.frames.size(), 90u) << text.substr(0, 80);
    EXPECT_EQ(take->clip.rate, (fap::Rate{30, 1})) << text.substr(0, 80);
  }
}

// An iPhone that records 59.94 pictures a second under a timecode of 60.
TEST(StrangeCaptures, TakesThatAreSlowerThanTheirTimecode) {
  const std::string text = rows_of_timecodes(
      [](int i) {
        const double frames = i * 60 / 59.904;
        return format("00:00:%02d:%06.3f", int(frames / 60), std::fmod(frames, 60));
      },
      1900);
  expect_all_rows(text, 60000 / 1001.0, 1900);
}

// So long that they would run away: frames are added, and it is said what they are.
TEST(StrangeCaptures, LongTakesStayInTime) {
  std::string text = "time_s,jawOpen,mouthClose\n";
  for (int i = 0; i < 20000; ++i) text += format("%.6f,0.1,0\n", i / 59.904);
  const auto take = imported(text);
  ASSERT_TRUE(take) << take.error().describe();
  const auto& frames = take->clip.frames;
  EXPECT_NEAR(take->clip.rate.seconds(double(frames.back().number)), 19999 / 59.904, 0.05);
  EXPECT_EQ(frames.size(), std::size_t(frames.back().number) + 1) << "there are no gaps";
  EXPECT_THAT(take->warnings, Contains(HasSubstr("keep in time")));
}

// A row that is missing is missing.
TEST(StrangeCaptures, GapsAreGaps) {
  std::string text = "time_s,jawOpen,mouthClose\n";
  for (int i = 0; i < 100; ++i) {
    if (i != 50) text += format("%.4f,0.1,0\n", i / 60.0);
  }
  const auto take = imported(text);
  ASSERT_TRUE(take);
  EXPECT_EQ(take->clip.frames.size(), 99u);
  EXPECT_EQ(take->clip.frames.back().number, 99);
}

// The frames of all that follow: jawOpen from 0 in steps of 0.1, mouthSmileLeft 0.5.
void expect_ten_frames(const std::string& json, double rate) {
  const auto take = imported(json);
  ASSERT_TRUE(take) << json << "\n" << take.error().describe();
  EXPECT_NEAR(take->clip.rate.frames_per_second(), rate, 1e-6) << json;
  const ArkitCurves curves = weights(json);
  ASSERT_EQ(curves.frames.size(), 10u) << json;
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(curves.frames[i][channel("jawOpen")], double(i) / 10, 1e-6) << json;
    EXPECT_NEAR(curves.frames[i][channel("mouthSmileLeft")], 0.5, 1e-6) << json;
  }
  // Every command that reads a face reads it.
  const auto motion = read_motion({json.begin(), json.end()});
  ASSERT_TRUE(motion) << json << "\n" << motion.error().describe();
  EXPECT_EQ(motion->face.frames.size(), 10u);
}

std::string joined(const std::function<std::string(int frame)>& one, const char* between = ", ") {
  std::string text;
  for (int i = 0; i < 10; ++i) text += (i > 0 ? between : "") + one(i);
  return text;
}

TEST(StrangeCaptures, OurOwnJsonComesBack) {
  ArkitCurves curves{{30, 1}, std::vector<fap::ArkitFrame>(10)};
  for (std::size_t i = 0; i < 10; ++i) {
    curves.frames[i][channel("jawOpen")] = double(i) / 10;
    curves.frames[i][channel("mouthSmileLeft")] = 0.5;
    curves.frames[i][channel("headYaw")] = 0.2;
  }
  expect_ten_frames(write_arkit_json(curves, "talk.wav"), 30);
  EXPECT_NEAR(weights(write_arkit_json(curves)).frames[3][channel("headYaw")], 0.2, 1e-6);
}

TEST(StrangeCaptures, JsonWithANameListAndAMatrix) {
  const auto row = [](int i) { return format("[0.5, %g, 0]", i / 10.0); };
  const std::string names = "[\"mouthSmileLeft\", \"jawOpen\", \"mouthClose\"]";
  expect_ten_frames("{\"exportFps\": 30.0, \"numPoses\": 3, \"facsNames\": " + names +
                        ", \"weightMat\": [" + joined(row) + "]}",
                    30);
  // One row a name.
  expect_ten_frames("{\"info\": {\"fps\": 24}, \"names\": " + names + ", \"curves\": [[" +
                        joined([](int) { return "0.5"; }) + "], [" +
                        joined([](int i) { return format("%g", i / 10.0); }) + "], [" +
                        joined([](int) { return "0"; }) + "]]}",
                    24);
  // Rows in objects, with times.
  expect_ten_frames("{\"names\": " + names + ", \"frames\": [" + joined([&](int i) {
                      return "{\"weights\": " + row(i) +
                             format(", \"time\": %g, \"rotation\": []}", i / 60.0);
                    }) + "]}",
                    60);
}

TEST(StrangeCaptures, JsonWithNumbersByName) {
  const auto frame = [](int i) {
    return format("\"jawOpen\": %g, \"mouthSmile_L\": 0.5, \"viseme_aa\": 0", i / 10.0);
  };
  const auto time = [](int i) { return format("%.6f", i / 25.0); };
  expect_ten_frames(
      "[" + joined([&](int i) { return "{" + frame(i) + ", \"time\": " + time(i) + "}"; }) + "]",
      25);
  expect_ten_frames("{\"meta\": {\"frame_rate\": \"25\"}, \"data\": {\"take\": [" +
                        joined([&](int i) { return "{\"face\": {\"bs\": {" + frame(i) + "}}}"; }) +
                        "]}}",
                    25);
  expect_ten_frames("{\"fps\": 25, \"track\": {" + joined([&](int i) {
                      return format("\"%d\": {", i) + frame(i) + "}";
                    }) + "}}",
                    25);
  expect_ten_frames(joined(
                        [&](int i) {
                          return "{\"timestamp_ms\": " + format("%d", 40 * i) + ", " + frame(i) +
                                 "}";
                        },
                        "\n"),
                    25);
  expect_ten_frames("{\"fps\": 25, \"jawOpen\": [" +
                        joined([](int i) { return format("%g", i / 10.0); }) +
                        "], \"mouthSmileLeft\": [" + joined([](int) { return "0.5"; }) + "]}",
                    25);
}

// JavaScript and Python write other names and other depths.
TEST(StrangeCaptures, MediaPipeFromJavaScriptAndPython) {
  const auto list = [](const char* name, int i) {
    return format("[{\"index\": 0, \"score\": 0.01, \"%s\": \"_neutral\"}, ", name) +
           format("{\"index\": 25, \"score\": %g, \"%s\": \"jawOpen\", \"displayName\": \"\"}, ",
                  i / 10.0, name) +
           format("{\"index\": 44, \"score\": 0.5, \"%s\": \"mouthSmileLeft\"}]", name);
  };
  expect_ten_frames("{\"frames\": [" + joined([&](int i) {
                      return format(
                                 "{\"timestamp\": %.6f, \"faceLandmarks\": [], "
                                 "\"faceBlendshapes\": [{\"headIndex\": -1, \"categories\": ",
                                 i / 30.0) +
                             list("categoryName", i) + "}]}";
                    }) + "]}",
                    30);
  expect_ten_frames("[" + joined([&](int i) {
                      return format("{\"timestamp_ms\": %.3f, \"face_blendshapes\": [",
                                    i * 1000 / 30.0) +
                             list("category_name", i) + "]}";
                    }) + "]",
                    30);
  expect_ten_frames("{\"fps\": 30, \"blendshapes\": [" +
                        joined([&](int i) { return list("category_name", i); }) + "]}",
                    30);
}

TEST(StrangeCaptures, AzuresPieces) {
  const auto row = [](int i) {
    std::string text = "[";
    for (int k = 0; k < 55; ++k) {
      text += (k > 0 ? "," : "") + (k == 17 ? format("%g", i / 10.0) : k == 23 ? "0.5" : "0");
    }
    return text + "]";
  };
  const auto piece = [&](int first) {
    std::string rows;
    for (int i = first; i < first + 5; ++i) rows += (i > first ? "," : "") + row(i);
    return format("{\"FrameIndex\": %d, \"BlendShapes\": [", first) + rows + "]}";
  };
  expect_ten_frames("[" + piece(0) + "," + piece(5) + "]", 60);
  // As text in the events of its visemes.
  tools::Json events = tools::Json::array();
  for (const int first : {0, 5}) {
    events.push_back({{"AudioOffset", 10}, {"VisemeId", 0}, {"Animation", piece(first)}});
  }
  expect_ten_frames(events.dump(), 60);
}

TEST(StrangeCaptures, JsonWithoutTimesWantsARate) {
  const std::string json = "[{\"jawOpen\": 0.1, \"mouthClose\": 0}, {\"jawOpen\": 0.2}]";
  const auto none = imported(json);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("--rate"));
  const auto given = imported(json, {fap::Rate{50, 1}, false});
  ASSERT_TRUE(given) << given.error().describe();
  EXPECT_EQ(given->clip.frames.size(), 2u);
}

TEST(StrangeCaptures, PrefixesOfColumns) {
  EXPECT_EQ(fap::find_arkit("blendShapes.JawOpen"), fap::find_arkit("jawOpen"));
  EXPECT_EQ(fap::find_arkit("head_lod0_mesh__jawOpen"), fap::find_arkit("jawOpen"));
  EXPECT_EQ(fap::find_arkit("Face|eyeBlink.L"), fap::find_arkit("eyeBlinkLeft"));
  EXPECT_EQ(fap::find_arkit("EYEBLINKLEFT"), fap::find_arkit("eyeBlinkLeft"));
  for (const char* other : {"", ".", "jaw", "x_61", "8.3_y", "blendShapes.", "__", "openjaw"}) {
    EXPECT_FALSE(fap::find_arkit(other)) << other;
  }
  for (const fap::FapInfo& info : fap::kFaps) EXPECT_FALSE(fap::find_arkit(info.name)) << info.name;
  const auto take = imported(
      ",timeCode,blendShapes.JawOpen,blendShapes.EyeBlinkLeft\n0,0.0,0.1,0\n1,0.033333,0.2,0\n"
      "2,0.066667,0.3,0\n");
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_EQ(take->clip.rate, (fap::Rate{30, 1}));
}

TEST(StrangeCaptures, ActionUnitsAlone) {
  std::string text =
      "frame, face_id, timestamp, confidence, success, gaze_angle_x, gaze_angle_y, pose_Rx, "
      "pose_Ry, pose_Rz, AU01_r, AU12_r, AU26_r, AU45_r, AU12_c, AU28_c\n";
  for (int i = 0; i < 10; ++i) {
    text += format("%d, 0, %.3f, 0.98, %d, 0.1, 0.2, 0.05, 0.1, 0, 0, 2.5, %g, 5, 1, 0\n", i + 1,
                   i * 0.04, i == 9 ? 0 : 1, i / 2.0);
  }
  const auto take = imported(text);
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_THAT(take->warnings, Contains(HasSubstr("-2Dfp")));
  const ArkitCurves curves = weights(text);
  ASSERT_EQ(curves.frames.size(), 9u) << "one row has no face";
  EXPECT_EQ(curves.rate, (fap::Rate{25, 1}));
  EXPECT_NEAR(curves.frames[0][channel("mouthSmileRight")], 0.5, 1e-6);
  EXPECT_NEAR(curves.frames[0][channel("eyeBlinkLeft")], 1, 1e-6);
  EXPECT_GT(curves.frames[8][channel("jawOpen")], 0.4);
  EXPECT_NEAR(curves.frames[0][channel("headYaw")], 0.1, 1e-6);
  EXPECT_NEAR(curves.frames[0][channel("browInnerUp")], 0, 1e-6);
  EXPECT_EQ(take->clip.frames[0].value[19] + take->clip.frames[0].value[21], 1024) << "lids meet";
}

// Rows without numbers, and a second person in the picture.
TEST(StrangeCaptures, ActionUnitsOfSeveralFacesWithHoles) {
  std::string text = "frame,face_id,timestamp,AU04_r,AU12_r,AU26_r,AU45_r\n";
  for (int i = 0; i < 30; ++i) {
    const char* const smile = i == 10 ? "nan" : "2.5";
    text += i == 20 ? format("%d,0,%.2f,,,,\n", i, i * 0.04)
                    : format("%d,0,%.2f,1,%s,%g,0\n", i, i * 0.04, smile, i / 10.0);
    text += format("%d,1,%.2f,5,5,5,5\n", i, i * 0.04);
  }
  const auto take = imported(text);
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_THAT(take->warnings, Contains(HasSubstr("other faces than the first, skipped: 30")));
  EXPECT_THAT(take->warnings, Contains(HasSubstr("rows without a face, skipped: 1")));
  const ArkitCurves curves = weights(text);
  ASSERT_EQ(curves.frames.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(curves.frames[i][channel("mouthSmileLeft")], 0.5, 1e-6) << i;
    EXPECT_NEAR(curves.frames[i][channel("eyeBlinkLeft")], 0, 1e-6) << i;
  }
}

// The same rows, as other programs write them.
std::string table_with(const std::string& front, const char* separator, const char* end,
                       const char* quote, char point = '.') {
  std::string text = front;
  const auto row = [&](std::initializer_list<std::string> fields) {
    std::string line;
    for (const std::string& field : fields) {
      line += (line.empty() ? "" : separator) + (quote + field + quote);
    }
    text += line + end;
  };
  row({"time_s", "jawOpen", "eyeBlinkLeft"});
  for (int i = 0; i < 50; ++i) {
    std::string time = format("%.4f", i / 25.0), jaw = format("%.3f", i / 100.0), blink = "0.250";
    for (std::string* one : {&time, &jaw, &blink}) (*one)[one->find('.')] = point;
    row({time, jaw, blink});
  }
  return text;
}

TEST(StrangeCaptures, TablesOfOthers) {
  const std::string bom = "\xEF\xBB\xBF";
  for (const std::string& text :
       {table_with("", ",", "\n", ""), table_with("", ",", "\n", "\""),
        table_with("", ";", "\r\n", "\"", ','), table_with("", ",", "\n", "\"", ','),
        table_with(bom + "sep=;\r\n", ";", "\r\n", ""),
        table_with("# a take\n# of mine\n", ",", "\n", ""), table_with("# ", " ", "\n", ""),
        table_with("", "   ", "\n", ""), table_with("", " | ", "\n", ""),
        table_with("", ",", "\r", ""), table_with("", ",", ",\n", ""),
        table_with("", "\t", "\n", "", ','), table_with("", ",", "\n", "") + ",,\n,,\n"}) {
    const ArkitCurves curves = weights(text);
    ASSERT_EQ(curves.frames.size(), 50u) << text.substr(0, 100);
    EXPECT_EQ(curves.rate, (fap::Rate{25, 1}));
    EXPECT_NEAR(curves.frames[37][channel("jawOpen")], 0.37, 1e-9) << text.substr(0, 100);
    EXPECT_NEAR(curves.frames[37][channel("eyeBlinkLeft")], 0.25, 1e-9);
  }
  // A field that has separators within quotes.
  EXPECT_TRUE(
      imported("time_s,jawOpen,mouthClose,who\n0,0.1,0,\"Ann, Bob\"\n0.1,0.2,0,\"C\"\"D\"\n"));
}

// A missing number is no 0: the mouth would shut for a frame.
TEST(StrangeCaptures, MissingNumbersAreInterpolated) {
  for (const char* nothing : {"", "NaN", "nan", "NA", "#N/A", "null", "None", "-", "-nan(ind)"}) {
    std::string text = "time_s,jawOpen,mouthClose,tongueOut\n";
    for (int i = 0; i < 50; ++i) {
      const std::string jaw = i == 20 || i == 21 ? nothing : format("%.2f", i / 100.0);
      text += format("%.2f,", i / 25.0) +
              (i == 30 ? std::string(nothing) + "," + nothing + "," + nothing
                       : jaw + ",0.1," + nothing) +
              "\n";
    }
    const auto take = imported(text);
    ASSERT_TRUE(take) << nothing << take.error().describe();
    EXPECT_THAT(take->warnings, Contains(HasSubstr("interpolated: 2")));
    EXPECT_THAT(take->warnings, Contains(HasSubstr("rows without a face, skipped: 1")));
    EXPECT_THAT(take->warnings, Contains(HasSubstr("without a number are ignored: tongueOut")));
    ASSERT_EQ(take->clip.frames.size(), 49u);
    const ArkitCurves curves = weights(text);
    EXPECT_NEAR(curves.frames[20][channel("jawOpen")], 0.20, 1e-9);
    EXPECT_NEAR(curves.frames[21][channel("jawOpen")], 0.21, 1e-9);
  }
  // At the ends the next one is held.
  const ArkitCurves ends = weights("time_s,jawOpen,mouthClose\n0,,0\n0.04,0.3,0\n0.08,NaN,0\n");
  ASSERT_EQ(ends.frames.size(), 3u);
  EXPECT_NEAR(ends.frames[0][channel("jawOpen")], 0.3, 1e-9);
  EXPECT_NEAR(ends.frames[2][channel("jawOpen")], 0.3, 1e-9);
  const ArkitCurves percent = weights("time_s,jawOpen,mouthClose\n0,12%,0\n0.04,0.5%,0%\n");
  EXPECT_NEAR(percent.frames[0][channel("jawOpen")], 0.12, 1e-9);
  EXPECT_FALSE(imported("time_s,jawOpen,mouthClose\n0,inf,0\n0.04,0,0\n"));
  // Of a recording that was stopped, all whole rows are read.
  const auto cut = imported("time_s,jawOpen,mouthClose\n0,0,0\n0.04,0,0\n0.08,0");
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->clip.frames.size(), 2u);
  EXPECT_THAT(cut->warnings, Contains(HasSubstr("cut off")));
}

// {"jawOpen": ..., "eyeBlinkLeft": ...} with curves of any form.
std::string curves_by_name(const std::function<std::string(int row, double value)>& entry,
                           const char* open, const char* close) {
  std::string text = "{\"fps\": 30, \"takes\": {";
  for (const char* name : {"jawOpen", "eyeBlinkLeft"}) {
    text += format("%s\"%s\": %s", name[0] == 'e' ? ", " : "", name, open);
    for (int i = 0; i < 40; ++i) {
      text += (i > 0 ? ", " : "") + entry(i, name[0] == 'e' ? 0.5 : i / 100.0);
    }
    text += close;
  }
  return text + "}}";
}

TEST(StrangeCaptures, CurvesByNameInAnyForm) {
  for (const std::string& text :
       {curves_by_name([](int i, double v) { return format("\"%d\": %g", i, v); }, "{", "}"),
        curves_by_name([](int i, double v) { return format("[%g, %g]", i / 30.0, v); }, "[", "]"),
        curves_by_name([](int, double v) { return format("%g", v); }, "{\"values\": [", "]}"),
        curves_by_name(
            [](int i, double v) { return format("{\"time_ms\": %g, \"v\": %g}", i / 0.03, v); },
            "{\"keys\": [", "]}")}) {
    const ArkitCurves curves = weights(text);
    ASSERT_EQ(curves.frames.size(), 40u) << text.substr(0, 100);
    EXPECT_EQ(curves.rate, (fap::Rate{30, 1}));
    EXPECT_NEAR(curves.frames[29][channel("jawOpen")], 0.29, 1e-6) << text.substr(0, 100);
    EXPECT_NEAR(curves.frames[29][channel("eyeBlinkLeft")], 0.5, 1e-6);
  }
  // A list of named curves; keys at times of their own are interpolated.
  const ArkitCurves keys = weights(
      R"([{"name": "jawOpen", "keys": [[0, 0], [1, 1]]},
          {"name": "mouthClose", "keys": [[0, 0.2], [0.25, 0.2], [0.5, 0.2], [0.75, 0.2], [1, 0.2]]}])");
  ASSERT_EQ(keys.frames.size(), 5u);
  EXPECT_NEAR(keys.frames[3][channel("jawOpen")], 0.75, 1e-9);
  EXPECT_NEAR(keys.frames[3][channel("mouthClose")], 0.2, 1e-9);
}

TEST(StrangeCaptures, FramesInJson) {
  const auto list = [](const std::function<std::string(int row)>& member, bool back = false) {
    std::string text = "[";
    for (int i = 0; i < 40; ++i) {
      const int row = back ? 39 - i : i;
      text += (i > 0 ? "," : "") + format("{\"jawOpen\": %g, \"mouthClose\": 0, ", row / 100.0) +
              member(row) + "}";
    }
    return text + "]";
  };
  for (const std::string& text :
       {list([](int i) { return format("\"timestamp\": %.3f", 1.7e12 + i / 0.03); }),
        list([](int i) { return format("\"time\": \"%.4f\"", i / 30.0); }),
        list([](int i) { return format("\"timecode\": \"00:00:%02d:%02d\"", i / 30, i % 30); }),
        list([](int i) { return format("\"time\": %.4f", i / 30.0); }, true),
        "{\"dt\": 0.0333333, \"frames\": " + list([](int) { return "\"id\": 1"; }) + "}"}) {
    const ArkitCurves curves = weights(text);
    ASSERT_EQ(curves.frames.size(), 40u) << text.substr(0, 120);
    EXPECT_NEAR(curves.rate.frames_per_second(), 30, 1e-9) << text.substr(0, 120);
    EXPECT_NEAR(curves.frames[29][channel("jawOpen")], 0.29, 1e-6) << text.substr(0, 120);
  }
  // Lists of pairs; a table with its names apart; NaN, as Python writes it.
  const ArkitCurves pairs = weights(R"({"fps": 25, "frames": [[["jawOpen", 0.5], ["mouthClose", 0]],
                                                              [["jawOpen", 0.6], ["mouthClose", 0]]]})");
  ASSERT_EQ(pairs.frames.size(), 2u);
  EXPECT_NEAR(pairs.frames[1][channel("jawOpen")], 0.6, 1e-9);
  const ArkitCurves split = weights(
      R"({"columns": ["time_s", "jawOpen", "mouthClose"], "index": [0, 1, 2],
          "data": [[0, 0.1, 0], [0.04, NaN, 0], [0.08, 0.3, -Infinity]]})");
  ASSERT_EQ(split.frames.size(), 3u);
  EXPECT_EQ(split.rate, (fap::Rate{25, 1}));
  EXPECT_NEAR(split.frames[1][channel("jawOpen")], 0.2, 1e-9);
}

}  // namespace strange_captures_test
}  // namespace animeme::exchange
