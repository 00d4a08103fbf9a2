#include "tools/formats/exchange/landmarks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/landmark_rows.h"
#include "tools/formats/exchange/detail/picture_shape.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

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
