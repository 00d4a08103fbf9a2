#include "tools/commands/landmark_import.h"

#include <cmath>
#include <cstdio>

namespace animeme::tools {

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

std::string rounded_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string talk_of(const fap::LandmarkTrack& track, const fap::LandmarkFace& face, bool given) {
  const auto& frames = face.neutral_frames;
  std::string text =
      std::string(track.depth ? "points in space" : "points in the picture") + ", neutral face " +
      (given ? "given" : "found") + " in " + std::to_string(frames.size()) +
      (frames.size() == 1 ? " frame, " : " frames, ") + std::to_string(frames.front());
  if (frames.size() > 1) text += " to " + std::to_string(frames.back());
  return text + "; its units: IRISD " + rounded_text(face.fapu.irisd) + ", ES " +
         rounded_text(face.fapu.es) + ", ENS " + rounded_text(face.fapu.ens) + ", MNS " +
         rounded_text(face.fapu.mns) + ", MW " + rounded_text(face.fapu.mw);
}

}  // namespace

Result<LandmarkImport> import_landmarks(std::string_view text, const LandmarkImportOptions& options,
                                        std::vector<std::string>& warnings) {
  const auto track = read_landmark_csv(text, options.table, warnings);
  if (!track) return track.error();
  const auto neutral = neutral_frames(*track, options.neutral);
  if (!neutral) return neutral.error();
  fap::LandmarkOptions settings = options.face;
  settings.neutral = *neutral;
  Result<fap::LandmarkFace> face = landmarks_to_fap(*track, settings);
  if (!face) return std::move(face).error();
  if (face->lost > 0) {
    warnings.push_back("frames whose head was not found, left out: " + std::to_string(face->lost));
  }
  if (face->head_error > kShakyHead) {
    warnings.push_back("points that should keep their place on the head are off by " +
                       rounded_text(100 * face->head_error) +
                       " % of the distance of the eyes: the tracking is poor, or the head turns in "
                       "a picture without depth");
  }
  return LandmarkImport{std::move(face->clip), talk_of(*track, *face, !neutral->empty())};
}

}  // namespace animeme::tools
