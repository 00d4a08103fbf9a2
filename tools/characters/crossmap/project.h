/// @file
/// The settings of a cross-mapping: recordings of points, key shapes, a character. From a TOML
/// file, or from the equivalent options of `animeme crossmap`.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dam/crossmap/blend.h"
#include "dam/crossmap/key_shapes.h"
#include "dam/crossmap/retarget.h"
#include "fap/result.h"

/// Retargeting of captured lips to the controls of any character.
namespace animeme::crossmap {

/// A key shape that the artist chose.
struct NamedKey {
  std::string name;    ///< empty: "key3", by its position
  std::string input;   ///< one of Project::inputs; empty: the first
  double seconds = 0;  ///< in that recording
};

/// Points whose residual is reported together.
struct NamedRegion {
  std::string name;                 ///< for people
  std::vector<std::string> points;  ///< names of captured points
  double weight = 1;                ///< of each of them in the fit, 0 or more
};

/// All settings. Empty and 0 select the defaults listed in this folder's README.
struct Project {
  std::vector<std::string> inputs;  ///< tables of points or C3D files; they share their key shapes

  std::string rate;                 ///< frames a second, if the file has no rate
  std::string size;                 ///< "1280x720": points are fractions of this size
  std::string layout;               ///< "68" or "mediapipe": layout of numbered points
  std::string axes;                 ///< "left down back": where x, y and z point to
  std::string unit;                 ///< of lengths: mm, cm, m or in
  std::string neutral;              ///< a file of points, or seconds of the first input ("0-0.4s")
  std::vector<std::string> points;  ///< points to fit
  std::vector<std::string>
      head;  ///< points that do not move with the face; "none": the head is still
  std::vector<std::pair<std::string, std::string>> face;      ///< feature point and captured point
  std::map<std::string, double> fapu;                         ///< "MW": units of the points
  std::vector<NamedRegion> regions;                           ///< upper lip, corners ...
  std::vector<std::pair<std::string, std::string>> contacts;  ///< points that meet

  dam::KeyShapeOptions search;  ///< search for key shapes if none are given
  std::vector<NamedKey> named;  ///< key shapes by time
  std::string keys;             ///< folder with keys.csv of write_keys()

  dam::BlendOptions fit;              ///< its weights and contacts come from the above
  dam::RetargetOptions controls_fit;  ///< of the character's controls

  /// "faps", "arkit", "keys", a table of controls (.csv) or a head (.glb, .obj, woman ...).
  std::string to = "faps";
  std::string head_points;            ///< list of feature points of the head
  std::vector<std::string> shapes;    ///< OBJ files: what each control of an OBJ head does at 1
  std::vector<std::string> controls;  ///< controls that may move; empty: all
};

/// Reads a project. Paths are relative to `folder`; "" leaves them as they are. This folder's
/// README lists all keys. Errors, with line and column: syntax (invalid TOML; an unknown key; a
/// value of a wrong type).
Result<Project> read_project(std::string_view toml, const std::string& folder);

}  // namespace animeme::crossmap
