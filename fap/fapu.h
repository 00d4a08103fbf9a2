/// @file
/// FAP units: how far a FAP value moves a point of a given face. Source: fap/semantics.md, sections
/// 1 and 2.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "fap/result.h"
#include "fap/tables.h"

namespace animeme::fap {

/// x, y, z in model units, right-handed: +X to the person's left, +Y up, +Z forward (gaze).
using Point = std::array<double, 3>;

/// Positions of feature points on the neutral face by their id ("2.1", see kFeaturePoints).
using FeaturePoints = std::map<std::string, Point, std::less<>>;

/// The five distances on the neutral face that FAPs are measured in; model units, all > 0. One FAP
/// step is 1/1024 of them.
struct Fapu {
  double irisd = 0;  ///< iris diameter = opening of the lids: 3.1.y - 3.3.y
  double es = 0;     ///< eye separation, pupil to pupil: 3.5.x - 3.6.x
  double ens = 0;    ///< eye to nose: 3.5.y - 9.15.y
  double mns = 0;    ///< mouth to nose: 9.15.y - 2.2.y
  double mw = 0;     ///< mouth width: 8.3.x - 8.4.x

  friend bool operator==(const Fapu&, const Fapu&) = default;
};

/// Measures a face. Required are 3.1 and 3.3 (or 3.2 and 3.4), 9.15, 2.2, 8.3 and 8.4. Without the
/// pupils, ES is measured between the upper lids (3.1, 3.2), else the lower ones (3.3, 3.4), and
/// the height of the eyes is that of 3.6, else the mean of the available lid points.
///
/// Errors: Code::not_found names every missing point and the unit that needs it;
/// Code::invalid_argument names a unit that is not positive and finite (the model faces another
/// way, or left and right are swapped).
Result<Fapu> measure_fapu(const FeaturePoints& points);

/// Effect of a FAP on its feature point, or on the eyeball or head.
enum class MoveKind : std::uint8_t {
  none,       ///< FAP 1 and 2: no movement of their own
  translate,  ///< along the axis, in model units
  rotate,     ///< about the axis, right-handed, in rad
  dilate,     ///< growth of the pupil's diameter in model units; no axis
  roll,       ///< tongue into a U, in rad; no axis
};

/// How a FAP moves its feature point for positive values.
struct Move {
  MoveKind kind = MoveKind::none;  ///< translation, rotation or other change
  Point axis = {0, 0, 0};          ///< unit vector; zero if the kind has none
};

/// Kind and axis of positive values of FAP 1..68. Rotations (eyeballs and head): pitch down is
/// about +X, yaw left about +Y, roll right about +Z. The standard's order of the three head
/// rotations is unknown; Greta turns yaw outermost, then pitch, then roll.
Move move_of(int fap);

/// Size of one step of FAP 3..68: model units, or rad for angles (1e-5). 0 for any other number.
double step_size(int fap, const Fapu& fapu);

/// Displacement or angle of `value`: model units along the axis, or rad. 0 if step_size() is 0.
double displacement(int fap, double value, const Fapu& fapu);

/// The inverse of displacement(), not rounded. 0 if step_size() is 0.
double fap_value(int fap, double amount, const Fapu& fapu);

}  // namespace animeme::fap
