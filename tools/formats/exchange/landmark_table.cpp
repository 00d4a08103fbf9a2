#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/landmark_rows.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

constexpr double kUsualFace = 1.9;  // see landmarks.h
constexpr double kFarOff = 1.15;    // half of the way from 4:3 to 1:1
constexpr PictureSize kUsualSizes[] = {{16, 9}, {4, 3}, {1, 1}, {3, 4}, {9, 16}};
constexpr double kFlattestNose = 0.1;  // of the distance of the outer corners of the eyes
constexpr double kLongestNose = 2;

bool are_shares(const std::vector<LandmarkRow>& rows) {
  for (const LandmarkRow& row : rows) {
    for (const fap::Point& point : row.seen.at) {
      for (const double value : {point[0], point[1]}) {
        if (value < -0.5 || value > 1.5) return false;
      }
    }
  }
  return true;
}

// Place of a point among those of the track, -1: not there.
int find(const LandmarkColumns& columns, std::string_view id) {
  for (std::size_t i = 0; i < columns.points.size(); ++i) {
    if (columns.points[i].point == id) return int(i);
  }
  return -1;
}

fap::Point minus(const fap::Point& a, const fap::Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const fap::Point& a, const fap::Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The outer corners of the eyes and the base of the nose, as they stand in a row.
struct Triangle {
  fap::Point eyes;  // from one corner to the other
  fap::Point nose;  // from the middle between them
};

std::vector<Triangle> triangles(const std::vector<LandmarkRow>& rows,
                                const LandmarkColumns& columns, std::string_view point) {
  const int left = find(columns, "3.7");
  const int right = find(columns, "3.12");
  const int nose = find(columns, point);
  std::vector<Triangle> out;
  if (left < 0 || right < 0 || nose < 0) return out;
  for (const LandmarkRow& row : rows) {
    const fap::Point& a = row.seen.at[std::size_t(left)];
    const fap::Point& b = row.seen.at[std::size_t(right)];
    const fap::Point middle = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    out.push_back({minus(a, b), minus(row.seen.at[std::size_t(nose)], middle)});
  }
  return out;
}

// How wide faces are for their height if x is multiplied by `aspect`; in the picture alone, as z
// may have any unit yet. A head that is rolled counts with the height across its eyes.
std::optional<double> proportion(const std::vector<Triangle>& faces, double aspect) {
  std::vector<double> ratios;
  for (const Triangle& face : faces) {
    const fap::Point eyes = {face.eyes[0] * aspect, face.eyes[1], 0};
    const fap::Point nose = {face.nose[0] * aspect, face.nose[1], 0};
    const double width = std::sqrt(dot(eyes, eyes));
    const double across = std::abs(eyes[0] * nose[1] - eyes[1] * nose[0]) / width;
    const double ratio = width / across;
    if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
  }
  if (ratios.empty()) return std::nullopt;
  return median(std::move(ratios));
}

double off(const std::vector<Triangle>& faces, double aspect) {
  const auto ratio = proportion(faces, aspect);
  return ratio ? std::abs(std::log(*ratio / kUsualFace)) : 0;
}

// The picture of usual size in which the faces have usual proportions.
PictureSize likely_size(const std::vector<Triangle>& faces) {
  if (!proportion(faces, 1)) return {1, 1};
  return *std::min_element(std::begin(kUsualSizes), std::end(kUsualSizes),
                           [&](const PictureSize& a, const PictureSize& b) {
                             return off(faces, a.width / a.height) < off(faces, b.width / b.height);
                           });
}

void warn_of_shares(const std::vector<Triangle>& faces, const PictureSize& given,
                    std::vector<std::string>& warnings) {
  const auto ratio = proportion(faces, given.width / given.height);
  const PictureSize likely = likely_size(faces);
  const double gain =
      off(faces, given.width / given.height) - off(faces, likely.width / likely.height);
  if (!ratio || gain < std::log(kFarOff)) return;
  char text[320];
  std::snprintf(
      text, sizeof text,
      "in a picture of %gx%g the face would be %.2f times as wide for its height as faces "
      "are, in one of %g:%g %.2f times; is --size the displayed size of the video?",
      given.width, given.height, *ratio / kUsualFace, likely.width, likely.height,
      *proportion(faces, likely.width / likely.height) / kUsualFace);
  warnings.emplace_back(text);
}

void warn_of_pixels(const std::vector<Triangle>& faces, std::vector<std::string>& warnings) {
  const auto ratio = proportion(faces, 1);
  if (!ratio || off(faces, 1) < 2 * std::log(kFarOff)) return;
  char text[320];
  std::snprintf(
      text, sizeof text,
      "the face is %.2f times as wide for its height as faces are: are x and y of one unit? "
      "--pixel-aspect %.3g would make it usual (typical pixel shapes are 16:11 and similar)",
      *ratio / kUsualFace, kUsualFace / *ratio);
  warnings.emplace_back(text);
}

void scale(std::vector<LandmarkRow>& rows, const fap::Point& factor) {
  for (LandmarkRow& row : rows) {
    for (fap::Point& point : row.seen.at) {
      for (std::size_t axis = 0; axis < 3; ++axis) point[axis] *= factor[axis];
    }
  }
}

// Errors: invalid_argument (a shape of pixels or scale of depth that is none).
Result<void> check_shape(const LandmarkTableOptions& options) {
  if (!(options.pixel_aspect >= 0.01 && options.pixel_aspect <= 100)) {
    return make_error(Code::invalid_argument, "pixels are 0.01 to 100 times as wide as high");
  }
  if (!std::isfinite(options.depth_scale) || options.depth_scale == 0) {
    return make_error(Code::invalid_argument, "the scale of depth is a number, and not 0");
  }
  return {};
}

// Makes x and y have one unit, and z, too, as landmarks.h tells; warns of what does not look like
// a face.
void to_square_pixels(std::vector<LandmarkRow>& rows, const LandmarkColumns& columns,
                      const LandmarkTableOptions& options, std::vector<std::string>& warnings) {
  const double depth = options.depth_scale;
  if (!columns.may_be_shares || !are_shares(rows)) {
    scale(rows, {columns.in_space ? 1 : options.pixel_aspect, 1, depth});
    if (!columns.in_space) warn_of_pixels(triangles(rows, columns, "9.15"), warnings);
    return;
  }
  const auto faces = triangles(rows, columns, "9.15");
  const PictureSize size = options.size ? *options.size : likely_size(faces);
  if (!options.size) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "x and y are fractions of the picture, which is assumed to be %g:%g by the "
                  "proportions of the face; set it with --size WIDTHxHEIGHT",
                  size.width, size.height);
    warnings.emplace_back(text);
  } else {
    warn_of_shares(faces, {size.width * options.pixel_aspect, size.height}, warnings);
  }
  const double width = size.width * options.pixel_aspect;
  scale(rows, {width, size.height, width * depth});
}

// Whether z has the unit of x and y, told by how far the nose stands out; if not, it is warned of.
bool has_depth_of_a_face(const std::vector<LandmarkRow>& rows, const LandmarkColumns& columns,
                         std::vector<std::string>& warnings) {
  std::vector<double> noses;
  for (const Triangle& face : triangles(rows, columns, "9.3")) {
    const double width = std::hypot(face.eyes[0], face.eyes[1]);
    const double out = std::abs(face.nose[2]) / width;
    if (std::isfinite(out)) noses.push_back(out);
  }
  if (noses.empty()) return true;
  const double out = median(std::move(noses));
  if (out >= kFlattestNose && out <= kLongestNose) return true;
  char text[320];
  std::snprintf(text, sizeof text,
                "z has another unit than x and y: the tip of the nose protrudes by %.3g times the "
                "distance of the eyes' outer corners, where 0.5 is usual; depth is ignored "
                "(--depth-scale %.4g would make it usual)",
                out, out > 0 ? 0.5 / out : 1.0);
  warnings.emplace_back(text);
  return false;
}

constexpr double kMostBefore = 1e6;  // frames without a face before the first one with one

// Times in seconds, from the times, else from frame numbers, else from the order.
Result<std::vector<RowTime>> times_of(const std::vector<LandmarkRow>& rows,
                                      const LandmarkTableOptions& options) {
  std::vector<RowTime> times;
  bool told = true;
  for (const LandmarkRow& row : rows) {
    told = told && row.time;
    if (told) times.push_back(*row.time);
  }
  const auto same = [&](const RowTime& time) {
    return time.seconds == times[0].seconds && time.frames == times[0].frames;
  };
  const bool constant = told && rows.size() > 1 && std::all_of(times.begin(), times.end(), same);
  if (told && !constant) return times;
  if (!options.rate) {
    return make_error(Code::invalid_argument,
                      constant ? "all rows have the same time; give the frame rate (--rate)"
                               : "no column has the times (timestamp, time_s or time); add one or "
                                 "give the frame rate (--rate)");
  }
  const bool counted = std::all_of(rows.begin(), rows.end(),
                                   [](const LandmarkRow& row) { return row.frame.has_value(); });
  times.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double number = counted ? *rows[i].frame : double(i);
    times.push_back({options.rate->seconds(number), std::nullopt, rows[i].line});
  }
  return times;
}

void tell(const LeftOutRows& left_out, std::vector<std::string>& warnings) {
  if (left_out.unsure > 0) {
    warnings.push_back("rows with low confidence, skipped: " + std::to_string(left_out.unsure));
  }
  if (left_out.other_faces > 0) {
    warnings.push_back("rows of other faces, skipped: " + std::to_string(left_out.other_faces) +
                       " (select a face with --face)");
  }
  if (left_out.blind > 0) {
    warnings.push_back("missing points: " + std::to_string(left_out.blind));
  }
}

// Frames between the first row of the file and the first one with a face: rows without one are left
// out, but their time has passed.
std::int64_t frames_before(const LandmarkRows& table, const PlacedRows& placed) {
  const auto& first = table.rows.front();
  double seconds = 0;
  if (table.first_time && first.time && !first.time->frames && !table.first_time->frames) {
    seconds = (first.time->seconds - table.first_time->seconds) * placed.unit;
  } else if (table.first_frame && first.frame && !first.time) {
    seconds = placed.rate.seconds(*first.frame - *table.first_frame);
  }
  const double frames = seconds * placed.rate.frames_per_second();
  return frames > 0 && frames < kMostBefore ? std::llround(frames) : 0;
}

Error no_rows(const LandmarkTableOptions& options, const LeftOutRows& left_out) {
  if (left_out.other_faces > 0 && options.face) {
    return make_error(Code::not_found, "there is no face " + std::to_string(*options.face));
  }
  if (left_out.unsure > 0) {
    return make_error(Code::truncated,
                      "the tracker has low confidence in all rows; use --confidence 0 to accept "
                      "those with success not 0");
  }
  return make_error(Code::truncated, "there is no row after the header line");
}

}  // namespace

bool is_landmark_table(std::string_view text) { return is_landmark_header(first_line(text)); }

Result<LandmarkTable> read_landmark_table(std::string_view text,
                                          const LandmarkTableOptions& options) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const char separator = separator_of(lines[0].text);
  std::vector<std::string> warnings;
  if (auto ok = check_shape(options); !ok) return ok.error();
  const auto header = read_landmark_header(Row(lines[0], separator), options, warnings);
  if (!header) return header.error();
  LandmarkColumns columns = *header;
  Result<LandmarkRows> table = read_landmark_rows(lines, separator, columns, options);
  if (!table) return std::move(table).error();
  if (table->rows.empty()) return no_rows(options, table->left_out);
  tell(table->left_out, warnings);
  const auto times = times_of(table->rows, options);
  if (!times) return times.error();
  const auto placed = place_rows(*times, options.rate, warnings);
  if (!placed) return placed.error();
  to_square_pixels(table->rows, columns, options, warnings);
  if (columns.depth && !has_depth_of_a_face(table->rows, columns, warnings)) columns.depth = false;
  const std::int64_t lead = frames_before(*table, *placed);

  fap::LandmarkTrack track{placed->rate, {}, columns.depth, {}};
  for (const PointFields& point : columns.points) track.points.push_back(point.point);
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    if (!placed->numbers[i]) continue;
    track.frames.push_back(std::move(table->rows[i].seen));
    track.frames.back().number = *placed->numbers[i] + lead;
  }
  LandmarkTable out{std::move(track), {}, std::move(warnings)};
  const RowTime& first = times->front();
  if (table->rows[0].time && !first.frames) {
    out.start = first.seconds * placed->unit - out.track.rate.seconds(double(lead));
  }
  return out;
}

}  // namespace animeme::exchange
