#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/script/table_text_internal.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/landmarks.h"

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
                                                  "' is not a part of a clip; write frames (12 or "
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

std::vector<std::size_t> frames_numbered(const fap::LandmarkTrack& track,
                                         const std::vector<std::int64_t>& numbers) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    if (std::binary_search(numbers.begin(), numbers.end(), track.frames[i].number)) {
      frames.push_back(i);
    }
  }
  return frames;
}

void tell_repairs(const Repairs& repairs, std::vector<std::string>& warnings) {
  const auto tell = [&](std::size_t count, const std::string& what) {
    if (count > 0) warnings.push_back(what + std::to_string(count));
  };
  tell(repairs.glitches, "frames in which the face jumped away and back, dropped: ");
  tell(repairs.slips, "points that jumped away and back, dropped: ");
  tell(repairs.filled_frames, "frames without a face, interpolated: ");
  tell(repairs.filled_points, "missing points, interpolated: ");
  if (repairs.gaps == 0) return;
  char text[120];
  std::snprintf(text, sizeof text,
                "gaps of more than 0.2 s, not repaired: %zu, the longest of %.3g s", repairs.gaps,
                repairs.longest_gap);
  warnings.emplace_back(text);
}

// Points without which a neutral face can neither be found nor measured have to come from a file.
Error with_remedy(Error error, const fap::LandmarkTrack& track,
                  const fap::LandmarkOptions& options) {
  if (options.rest || error.code != Code::not_found) return error;
  const auto has = [&](const char* id) {
    return std::find(track.points.begin(), track.points.end(), id) != track.points.end();
  };
  std::vector<std::string> missing;
  for (const char* id : {"2.2", "2.3", "8.3", "8.4", "9.15"}) {
    if (!has(id)) missing.emplace_back(id);
  }
  if (!(has("3.1") && has("3.3")) && !(has("3.2") && has("3.4"))) {
    missing.emplace_back("3.1 and 3.3 (lids)");
  }
  if (missing.empty()) return error;
  return make_error(
      Code::not_found,
      "the points contain no neutral face, since these are missing: " + list_of_names(missing) +
          "; add them, or give the neutral face of another recording (--face-file, "
          "--neutral-from)");
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
  return import_landmarks(std::move(*table), options);
}

Result<LandmarkImport> import_landmarks(LandmarkTable table, const LandmarkImportOptions& options) {
  const auto neutral = neutral_frames(table.track, options.neutral);
  if (!neutral) return neutral.error();
  Repairs repairs;
  fap::LandmarkOptions settings = options.face;
  settings.neutral = *neutral;
  if (options.repair) {
    // Frames are put in between: the neutral ones are those with the same numbers.
    std::vector<std::int64_t> numbers;
    for (const std::size_t i : *neutral) numbers.push_back(table.track.frames[i].number);
    repairs = repair_track(table.track);
    settings.neutral = frames_numbered(table.track, numbers);
    if (settings.neutral.empty() && !numbers.empty()) {
      return make_error(Code::invalid_argument,
                        "--neutral: the face jumped away there; use --no-repair to accept it");
    }
  }
  auto face = fap::landmarks_to_fap(table.track, settings);
  if (!face) return with_remedy(face.error(), table.track, settings);
  if (face->clip.frames.empty()) {
    return make_error(Code::not_found, "the head was not found in any frame");
  }
  LandmarkImport out{std::move(*face), table.track.depth, std::move(repairs), table.start,
                     std::move(table.warnings)};
  tell_repairs(out.repairs, out.warnings);
  if (out.face.lost > 0) {
    out.warnings.push_back("frames without a head, skipped: " + std::to_string(out.face.lost));
  }
  if (out.face.head_error > kShakyHead) {
    char share[40];
    std::snprintf(share, sizeof share, "%.4g", 100 * out.face.head_error);
    out.warnings.push_back(
        "points that should be rigid on the head are off by " + std::string(share) +
        " % of the eye distance: tracking is poor, or the head turns in a capture without depth" +
        (settings.rest ? ", or the neutral face is another person's" : ""));
  }
  return out;
}

Result<fap::RestingFace> common_face(const std::vector<LandmarkTable>& tables,
                                     const LandmarkImportOptions& options) {
  if (tables.empty()) return make_error(Code::invalid_argument, "a neutral face needs a recording");
  if (tables.size() > 1 && !options.neutral.empty()) {
    return make_error(Code::invalid_argument,
                      "--neutral is for a single recording, but there are " +
                          std::to_string(tables.size()) + "; select one with --neutral-from");
  }
  fap::LandmarkTrack all = tables[0].track;
  const auto neutral = neutral_frames(all, options.neutral);
  if (!neutral) return neutral.error();
  for (std::size_t i = 1; i < tables.size(); ++i) {
    const fap::LandmarkTrack& track = tables[i].track;
    if (track.points != all.points || track.depth != all.depth) {
      return make_error(Code::invalid_argument,
                        "the recordings have different points and cannot share a neutral face; "
                        "give it with --neutral-from or --face-file");
    }
    const std::int64_t behind = all.frames.back().number + 1;
    for (fap::LandmarkFrame frame : track.frames) {
      frame.number += behind;
      all.frames.push_back(std::move(frame));
    }
  }
  fap::LandmarkOptions settings = options.face;
  settings.neutral = *neutral;
  settings.rest.reset();
  auto face = fap::landmarks_to_fap(all, settings);
  if (!face) return with_remedy(face.error(), all, settings);
  return std::move(face->rest);
}

}  // namespace animeme::exchange
