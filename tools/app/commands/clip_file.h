/// @file
/// What there is to code: a face, a body or both, from one or two inputs, frame by frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "codec/encode/long_clip.h"
#include "codec/text/bap_text.h"
#include "fap/result.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"

namespace animeme::tools {

/// Face and body of one stream have one rate; an EPF does not care.
enum class ClipRates : std::uint8_t { equal, any };

/// A clip. FAP text and intact streams in files are read again as often as wanted; other inputs are
/// in memory.
class ClipFile {
 public:
  /// `input`: any input with motion; `bap`: a body, in place of that of the input. One of them may
  /// be empty. Errors, with the path: those of read_motion(); not_found (nothing of that kind in
  /// it); invalid_argument (face and body have different rates,
  /// which `rates` does not allow).
  static Result<ClipFile> open(const std::string& input, const std::string& bap, ClipRates rates);

  fap::Rate rate() const { return rate_; }  ///< frames per second
  /// The clip, under the frame numbers of the inputs. Borrows this object.
  fba::ClipSource source() const;
  /// How many frames the last reading of the source went over, skipped ones included.
  std::int64_t frames() const { return last_ - first_ + 1; }

 private:
  ClipFile() = default;
  Result<void> open_face(const std::string& input, bool has_other_body);
  bool open_stream(const std::string& input, bool has_other_body);
  Result<void> each(const fba::TakeInstant& take) const;
  Result<void> each_instant(const fba::TakeInstant& take) const;

  std::optional<FapFile> text_;
  std::optional<PlaneFile> stream_;
  bool bodies_of_stream_ = false;
  fap::Sequence face_;      // in memory
  fba::BodySequence body_;  // likewise
  fap::Rate rate_;
  mutable std::int64_t first_ = 0, last_ = -1;
};

}  // namespace animeme::tools
