/// @file
/// Changes of motion by edit: what needs the planes to be coded again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/encode/long_clip.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/app/commands/edit_frames.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/edit_source.h"

namespace animeme::tools {

/// What is changed, in this order.
struct EditChanges {
  double speed = 1;                ///< of the motion
  double cross_fade = 0;           ///< seconds, at joints and where a taken part ends
  std::int64_t hold = 0;           ///< frames for which the first one is held, at `rate`
  bool mirror = false;             ///< left and right
  std::vector<EditTake> takes;     ///< parts of other files; no rest
  std::vector<EditAmount> scale;   ///< factors
  std::vector<EditAmount> smooth;  ///< seconds
  double fade_in = 0;              ///< seconds
  double fade_out = 0;             ///< seconds

  /// Some value changes.
  bool any() const {
    return speed != 1 || cross_fade > 0 || mirror || !takes.empty() || !scale.empty() ||
           !smooth.empty() || fade_in > 0 || fade_out > 0;
  }
};

/// Cuts that are joined at a rate and changed: a face and a body, complete frame by frame. They are
/// read again each time they are wanted. Memory: about a megabyte, the first seconds of a cut for
/// which it is cross-faded, and of a smoothed face six times as many seconds as are smoothed.
class EditedMotion {
 public:
  /// Reads each source once. The sources of the cuts outlive it. Errors: those of extent_of(), and
  /// of open_edit_source() for files of takes; not_found (a file does not have what is taken).
  static Result<EditedMotion> open(std::vector<EditCut> cuts, fap::Rate rate, EditChanges changes);
  EditedMotion(EditedMotion&&) noexcept;  ///< movable
  EditedMotion& operator=(EditedMotion&&) noexcept;
  ~EditedMotion();

  fap::Rate rate() const;           ///< frames per second
  const std::string& name() const;  ///< of the first source
  std::int64_t faces() const;       ///< frames with a face, from 0 on; 0: there is none
  std::int64_t bodies() const;      ///< likewise with a body
  /// Hands over all frames, numbered from 0, each time it is called. Errors: io, those of `take`.
  Result<void> each(const fba::TakeInstant& take) const;

 private:
  struct Impl;
  explicit EditedMotion(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::tools
