#include "fap/fapu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace fapu_test {

using ::testing::HasSubstr;
using ::testing::Not;

// A face of round numbers: IRISD 1, ES 6, ENS 5, MNS 2, MW 4.
FeaturePoints face() {
  return {{"3.1", {3, 5.5, 9}}, {"3.2", {-3, 5.5, 9}}, {"3.3", {3, 4.5, 9}}, {"3.4", {-3, 4.5, 9}},
          {"3.5", {3, 5, 9}},   {"3.6", {-3, 5, 9}},   {"9.15", {0, 0, 11}}, {"2.2", {0, -2, 11}},
          {"8.3", {2, -2, 10}}, {"8.4", {-2, -2, 10}}};
}

constexpr Fapu kFace = {1, 6, 5, 2, 4};

Fapu measured(const FeaturePoints& points) {
  const Result<Fapu> fapu = measure_fapu(points);
  EXPECT_TRUE(fapu) << (fapu ? "" : fapu.error().describe());
  return fapu ? *fapu : Fapu{};
}

TEST(Fapu, Measures) { EXPECT_EQ(measured(face()), kFace); }

TEST(Fapu, FallsBackWhereAPointIsMissing) {
  FeaturePoints no_pupils = face();
  no_pupils.erase("3.5");
  no_pupils.erase("3.6");
  EXPECT_EQ(measured(no_pupils), kFace);

  FeaturePoints no_left_eye = face();
  for (const char* id : {"3.1", "3.3"}) no_left_eye.erase(id);
  EXPECT_EQ(measured(no_left_eye), kFace);

  FeaturePoints one_pupil = no_pupils;
  one_pupil["3.6"] = {-3, 5.25, 9};
  one_pupil["3.1"][0] = 3.5;
  EXPECT_DOUBLE_EQ(measured(one_pupil).ens, 5.25);
  EXPECT_DOUBLE_EQ(measured(one_pupil).es, 6.5);
}

TEST(Fapu, NamesWhatIsMissing) {
  FeaturePoints points = face();
  points.erase("9.15");
  points.erase("8.4");
  const Result<Fapu> fapu = measure_fapu(points);
  ASSERT_FALSE(fapu);
  EXPECT_EQ(fapu.error().code, Code::not_found);
  EXPECT_THAT(fapu.error().message,
              HasSubstr("9.15 (bottom middle edge of the nose) for ENS, 9.15"));
  EXPECT_THAT(fapu.error().message,
              HasSubstr("8.4 (right corner of the outer lip contour) for MW"));
  EXPECT_THAT(fapu.error().message, Not(HasSubstr("8.3")));
  EXPECT_EQ(measure_fapu({}).error().code, Code::not_found);
}

TEST(Fapu, RefusesFacesThatLookTheWrongWay) {
  FeaturePoints swapped = face();
  std::swap(swapped["8.3"], swapped["8.4"]);
  const Result<Fapu> fapu = measure_fapu(swapped);
  ASSERT_FALSE(fapu);
  EXPECT_EQ(fapu.error().code, Code::invalid_argument);
  EXPECT_THAT(fapu.error().message, HasSubstr("MW = 8.3.x - 8.4.x"));
  FeaturePoints infinite = face();
  infinite["2.2"][1] = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(measure_fapu(infinite).error().code, Code::invalid_argument);
}

TEST(Fapu, Displacement) {
  EXPECT_DOUBLE_EQ(displacement(3, 1024, kFace), 2);      // MNS
  EXPECT_DOUBLE_EQ(displacement(6, -512, kFace), -2);     // MW
  EXPECT_DOUBLE_EQ(displacement(19, 1024, kFace), 1);     // IRISD
  EXPECT_DOUBLE_EQ(displacement(31, 1024, kFace), 5);     // ENS
  EXPECT_DOUBLE_EQ(displacement(37, 1024, kFace), 6);     // ES
  EXPECT_DOUBLE_EQ(displacement(48, 50000, kFace), 0.5);  // rad
  for (const int fap : {-1, 0, 1, 2, 69}) {
    EXPECT_EQ(displacement(fap, 100, kFace), 0) << fap;
    EXPECT_EQ(fap_value(fap, 100, kFace), 0) << fap;
  }
}

TEST(Fapu, InverseOfDisplacement) {
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    EXPECT_GT(step_size(fap, kFace), 0);
    for (const double value : {-1860.0, -1.0, 0.0, 0.25, 77.0, 100000.0}) {
      EXPECT_DOUBLE_EQ(fap_value(fap, displacement(fap, value, kFace), kFace), value) << fap;
    }
  }
  EXPECT_EQ(fap_value(3, 1, Fapu{}), 0);
}

TEST(Fapu, Axes) {
  const auto is = [](int fap, MoveKind kind, Point axis) {
    const Move move = move_of(fap);
    EXPECT_EQ(int(move.kind), int(kind)) << fap;
    EXPECT_EQ(move.axis, axis) << fap;
  };
  is(1, MoveKind::none, {0, 0, 0});
  is(3, MoveKind::translate, {0, -1, 0});
  is(5, MoveKind::translate, {0, 1, 0});
  is(6, MoveKind::translate, {1, 0, 0});
  is(7, MoveKind::translate, {-1, 0, 0});
  is(16, MoveKind::translate, {0, 0, 1});
  is(37, MoveKind::translate, {-1, 0, 0});
  is(23, MoveKind::rotate, {0, 1, 0});
  is(25, MoveKind::rotate, {1, 0, 0});
  is(48, MoveKind::rotate, {1, 0, 0});
  is(49, MoveKind::rotate, {0, 1, 0});
  is(50, MoveKind::rotate, {0, 0, 1});
  is(29, MoveKind::dilate, {0, 0, 0});
  is(47, MoveKind::roll, {0, 0, 0});
  is(0, MoveKind::none, {0, 0, 0});
  is(69, MoveKind::none, {0, 0, 0});
}

// The head rotates to where the name of the FAP says.
TEST(Fapu, RotationsAreRightHanded) {
  const auto turn = [](const Point& axis, const Point& p) {  // by 90 degrees: axis x p
    return Point{axis[1] * p[2] - axis[2] * p[1], axis[2] * p[0] - axis[0] * p[2],
                 axis[0] * p[1] - axis[1] * p[0]};
  };
  const Point gaze = {0, 0, 1};
  const Point crown = {0, 1, 0};
  EXPECT_EQ(turn(move_of(48).axis, gaze), (Point{0, -1, 0}));   // pitch: looks down
  EXPECT_EQ(turn(move_of(49).axis, gaze), (Point{1, 0, 0}));    // yaw: looks to the left
  EXPECT_EQ(turn(move_of(50).axis, crown), (Point{-1, 0, 0}));  // roll: tilts to the right
}

TEST(Fapu, MeasuresTheIctHead) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data (ANIMEME_SHARED)";
  const auto dir = test::shared_dir() / "spec" / "tables";
  std::ifstream csv(dir / "ict_feature_points.csv");
  ASSERT_TRUE(csv);
  FeaturePoints points;
  std::string line;
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    std::istringstream fields(line);
    std::string id, vertex, x, y, z;
    std::getline(fields, id, ',');
    std::getline(fields, vertex, ',');
    std::getline(fields, x, ',');
    std::getline(fields, y, ',');
    std::getline(fields, z, ',');
    points[id] = {std::stod(x), std::stod(y), std::stod(z)};
  }
  ASSERT_EQ(points.size(), 44u);
  const std::string text = test::slurp(dir / "ict_fapu.json");
  const auto expected = [&](const std::string& key) {
    return std::stod(text.substr(text.find("\"" + key + "\":") + key.size() + 3));
  };
  const Fapu fapu = measured(points);
  // The points are rounded to four decimals.
  EXPECT_NEAR(fapu.irisd, expected("IRISD0"), 1.01e-4);
  EXPECT_NEAR(fapu.es, expected("ES0"), 1.01e-4);
  EXPECT_NEAR(fapu.ens, expected("ENS0"), 1.01e-4);
  EXPECT_NEAR(fapu.mns, expected("MNS0"), 1.01e-4);
  EXPECT_NEAR(fapu.mw, expected("MW0"), 1.01e-4);
}

}  // namespace fapu_test
}  // namespace animeme::fap
