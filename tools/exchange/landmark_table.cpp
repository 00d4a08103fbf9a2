#include "tools/exchange/landmarks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/exchange/detail/landmark_columns.h"
#include "tools/exchange/detail/landmark_rows.h"
#include "tools/exchange/detail/table.h"
#include "tools/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

constexpr double kUsualFace = 1.9;  // see landmarks.h
constexpr PictureSize kUsualSizes[] = {{16, 9}, {4, 3}, {1, 1}, {3, 4}, {9, 16}};

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

// The picture of usual size in which the faces have usual proportions.
PictureSize likely_size(const std::vector<LandmarkRow>& rows, const LandmarkColumns& columns) {
  const int left = find(columns, "3.7");
  const int right = find(columns, "3.12");
  const int nose = find(columns, "9.15");
  if (left < 0 || right < 0 || nose < 0) return {1, 1};
  std::vector<double> ratios;
  for (const LandmarkRow& row : rows) {
    const fap::Point& a = row.seen.at[std::size_t(left)];
    const fap::Point& b = row.seen.at[std::size_t(right)];
    const double height = row.seen.at[std::size_t(nose)][1] - (a[1] + b[1]) / 2;
    const double ratio = std::abs((a[0] - b[0]) / height);
    if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
  }
  if (ratios.empty()) return {1, 1};
  const double wanted = std::log(kUsualFace / median(std::move(ratios)));  // of width to height
  const auto off = [&](const PictureSize& size) {
    return std::abs(std::log(size.width / size.height) - wanted);
  };
  return *std::min_element(
      std::begin(kUsualSizes), std::end(kUsualSizes),
      [&](const PictureSize& a, const PictureSize& b) { return off(a) < off(b); });
}

void to_square_pixels(std::vector<LandmarkRow>& rows, const LandmarkColumns& columns,
                      const std::optional<PictureSize>& given, std::vector<std::string>& warnings) {
  if (!columns.may_be_shares || !are_shares(rows)) return;
  const PictureSize size = given ? *given : likely_size(rows, columns);
  if (!given) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "x and y are shares of the picture, which is taken to be %g:%g by the "
                  "proportions of the face; --size WIDTHxHEIGHT says it",
                  size.width, size.height);
    warnings.emplace_back(text);
  }
  for (LandmarkRow& row : rows) {
    for (fap::Point& point : row.seen.at) {
      point = {point[0] * size.width, point[1] * size.height, point[2] * size.width};
    }
  }
}

void tell(const LeftOutRows& left_out, std::vector<std::string>& warnings) {
  if (left_out.unsure > 0) {
    warnings.push_back("rows in which the tracker was not sure of the face, left out: " +
                       std::to_string(left_out.unsure));
  }
  if (left_out.other_faces > 0) {
    warnings.push_back("rows of other faces, left out: " + std::to_string(left_out.other_faces) +
                       " (--face tells which face to read)");
  }
  if (left_out.blind > 0) {
    warnings.push_back("points that were not seen: " + std::to_string(left_out.blind));
  }
}

Error no_rows(const LandmarkTableOptions& options, const LeftOutRows& left_out) {
  if (left_out.other_faces > 0 && options.face) {
    return make_error(Code::not_found, "there is no face " + std::to_string(*options.face));
  }
  if (left_out.unsure > 0) {
    return make_error(Code::truncated,
                      "the tracker was not sure of the face in any row; --confidence 0 takes them "
                      "if success is not 0");
  }
  return make_error(Code::truncated, "there is no row behind the header line");
}

}  // namespace

bool is_landmark_table(std::string_view text) { return is_landmark_header(first_line(text)); }

Result<LandmarkTable> read_landmark_table(std::string_view text,
                                          const LandmarkTableOptions& options) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const char separator = separator_of(lines[0].text);
  std::vector<std::string> warnings;
  const auto columns = read_landmark_header(Row(lines[0], separator), options, warnings);
  if (!columns) return columns.error();
  Result<LandmarkRows> table = read_landmark_rows(lines, separator, *columns, options);
  if (!table) return std::move(table).error();
  if (table->rows.empty()) return no_rows(options, table->left_out);
  tell(table->left_out, warnings);
  const auto times = times_of(table->rows, options);
  if (!times) return times.error();
  const auto placed = place_rows(*times, options.rate, warnings);
  if (!placed) return placed.error();
  to_square_pixels(table->rows, *columns, options.size, warnings);

  fap::LandmarkTrack track{placed->rate, {}, columns->depth, {}};
  for (const PointFields& point : columns->points) track.points.push_back(point.point);
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    if (!placed->numbers[i]) continue;
    track.frames.push_back(std::move(table->rows[i].seen));
    track.frames.back().number = *placed->numbers[i];
  }
  return LandmarkTable{std::move(track), std::move(warnings)};
}

}  // namespace animeme::exchange
