// A face of our own with all feature points, moved by FAPs as the standard has it: what a perfect
// tracker would see.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "fap/fapu.h"
#include "fap/frame.h"
#include "fap/landmarks.h"
#include "fap/tables.h"

namespace animeme::test {

using fap::FeaturePoints;
using fap::Point;

/// The neutral face, about 20 cm high in centimetres. Left and right are mirror images.
inline FeaturePoints made_up_face() {
  FeaturePoints face = {
      {"2.1", {0, -7.6, 10.2}},  {"2.2", {0, -3.4, 11}},    {"2.3", {0, -3.45, 10.9}},
      {"2.10", {0, -6.2, 10.8}}, {"6.1", {0, -3.5, 9.5}},   {"6.2", {0, -3.7, 8}},
      {"7.1", {0, -2, -1}},      {"8.1", {0, -2.6, 11.6}},  {"8.2", {0, -4.5, 11.3}},
      {"9.3", {0, 0.3, 12.8}},   {"9.8", {0, -2.4, 10.4}},  {"9.9", {0, -4.9, 10.2}},
      {"9.10", {0, -3.3, 10.5}}, {"9.11", {0, -3.5, 10.3}}, {"9.12", {0, 2.4, 11.2}},
      {"9.15", {0, -1.3, 11.4}}, {"11.1", {0, 9.4, 9.2}},   {"11.4", {0, 12, 0}},
      {"11.5", {0, 13, 0}},      {"11.6", {0, 4, -9}},      {"nasion", {0, 3.9, 10.4}}};
  struct Sides {
    const char* left;
    const char* right;
    Point place;  // of the left one
  };
  const Sides sides[] = {{"2.4", "2.5", {2.1, -3.45, 10}},   {"2.6", "2.7", {1.05, -3.38, 10.7}},
                         {"2.8", "2.9", {1.05, -3.5, 10.6}}, {"2.11", "2.12", {1.3, -7.3, 9.9}},
                         {"2.13", "2.14", {5.6, -5.1, 4.2}}, {"3.1", "3.2", {3.1, 3.95, 9.3}},
                         {"3.3", "3.4", {3.1, 2.85, 9.2}},   {"3.5", "3.6", {3.1, 3.4, 9}},
                         {"3.7", "3.12", {4.6, 3.3, 8.3}},   {"3.11", "3.8", {1.7, 3.2, 8.9}},
                         {"3.9", "3.10", {3.9, 2.9, 8.9}},   {"3.13", "3.14", {3.9, 3.8, 8.9}},
                         {"4.1", "4.2", {1.3, 5.6, 10.2}},   {"4.3", "4.4", {3.6, 6.1, 9.6}},
                         {"4.5", "4.6", {5.7, 5.2, 7.9}},    {"5.1", "5.2", {5.2, -3, 8}},
                         {"5.3", "5.4", {4.9, 0.8, 9}},      {"6.3", "6.4", {0.9, -3.6, 8.3}},
                         {"8.3", "8.4", {2.5, -3.45, 9.9}},  {"8.5", "8.6", {1.3, -2.8, 11.1}},
                         {"8.7", "8.8", {1.3, -4.2, 10.8}},  {"8.10", "8.9", {0.7, -2.5, 11.5}},
                         {"9.1", "9.2", {1.3, -1.1, 10.7}},  {"9.5", "9.4", {0.8, -1.2, 11.1}},
                         {"9.7", "9.6", {0.6, 3.6, 10.2}},   {"9.13", "9.14", {0.7, 2.2, 10.6}},
                         {"10.1", "10.2", {7.2, 3.6, 1.5}},  {"10.3", "10.4", {7.6, 2, 0}},
                         {"10.5", "10.6", {7, -1.5, 1.8}},   {"10.7", "10.8", {6.9, -0.5, 2}},
                         {"10.9", "10.10", {6.8, 3.2, 2.2}}, {"11.3", "11.2", {5.5, 7, 5}}};
  for (const Sides& side : sides) {
    face[side.left] = side.place;
    face[side.right] = {-side.place[0], side.place[1], side.place[2]};
  }
  return face;
}

/// FAPs that points of a face show.
inline bool shows_in_points(int number) {
  const fap::MoveKind kind = fap::move_of(number).kind;
  if (number == 27 || number == 28) return false;  // depth of the eyeballs
  return kind == fap::MoveKind::translate || kind == fap::MoveKind::rotate;
}

/// The face with the FAPs of a frame (3 to 26 and 31 to 68, what is absent is 0), but for the turn
/// of the head. Pupils turn about a centre that lies 0.18 ES behind them.
inline FeaturePoints moved_face(const fap::Frame& frame) {
  const FeaturePoints rest = made_up_face();
  const fap::Fapu fapu = *fap::measure_fapu(rest);
  FeaturePoints face = rest;
  for (const fap::FapInfo& info : fap::kFaps) {
    const fap::Move move = fap::move_of(info.number);
    const auto point = face.find(info.feature_point);
    if (move.kind != fap::MoveKind::translate || point == face.end()) continue;
    const double way = fap::displacement(info.number, frame.value[std::size_t(info.number)], fapu);
    for (std::size_t k = 0; k < 3; ++k) point->second[k] += way * move.axis[k];
  }
  for (int eye = 0; eye < 2; ++eye) {
    const double yaw = frame.value[std::size_t(23 + eye)] * 1e-5;
    const double pitch = frame.value[std::size_t(25 + eye)] * 1e-5;
    Point& pupil = face.find(eye == 0 ? "3.5" : "3.6")->second;
    const double radius = 0.18 * fapu.es;
    pupil[0] += radius * std::sin(yaw) * std::cos(pitch);
    pupil[1] -= radius * std::sin(pitch);
    pupil[2] += radius * (std::cos(yaw) * std::cos(pitch) - 1);
  }
  return face;
}

/// Where the camera sees a head: turned by FAP 48 to 50 of the frame, then scaled and shifted.
struct Camera {
  double scale = 1;
  Point shift{};
  std::array<int, 3> sign = {1, 1, 1};  ///< of the axes: {1, -1, 1} for y down

  Point operator()(const Point& p, const fap::Frame& frame) const {
    const double pitch = frame.value[48] * 1e-5;
    const double yaw = frame.value[49] * 1e-5;
    const double roll = frame.value[50] * 1e-5;
    const Point a = {p[0] * std::cos(roll) - p[1] * std::sin(roll),
                     p[0] * std::sin(roll) + p[1] * std::cos(roll), p[2]};
    const Point b = {a[0], a[1] * std::cos(pitch) - a[2] * std::sin(pitch),
                     a[1] * std::sin(pitch) + a[2] * std::cos(pitch)};
    const Point c = {b[0] * std::cos(yaw) + b[2] * std::sin(yaw), b[1],
                     b[2] * std::cos(yaw) - b[0] * std::sin(yaw)};
    Point out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = sign[k] * (scale * c[k] + shift[k]);
    return out;
  }
};

/// Landmarks of a layout whose feature points are those of the face; those of no feature point
/// are 0.
inline std::vector<Point> landmarks_of(const FeaturePoints& face, fap::LandmarkLayout layout) {
  std::vector<Point> out(layout == fap::LandmarkLayout::ibug68 ? 68 : 478);
  std::vector<bool> known(out.size(), false);
  const auto set = [&](int landmark, const Point& place) {
    out[std::size_t(landmark)] = place;
    known[std::size_t(landmark)] = true;
  };
  for (const fap::LandmarkSource& source : fap::landmark_sources(layout)) {
    if (source.second < 0) set(source.landmark, face.find(source.point)->second);
  }
  for (const fap::LandmarkSource& source : fap::landmark_sources(layout)) {
    if (source.second < 0) continue;
    const Point& place = face.find(source.point)->second;
    const bool second = known[std::size_t(source.second)];
    const int given = second ? source.second : source.landmark;
    if (!known[std::size_t(given)]) set(given, {place[0] + 0.3, place[1] - 0.05, place[2]});
    const Point& one = out[std::size_t(given)];
    set(second ? source.landmark : source.second,
        {2 * place[0] - one[0], 2 * place[1] - one[1], 2 * place[2] - one[2]});
  }
  return out;
}

}  // namespace animeme::test
