/// @file
/// The frames of the inputs of edit one after the other, so that no clip has to be in memory.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/resample.h"
#include "fap/result.h"
#include "tools/app/commands/edit_source.h"

namespace animeme::tools {

/// What has to be known of a source before its first frame.
struct EditExtent {
  fap::Mask face;               ///< of its complete face (fap/fill.h)
  std::int64_t last_face = -1;  ///< number of the last frame with a face; -1: there is none
  std::bitset<fba::kBapCount + 1> body;  ///< the BAPs that occur
  std::int64_t first_body = -1;  ///< number of the first frame with a body; -1: there is none

  bool has_face() const { return last_face >= 0; }   ///< somewhere
  bool has_body() const { return first_body >= 0; }  ///< somewhere
};

/// Reads a source once. Errors, with the path: io; those of fap::fill() for numbers that do not
/// ascend and for more missing frames than it fills in.
Result<EditExtent> extent_of(const EditSource& source);

/// The complete face of a cut: held over planes that are left out, and at both ends.
class FaceFrames {
 public:
  /// Of a source with a face. Its frames are shown at `played`, and given at `rate`: interpolated
  /// as fap::Resampler does. Source and extent outlive the reader.
  FaceFrames(const EditCut& cut, const EditExtent& extent, fap::Rate played, fap::Rate rate);
  FaceFrames(FaceFrames&&) noexcept;  ///< movable
  ~FaceFrames();

  /// The next frame, numbered from 0, good until the next call; null behind the last one. Errors,
  /// with the path: io, and those of a file that has changed since extent_of().
  Result<const fap::Frame*> next();

  /// How many there are.
  static std::int64_t count(const EditCut& cut, fap::Rate played, fap::Rate rate);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The body of a cut, likewise; each frame has all BAPs of the source.
class BodyFrames {
 public:
  /// As FaceFrames, of a source with a body. Between frames values are interpolated linearly.
  BodyFrames(const EditCut& cut, const EditExtent& extent, fap::Rate played, fap::Rate rate);
  BodyFrames(BodyFrames&&) noexcept;  ///< movable
  ~BodyFrames();

  /// As FaceFrames::next().
  Result<const fba::BodyFrame*> next();

  /// How many there are.
  static std::int64_t count(const EditCut& cut, fap::Rate played, fap::Rate rate);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::tools
