#include "tools/view/studio/frames.h"

#include <algorithm>
#include <optional>

namespace animeme::studio {
namespace {

std::optional<Error> check_clip(const fap::Sequence& clip) {
  if (!clip.frames.empty()) return std::nullopt;
  return make_error(Code::not_found, "there is no frame to show");
}

ShownFrame shown(const fap::Sequence& clip, const fap::Frame& frame) {
  return {frame, clip.rate.seconds(double(frame.number))};
}

}  // namespace

Result<std::vector<ShownFrame>> frames_at(const fap::Sequence& clip,
                                          const std::vector<double>& times) {
  if (auto error = check_clip(clip)) return std::move(*error);
  std::vector<ShownFrame> result;
  for (const double time : times) {
    const fap::Frame* last = nullptr;
    for (const fap::Frame& frame : clip.frames) {
      if (clip.rate.seconds(double(frame.number)) <= time + 1e-9) last = &frame;
    }
    if (last == nullptr || time > clip.duration()) {
      return make_error(Code::out_of_range, "there is no frame at " + std::to_string(time) +
                                                " s; the clip lasts " +
                                                std::to_string(clip.duration()) + " s");
    }
    result.push_back(shown(clip, *last));
  }
  return result;
}

Result<std::vector<ShownFrame>> frame_number(const fap::Sequence& clip, std::int64_t number) {
  if (auto error = check_clip(clip)) return std::move(*error);
  for (const fap::Frame& frame : clip.frames) {
    if (frame.number == number) return std::vector{shown(clip, frame)};
  }
  return make_error(Code::out_of_range, "there is no frame " + std::to_string(number) +
                                            "; the clip has frames " +
                                            std::to_string(clip.frames.front().number) + " to " +
                                            std::to_string(clip.frames.back().number));
}

Result<std::vector<ShownFrame>> even_frames(const fap::Sequence& clip, int count) {
  if (auto error = check_clip(clip)) return std::move(*error);
  std::vector<ShownFrame> result;
  const std::size_t last = clip.frames.size() - 1;
  const auto steps = std::size_t(std::max(count - 1, 1));
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    result.push_back(shown(clip, clip.frames[(last * i + steps / 2) / steps]));
  }
  return result;
}

void say_in(std::vector<ShownFrame>& frames, const fap::Sequence& clip,
            std::span<const fap::VisemeWeights> visemes) {
  for (ShownFrame& shown : frames) {
    const auto at = std::lower_bound(
        clip.frames.begin(), clip.frames.end(), shown.frame.number,
        [](const fap::Frame& frame, std::int64_t number) { return frame.number < number; });
    const auto i = std::size_t(at - clip.frames.begin());
    if (i < std::min(visemes.size(), clip.frames.size()) && at->number == shown.frame.number) {
      shown.visemes = visemes[i];
    }
  }
}

Result<std::vector<ShownFrame>> shape_frames(const std::string& what) {
  std::vector<ShownFrame> result(1);
  if (what == "visemes") {
    for (int i = 1; i <= 14; ++i) {
      ShownFrame shape;
      shape.frame.mask.set(1);
      shape.frame.viseme = {i, 0, 63, false};
      result.push_back(shape);
    }
  } else if (what == "expressions") {
    for (int i = 1; i <= 6; ++i) {
      ShownFrame shape;
      shape.frame.mask.set(2);
      shape.frame.expression.select1 = i;
      shape.frame.expression.intensity1 = 63;
      result.push_back(shape);
    }
  } else {
    return make_error(Code::invalid_argument,
                      "shapes are visemes or expressions, not \"" + what + "\"");
  }
  return result;
}

}  // namespace animeme::studio
