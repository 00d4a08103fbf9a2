#include "fap/head/point_list.h"

#include <array>
#include <cctype>
#include <charconv>
#include <limits>

#include "fap/detail/number_text.h"
#include "fap/detail/text_scanner.h"

namespace animeme::head {
namespace {

constexpr std::size_t kMostRows = 10'000;  // each is looked for on all vertices

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  const bool marked = line.find_first_of(",;\t") != std::string_view::npos;
  const std::string_view marks = marked ? ",;\t" : " ";
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(marks), line.size());
    std::string_view field = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    const std::size_t first = field.find_first_not_of(" \"");
    field = first == std::string_view::npos ? "" : field.substr(first);
    field = field.substr(0, field.find_last_not_of(" \"") + 1);
    if (marked || !field.empty()) fields.emplace_back(field);
  }
  return fields;
}

std::optional<std::uint32_t> index_of(const std::string& field) {
  std::uint32_t value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

// Numbers of the columns; -1: not there.
struct PointColumns {
  int id = 0, vertex = 1, mesh = -1;
  std::array<int, 3> place = {-1, -1, -1};
};

std::optional<PointColumns> heading_of(const std::vector<std::string>& fields) {
  if (fields.empty() ||
      (!fields[0].empty() && std::isdigit(static_cast<unsigned char>(fields[0][0])))) {
    return std::nullopt;
  }
  PointColumns columns{.id = -1, .vertex = -1};
  for (int i = 0; i < int(fields.size()); ++i) {
    const std::string name = fap::detail::lower_case(fields[std::size_t(i)]);
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    const auto take = [i](int& column) { column = column < 0 ? i : column; };
    if (has("vertex") || has("index")) {
      take(columns.vertex);
    } else if (has("point") || name == "id") {
      take(columns.id);
    } else if (has("mesh") || has("object")) {
      take(columns.mesh);
    } else if (!name.empty() && name[0] >= 'x' && name[0] <= 'z') {
      take(columns.place[std::size_t(name[0] - 'x')]);
    }
  }
  return columns;
}

class Rows {
 public:
  std::optional<Error> add(std::string_view line, std::int64_t number) {
    line = line.substr(0, line.find('#'));
    const std::vector<std::string> fields = fields_of(line);
    if (fields.empty() || (fields.size() == 1 && fields[0].empty())) return std::nullopt;
    if (first_) {
      first_ = false;
      if (const auto heading = heading_of(fields)) {
        columns_ = *heading;
        if (columns_.id < 0) return bad("the heading has no column feature_point", number);
        return std::nullopt;
      }
      if (fields.size() == 4) columns_ = {.id = 0, .vertex = -1, .mesh = -1, .place = {1, 2, 3}};
    }
    return add_row(fields, number);
  }

  std::vector<PointRow> rows;

 private:
  static Error bad(std::string sentence, std::int64_t line) {
    return error_at_line(Code::syntax, std::move(sentence), line);
  }

  std::optional<Error> add_row(const std::vector<std::string>& fields, std::int64_t number) {
    const auto field = [&](int column) {
      const bool there = column >= 0 && column < int(fields.size());
      return there ? fields[std::size_t(column)] : std::string();
    };
    PointRow row{.id = field(columns_.id), .mesh = field(columns_.mesh), .line = number};
    const std::string vertex = field(columns_.vertex);
    if (!vertex.empty()) {
      row.vertex = index_of(vertex);
      if (!row.vertex) return bad("\"" + vertex + "\" is no vertex number", number);
    }
    std::array<std::optional<float>, 3> place;
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = fap::detail::finite_number<float>(field(columns_.place[k]));
    }
    if (place[0] && place[1] && place[2]) row.place = Vec3{*place[0], *place[1], *place[2]};
    if (!row.vertex && !row.place) {
      return bad("point " + row.id + " needs a vertex number, or x, y and z", number);
    }
    if (rows.size() == kMostRows) {
      return error_at_line(Code::out_of_range,
                           "the list has more than " + std::to_string(kMostRows) +
                               " points; keep those that are feature points",
                           number);
    }
    rows.push_back(std::move(row));
    return std::nullopt;
  }

  PointColumns columns_;
  bool first_ = true;
};

bool is_on(const Piece& piece, const std::string& mesh) {
  return mesh.empty() || piece.name == mesh || piece.material == mesh;
}

std::optional<PiecePoint> nearest(const std::vector<Piece>& pieces, const PointRow& row) {
  std::optional<PiecePoint> best;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!is_on(pieces[i], row.mesh) || !part_by_name(pieces[i].name, pieces[i].material)) continue;
    const std::vector<Vec3>& places = pieces[i].mesh.positions;
    for (std::uint32_t v = 0; v < places.size(); ++v) {
      const Vec3 d = places[v] - *row.place;
      if (dot(d, d) >= least) continue;
      least = dot(d, d);
      best = PiecePoint{row.id, i, v};
    }
  }
  return best;
}

Error missing(const PointRow& row) {
  const std::string what = row.vertex ? "vertex " + std::to_string(*row.vertex) : "no vertex";
  return error_at_line(Code::not_found,
                       "point " + row.id + ": the head has " + (row.vertex ? "no " : "") + what +
                           (row.mesh.empty() ? "" : " on " + row.mesh) +
                           "; vertices are counted from 0 in the order of the file",
                       row.line);
}

}  // namespace

Result<std::vector<PointRow>> read_points(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Rows rows;
  std::int64_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (auto error = rows.add(line, ++number)) return std::move(*error);
  }
  if (rows.rows.empty()) {
    return make_error(Code::invalid_argument,
                      "the list has no point; a line is a feature point and a vertex: 2.1,966");
  }
  return std::move(rows.rows);
}

Result<std::vector<PiecePoint>> points_on(const ObjFile& file, const std::vector<PointRow>& rows) {
  std::vector<PiecePoint> points;
  for (const PointRow& row : rows) {
    std::optional<PiecePoint> found;
    if (!row.vertex) {
      found = nearest(file.pieces, row);
    } else if (*row.vertex < file.vertices.size()) {
      const ObjFile::Place place = file.vertices[*row.vertex];
      if (place.vertex != kMissing) found = PiecePoint{row.id, place.piece, place.vertex};
    }
    if (!found) return missing(row);
    points.push_back(std::move(*found));
  }
  return points;
}

Result<std::vector<PiecePoint>> points_on(const std::vector<Piece>& pieces,
                                          const std::vector<PointRow>& rows) {
  std::vector<PiecePoint> points;
  for (const PointRow& row : rows) {
    std::optional<PiecePoint> found;
    std::uint32_t left = row.vertex.value_or(0);
    for (std::size_t i = 0; i < pieces.size() && row.vertex && !found; ++i) {
      const Piece& piece = pieces[i];
      const bool skin = part_by_name(piece.name, piece.material) == Part::skin;
      if (row.mesh.empty() ? !skin : !is_on(piece, row.mesh)) continue;
      if (left < piece.mesh.positions.size()) {
        found = PiecePoint{row.id, i, left};
      } else {
        left -= std::uint32_t(piece.mesh.positions.size());
      }
    }
    if (!row.vertex) found = nearest(pieces, row);
    if (!found) return missing(row);
    points.push_back(std::move(*found));
  }
  return points;
}

}  // namespace animeme::head
