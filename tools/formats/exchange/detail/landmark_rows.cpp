#include "tools/formats/exchange/detail/landmark_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fap/detail/similarity.h"

namespace animeme::exchange {

namespace {

// The fields of one line under the names of their columns.
class Cells : public Row {
 public:
  Cells(const dam::TableLine& line, char separator, const LandmarkColumns& columns)
      : Row(line, separator), columns_(columns) {}

  /// NaN for an empty field.
  Result<double> number(std::size_t field) const {
    if (text(field).empty()) return std::numeric_limits<double>::quiet_NaN();
    if (const auto value = Row::number(field)) return *value;
    return wrong(field, "not a number; correct it or leave it empty");
  }

  Error wrong(std::size_t field, const std::string& which_is) const {
    return Row::wrong(field, columns_.names[field], which_is);
  }

 private:
  const LandmarkColumns& columns_;
};

// All fields of `fields`, missing ones 0; nothing if one is not finite.
Result<std::optional<fap::Point>> read_point(const Cells& cells, const Fields3& fields) {
  fap::Point point{};
  bool seen = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!fields[axis]) continue;
    const Result<double> value = cells.number(*fields[axis]);
    if (!value) return value.error();
    seen = seen && std::isfinite(*value);
    point[axis] = *value;
  }
  if (!seen) return std::optional<fap::Point>();
  return std::optional<fap::Point>(point);
}

Result<void> read_points(const Cells& cells, const LandmarkColumns& columns,
                         fap::LandmarkFrame& frame, LeftOutRows& left_out) {
  for (const PointFields& point : columns.points) {
    fap::Point mean{};
    for (Fields3 fields : point.landmarks) {
      if (!columns.depth) fields[2].reset();
      const auto place = read_point(cells, fields);
      if (!place) return place.error();
      const double nothing = std::numeric_limits<double>::quiet_NaN();
      for (std::size_t k = 0; k < 3; ++k) {
        mean[k] += (*place ? (**place)[k] : nothing) / double(point.landmarks.size());
      }
    }
    left_out.blind += std::isnan(mean[0]) ? 1 : 0;
    frame.at.push_back(mean);
  }
  return {};
}

bool complete(const Fields3& fields) { return fields[0] && fields[1] && fields[2]; }

// Rx * Ry * Rz of OpenFace as angles of FAPs: x stays, y and z change their direction.
fap::HeadPose head_of(const fap::Point& r) {
  using fap::internal::product;
  using fap::internal::rotation_of;
  return fap::internal::angles_of(product(
      rotation_of({r[0], 0, 0}), product(rotation_of({0, -r[1], 0}), rotation_of({0, 0, -r[2]}))));
}

Result<void> read_head_and_eyes(const Cells& cells, const LandmarkColumns& columns,
                                fap::LandmarkFrame& frame) {
  if (complete(columns.pose)) {
    const auto pose = read_point(cells, columns.pose);
    if (!pose) return pose.error();
    if (*pose) frame.head = head_of(**pose);
  }
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (!complete(columns.gaze[eye])) continue;
    const auto gaze = read_point(cells, columns.gaze[eye]);
    if (!gaze) return gaze.error();
    if (*gaze) frame.gaze[1 - eye] = {(**gaze)[0], -(**gaze)[1], -(**gaze)[2]};
  }
  if (columns.gaze_angle[0] && columns.gaze_angle[1]) {
    const auto angles =
        read_point(cells, {columns.gaze_angle[0], columns.gaze_angle[1], std::nullopt});
    if (!angles) return angles.error();
    for (auto& gaze : frame.gaze) {
      if (gaze || !*angles) continue;
      gaze = {std::tan((**angles)[0]), -std::tan((**angles)[1]), 1};
    }
  }
  return {};
}

// True if the tracker was not sure of the row.
Result<bool> is_unsure(const Cells& cells, const LandmarkColumns& columns, double limit) {
  if (columns.success) {
    const Result<double> value = cells.number(*columns.success);
    if (!value) return value.error();
    if (!(*value > 0)) return true;
  }
  if (columns.confidence) {
    const Result<double> value = cells.number(*columns.confidence);
    if (!value) return value.error();
    if (!(*value >= limit)) return true;
  }
  return false;
}

class Reader {
 public:
  Reader(const LandmarkColumns& columns, const LandmarkTableOptions& options)
      : columns_(columns), options_(options), face_(options.face) {}

  Result<std::vector<LandmarkRow>> read(const std::vector<dam::TableLine>& lines, char separator) {
    std::vector<LandmarkRow> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const Cells cells(lines[i], separator, columns_);
      if (auto ok = cells.check_size(columns_.names.size()); !ok) return ok.error();
      if (i == 1) note_first(cells);
      const Result<bool> wanted = is_wanted(cells);
      if (!wanted) return wanted.error();
      if (!*wanted) continue;
      Result<LandmarkRow> row = read_row(cells);
      if (!row) return std::move(row).error();
      rows.push_back(std::move(*row));
    }
    return rows;
  }

  const LeftOutRows& left_out() const { return left_out_; }
  const std::optional<RowTime>& first_time() const { return first_time_; }
  const std::optional<double>& first_frame() const { return first_frame_; }

 private:
  void note_first(const Cells& cells) {
    if (columns_.time) first_time_ = parse_time(cells.text(*columns_.time), cells.line());
    if (!columns_.frame) return;
    const Result<double> frame = cells.number(*columns_.frame);
    if (frame && std::isfinite(*frame)) first_frame_ = *frame;
  }

  Result<bool> is_wanted(const Cells& cells) {
    const Result<bool> unsure = is_unsure(cells, columns_, options_.confidence);
    if (!unsure) return unsure.error();
    left_out_.unsure += *unsure ? 1 : 0;
    if (*unsure) return false;
    if (!columns_.face) return true;
    const Result<double> face = cells.number(*columns_.face);
    if (!face) return face.error();
    if (!face_ && std::isfinite(*face)) face_ = int(std::clamp(*face, -1e9, 1e9));
    const bool same = face_ && *face == *face_;
    left_out_.other_faces += same ? 0 : 1;
    return same;
  }

  Result<LandmarkRow> read_row(const Cells& cells) {
    LandmarkRow row;
    row.line = cells.line();
    if (columns_.time) {
      row.time = parse_time(cells.text(*columns_.time), cells.line());
      if (!row.time) {
        return cells.wrong(*columns_.time, "not a time; write seconds or hh:mm:ss:ff.fff");
      }
    }
    if (columns_.frame) {
      const Result<double> frame = cells.number(*columns_.frame);
      if (!frame) return frame.error();
      if (std::isfinite(*frame)) row.frame = *frame;
    }
    if (auto ok = read_points(cells, columns_, row.seen, left_out_); !ok) return ok.error();
    if (auto ok = read_head_and_eyes(cells, columns_, row.seen); !ok) return ok.error();
    return row;
  }

  const LandmarkColumns& columns_;
  const LandmarkTableOptions& options_;
  std::optional<int> face_;
  LeftOutRows left_out_;
  std::optional<RowTime> first_time_;
  std::optional<double> first_frame_;
};

}  // namespace

Result<LandmarkRows> read_landmark_rows(const std::vector<dam::TableLine>& lines, char separator,
                                        const LandmarkColumns& columns,
                                        const LandmarkTableOptions& options) {
  Reader reader(columns, options);
  Result<std::vector<LandmarkRow>> rows = reader.read(lines, separator);
  if (!rows) return std::move(rows).error();
  return LandmarkRows{std::move(*rows), reader.first_time(), reader.first_frame(),
                      reader.left_out()};
}

}  // namespace animeme::exchange
