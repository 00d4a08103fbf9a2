#include "fap/detail/text_frame.h"

#include <array>
#include <string>
#include <utility>

#include "fap/detail/text_parameters.h"

namespace animeme::fap::detail {
namespace {

constexpr int kVisemeValues = 4;
constexpr int kExpressionValues = 6;

ParameterReader::Needs needs_of(const Mask& mask) {
  const int high = int(mask[1]) + int(mask[2]);
  const int low = int(mask.count()) - high;
  const int full = low + (mask[1] ? kVisemeValues : 0) + (mask[2] ? kExpressionValues : 0);
  return {1 + full, 1 + low + high};
}

class FrameReader {
 public:
  FrameReader(TextScanner& scanner, TextNotes& notes) : in_(kFapDialect, scanner, notes) {}

  Result<std::int64_t> read(Frame& frame) {
    const bool ok =
        read_mask(frame.mask) && in_.find_values(needs_of(frame.mask)) && read_values(frame);
    if (!ok) return std::move(in_).error();
    return in_.number_line();
  }

 private:
  bool read_mask(Mask& mask) {
    std::array<std::uint8_t, kFapCount> flags{};
    if (!in_.read_mask(flags)) return false;
    for (std::size_t i = 0; i < flags.size(); ++i) mask[i + 1] = flags[i] != 0;
    return true;
  }

  bool read_values(Frame& frame) {
    if (!in_.frame_number(frame.number)) return false;
    if (frame.mask[1] && !read_viseme(frame.viseme)) return false;
    if (frame.mask[2] && !read_expression(frame.expression)) return false;
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frame.mask[fap] && !in_.value(frame.value[fap])) return false;
    }
    return true;
  }

  bool read_viseme(Viseme& v) {
    if (in_.single()) {
      v.blend = 63;
      return in_.value(v.select1) && check_range(v.select1, 14);
    }
    return in_.value(v.select1) && check_range(v.select1, 14) && in_.value(v.select2) &&
           check_range(v.select2, 14) && in_.value(v.blend) && check_range(v.blend, 63) &&
           flag(v.def);
  }

  bool read_expression(Expression& e) {
    if (in_.single()) {
      e.intensity1 = 63;
      return in_.value(e.select1) && check_range(e.select1, 6);
    }
    return in_.value(e.select1) && check_range(e.select1, 6) && in_.value(e.intensity1) &&
           check_range(e.intensity1, 63) && in_.value(e.select2) && check_range(e.select2, 6) &&
           in_.value(e.intensity2) && check_range(e.intensity2, 63) && flag(e.init_face) &&
           flag(e.def);
  }

  // Always true: values outside the ranges of the standard are kept.
  bool check_range(std::int32_t v, std::int32_t highest) {
    if (v >= 0 && v <= highest) return true;
    in_.notes().add(Quirk::high_level_range, in_.line(), [&] {
      return "a value of FAP 1 or 2 is " + std::to_string(v) + ", allowed are 0 to " +
             std::to_string(highest);
    });
    return true;
  }

  bool flag(bool& out) {
    std::int32_t v = 0;
    if (!in_.value(v)) return false;
    out = v != 0;
    return check_range(v, 1);
  }

  ParameterReader in_;
};

}  // namespace

Result<std::int64_t> read_frame(TextScanner& scanner, TextNotes& notes, Frame& frame) {
  return FrameReader(scanner, notes).read(frame);
}

void merge_frames(Frame& into, const Frame& later) {
  into.mask |= later.mask;
  if (later.mask[1]) into.viseme = later.viseme;
  if (later.mask[2]) into.expression = later.expression;
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (later.mask[fap]) into.value[fap] = later.value[fap];
  }
}

}  // namespace animeme::fap::detail
