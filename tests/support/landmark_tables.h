// Tables of landmarks as trackers write them, of a made-up face that acts, and their import by the
// program.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "fap/tables.h"
#include "fap/text.h"
#include "tests/support/made_up_face.h"
#include "tests/support/program.h"

namespace animeme::test {

inline std::string number(double value, int digits = 7) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// Frame 0 is neutral; then the jaw opens, the left eye winks, the head turns.
inline fap::Frame acted(int i) {
  fap::Frame frame;
  frame.number = i;
  if (i == 0) return frame;
  frame.set(3, 20 * i);
  frame.set(5, -25 * i);
  frame.set(12, 11 * i);
  frame.set(19, i % 10 * 90);
  frame.set(31, 13 * i);
  frame.set(48, 900 * i);
  frame.set(49, -1100 * i);
  frame.set(50, 700 * i);
  return frame;
}

struct Imported {
  fap::Sequence clip;
  std::string talk;
};

inline Imported import(const std::string& table, std::vector<std::string> options) {
  const TempDir dir;
  spill(dir / "take.csv", table);
  std::vector<std::string> arguments = {"import", dir / "take.csv", "--exact", "-o",
                                        dir / "take.fap"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  auto clip = fap::read_text(test::slurp(dir / "take.fap"));
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().describe());
  return {clip ? *clip : fap::Sequence{}, result.err};
}

inline void expect_faps(const fap::Sequence& clip, std::initializer_list<int> faps,
                        double tolerance, const std::function<fap::Frame(int)>& want = acted) {
  for (const fap::Frame& frame : clip.frames) {
    for (const int fap : faps) {
      EXPECT_TRUE(frame.mask[std::size_t(fap)]) << fap;
      EXPECT_NEAR(frame.value[std::size_t(fap)], want(int(frame.number)).value[std::size_t(fap)],
                  fap >= 48 && fap <= 50 ? 40 * tolerance : tolerance)
          << "frame " << frame.number << " " << fap::info(fap).name;
    }
  }
}

// As OpenFace writes it: the head half a metre before a camera, whose x is right, y down, z away.
inline std::string openface(int rows, int digits = 7, double bad = 5) {
  std::string text = "frame, face_id, timestamp, confidence, success, gaze_0_x, gaze_0_y, gaze_0_z";
  text += ", gaze_1_x, gaze_1_y, gaze_1_z, gaze_angle_x, gaze_angle_y, eye_lmk_x_0, pose_Tx";
  text += ", pose_Ty, pose_Tz, pose_Rx, pose_Ry, pose_Rz";
  for (const char* axis : {"x", "y", "X", "Y", "Z"}) {
    for (int i = 0; i < 68; ++i) text += std::string(", ") + axis + "_" + std::to_string(i);
  }
  text += ", p_scale, p_0, AU01_r, AU12_c\n";
  for (int i = 0; i < rows; ++i) {
    const fap::Frame frame = acted(i);
    const bool good = i != int(bad);
    // The person's right eye looks straight ahead, the left one 0.2 to the left, in space.
    text +=
        std::to_string(i + 1) + ", 0, " + number(i / 30.0, 3) + (good ? ", 0.98, 1" : ", 0.1, 0");
    text += ", 0, 0, -1, " + number(std::sin(0.2)) + ", 0, " + number(-std::cos(0.2));
    text += ", 0.1, 0, 411.2, 0, 0, 500, " + number(frame.value[48] * 1e-5) + ", 0, 0";
    const Camera space{10, {3, -20, -500}, {1, -1, -1}};
    const Camera picture{22, {640, -360, 0}, {1, -1, 1}};
    std::vector<fap::Point> points[2];
    for (const fap::Point& point : landmarks_of(moved_face(frame), fap::LandmarkLayout::ibug68)) {
      points[0].push_back(picture(point, frame));
      points[1].push_back(space(point, frame));
    }
    for (std::size_t column = 0; column < 5; ++column) {
      for (const fap::Point& point : points[column < 2 ? 0 : 1]) {
        text += ", " + number(good ? point[column < 2 ? column : column - 2] : 0, digits);
      }
    }
    text += ", 3.1, 1.5, 0.2, 1\n";
  }
  return text;
}

// 68 points of a picture; the name of a column from its number and axis.
inline std::string sixty_eight(int rows, const std::function<std::string(int, char)>& name) {
  std::string text;
  for (int i = 0; i < 68; ++i) {
    text += (i == 0 ? "" : ";") + name(i, 'x') + ";" + name(i, 'y');
  }
  text += "\n";
  for (int row = 0; row < rows; ++row) {
    fap::Frame frame = acted(row);
    frame.value[48] = frame.value[49] = 0;
    bool first = true;
    for (const fap::Point& point : landmarks_of(moved_face(frame), fap::LandmarkLayout::ibug68)) {
      const fap::Point seen = Camera{30, {300, -200, 0}, {1, -1, 1}}(point, frame);
      text += (first ? "" : ";") + number(seen[0]) + ";" + number(seen[1]);
      first = false;
    }
    text += "\n";
  }
  return text;
}

// MediaPipe: shares of a picture of 1280x720, z as x and negative towards the camera.
inline std::string mediapipe(int rows, int points, double width = 1280, double height = 720) {
  std::string text = "time_s";
  for (int i = 0; i < points; ++i) {
    for (const char* axis : {",x_", ",y_", ",z_"}) text += axis + std::to_string(i);
  }
  text += "\n";
  for (int row = 0; row < rows; ++row) {
    const fap::Frame frame = acted(row);
    const auto all = landmarks_of(moved_face(frame), fap::LandmarkLayout::mediapipe);
    text += number(row / 25.0, 3);
    for (int i = 0; i < points; ++i) {
      const fap::Point seen =
          Camera{20, {width / 2, -height / 2, 0}, {1, -1, -1}}(all[std::size_t(i)], frame);
      text += "," + number(seen[0] / width, 9) + "," + number(seen[1] / height, 9) + "," +
              number(seen[2] / width, 9);
    }
    text += "\n";
  }
  return text;
}

}  // namespace animeme::test
