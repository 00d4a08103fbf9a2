#include <cmath>
#include <cstdio>

#include "dam/script/table_text_internal.h"
#include "tools/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

constexpr double kShakyHead = 0.05;  // of ES, about 3 mm

struct Part {
  double first = 0;
  double last = 0;
  bool seconds = false;
};

std::optional<Part> parse_part(std::string_view text) {
  Part part;
  if (text.ends_with('s')) {
    part.seconds = true;
    text.remove_suffix(1);
  }
  const std::size_t dash = text.find('-');
  std::string_view first = text.substr(0, dash);
  if (dash != std::string_view::npos && part.seconds && first.ends_with('s')) {
    first.remove_suffix(1);
  }
  const auto a = dam::parse_number(first);
  const auto b = dash == std::string_view::npos ? a : dam::parse_number(text.substr(dash + 1));
  if (!a || !b || !(*a >= 0) || !(*b >= *a) || !std::isfinite(*b)) return std::nullopt;
  part.first = *a;
  part.last = *b;
  return part;
}

Result<std::vector<std::size_t>> neutral_frames(const fap::LandmarkTrack& track,
                                                const std::string& text) {
  if (text.empty()) return std::vector<std::size_t>();
  const std::optional<Part> part = parse_part(text);
  if (!part) {
    return make_error(Code::invalid_argument, "--neutral: '" + text +
                                                  "' is no part of a clip; write frames (12 or "
                                                  "0-24) or seconds (1.5s or 0.5-1.2s)");
  }
  // A time is that of the frame that is shown then.
  const double scale = part->seconds ? track.rate.frames_per_second() : 1;
  const double first = std::floor(part->first * scale + 1e-6);
  const double last = std::floor(part->last * scale + 1e-6);
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    const double number = double(track.frames[i].number);
    if (number >= first && number <= last) frames.push_back(i);
  }
  if (!frames.empty()) return frames;
  return make_error(Code::invalid_argument,
                    "--neutral: the recording has no face at " + text + "; its frames are " +
                        std::to_string(track.frames.front().number) + " to " +
                        std::to_string(track.frames.back().number));
}

}  // namespace

std::optional<PictureSize> parse_picture_size(std::string_view text) {
  const std::size_t cross = text.find_first_of("xX:");
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = dam::parse_number(text.substr(0, cross));
  const auto height = dam::parse_number(text.substr(cross + 1));
  if (!width || !height || !(*width > 0 && *width < 1e6 && *height > 0 && *height < 1e6)) {
    return std::nullopt;
  }
  return PictureSize{*width, *height};
}

Result<LandmarkImport> import_landmarks(std::string_view text,
                                        const LandmarkImportOptions& options) {
  auto table = read_landmark_table(text, options.table);
  if (!table) return table.error();
  const auto neutral = neutral_frames(table->track, options.neutral);
  if (!neutral) return neutral.error();
  fap::LandmarkOptions settings = options.face;
  settings.neutral = *neutral;
  auto face = fap::landmarks_to_fap(table->track, settings);
  if (!face) return std::move(face).error();
  if (face->clip.frames.empty()) {
    return make_error(Code::not_found, "the head was not found in any frame");
  }
  LandmarkImport out{std::move(*face), table->track.depth, std::move(table->warnings)};
  if (out.face.lost > 0) {
    out.warnings.push_back("frames whose head was not found, left out: " +
                           std::to_string(out.face.lost));
  }
  if (out.face.head_error > kShakyHead) {
    char share[40];
    std::snprintf(share, sizeof share, "%.4g", 100 * out.face.head_error);
    out.warnings.push_back("points that should keep their place on the head are off by " +
                           std::string(share) +
                           " % of the distance of the eyes: the tracking is poor, or the head "
                           "turns in a picture without depth");
  }
  return out;
}

}  // namespace animeme::exchange
