/// @file
/// How much each parameter of a clip moves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "codec/text/bap_text.h"
#include "fap/frame.h"

namespace animeme::inspect {

/// The parameters that occur.
template <class Frame>
auto used_mask(const std::vector<Frame>& frames) {
  decltype(Frame().mask) used;
  for (const Frame& frame : frames) used |= frame.mask;
  return used;
}

/// One FAP or BAP as a receiver sees it: omitted values persist.
struct Activity {
  int number = 0;            ///< of the FAP or BAP
  std::int64_t frames = 0;   ///< frames that carry it
  bool is_amount = true;     ///< false for FAP 1 and 2, whose values are selections
  std::int32_t min = 0;      ///< amounts only
  std::int32_t max = 0;      ///< amounts only
  double rms_speed = 0;      ///< amounts only: units a second, from frame to frame
  std::size_t distinct = 0;  ///< different values
  double moves = 0;          ///< share of the frames after the first in which it changes, 0..1
  std::vector<int>
      equal_to;  ///< left/right and inner/outer partners that always have the same value

  bool never_moves() const { return distinct <= 1; }  ///< constant
};

/// Measures frame by frame. Memory grows only with the number of different values.
class FaceActivity {
 public:
  FaceActivity();
  ~FaceActivity();
  void add(const fap::Frame& frame);  ///< with ascending numbers
  /// Those that occurred, by number.
  std::vector<Activity> measured(fap::Rate rate) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for bodies.
class BodyActivity {
 public:
  BodyActivity();
  ~BodyActivity();
  void add(const fba::BodyFrame& frame);                 ///< with ascending numbers
  std::vector<Activity> measured(fap::Rate rate) const;  ///< those that occurred, by number

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Measures a whole clip.
std::vector<Activity> measure_activity(const fap::Sequence& clip);
std::vector<Activity> measure_activity(const fba::BodySequence& body);  ///< measures BAPs

}  // namespace animeme::inspect
