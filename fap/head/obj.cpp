#include "fap/head/obj.h"

#include <charconv>
#include <cstdio>
#include <optional>

#include "fap/detail/number_text.h"

namespace animeme::head {
namespace {

constexpr std::string_view kSpace = " \t\r";
constexpr std::size_t kMostObjVertices = 500'000;
constexpr std::size_t kMostObjTriangles = 2'000'000;

// The words of one line, one after the other.
class Line {
 public:
  Line(std::string_view text, std::int64_t number) : text_(text), number_(number) {}

  std::string_view word() {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(kSpace, at_), text_.size());
    const std::string_view found = text_.substr(at_, end - at_);
    start_ = at_;
    at_ = end;
    return found;
  }

  std::string_view rest() {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
    const std::string_view left = text_.substr(at_);
    const std::size_t end = left.find_last_not_of(kSpace);
    return end == std::string_view::npos ? std::string_view() : left.substr(0, end + 1);
  }

  /// An error at the last word.
  Error bad(std::string sentence, Code code = Code::syntax) const {
    return error_at_line(code, std::move(sentence), number_, std::int64_t(start_) + 1);
  }

 private:
  std::string_view text_;
  std::int64_t number_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;
};

class Reader {
 public:
  Result<ObjFile> read(std::string_view text) {
    std::int64_t line = 0;
    std::string joined;  // a backslash at the end of a line goes on in the next
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view part = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line;
      if (part.ends_with('\r')) part.remove_suffix(1);
      if (part.ends_with('\\')) {
        joined += part.substr(0, part.size() - 1);
        joined += ' ';
        continue;
      }
      joined += part;
      if (auto error = read_line(Line(joined, line))) return std::move(*error);
      joined.clear();
    }
    return finish();
  }

 private:
  std::optional<Error> read_line(Line line) {
    const std::string_view word = line.word();
    if (word == "v") return read_vertex(line);
    if (word == "f") return read_face(line);
    if (word == "o" || word == "g") {
      name_ = line.rest();
      target_ = -1;
    } else if (word == "usemtl") {
      material_ = line.rest();
      target_ = -1;
    }
    return std::nullopt;
  }

  static Error too_large(const Line& line, std::size_t most, const char* things) {
    return line.bad("the file has more than " + std::to_string(most) + " " + things +
                        ", the most that are read; reduce its meshes",
                    Code::out_of_range);
  }

  std::optional<Error> read_vertex(Line& line) {
    std::vector<float> values;
    for (std::string_view word = line.word(); !word.empty(); word = line.word()) {
      const std::optional<float> value = fap::detail::finite_number<float>(word);
      if (!value) return line.bad("\"" + std::string(word) + "\" is no number");
      values.push_back(*value);
    }
    if (values.size() < 3) return line.bad("a vertex needs x, y and z");
    if (places_.size() == kMostObjVertices) return too_large(line, kMostObjVertices, "vertices");
    places_.push_back({values[0], values[1], values[2]});
    // Four numbers are a weight, six or seven are a colour.
    if (values.size() >= 6) {
      const std::size_t first = values.size() - 3;
      colours_.push_back({values[first], values[first + 1], values[first + 2]});
    }
    return std::nullopt;
  }

  std::optional<Error> read_face(Line& line) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = line.word(); !word.empty(); word = line.word()) {
      const std::string_view digits = word.substr(0, word.find('/'));
      std::int64_t n = 0;
      const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
      if (code != std::errc() || end != digits.data() + digits.size()) {
        return line.bad("\"" + std::string(word) + "\" is no corner of a face");
      }
      const auto count = std::int64_t(places_.size());
      const std::int64_t index = n < 0 ? count + n : n - 1;
      if (index < 0 || index >= count) {
        return line.bad("vertex " + std::to_string(n) + " does not exist here; there are " +
                        std::to_string(count));
      }
      corners.push_back(std::uint32_t(index));
    }
    if (corners.size() < 3) return line.bad("a face needs three corners or more");
    triangles_ += corners.size() - 2;
    if (triangles_ > kMostObjTriangles) return too_large(line, kMostObjTriangles, "triangles");
    if (target_ < 0) target_ = target_of_names();
    if (target_ >= kPartCount) return std::nullopt;  // not to be shown
    Group& group = groups_[std::size_t(target_)];
    for (std::size_t k = 2; k < corners.size(); ++k) {
      group.triangles.push_back({corners[0], corners[k - 1], corners[k]});
      group.colours.push_back(usual_);
    }
    return std::nullopt;
  }

  int target_of_names() {
    const std::optional<Part> part = part_by_name(name_, material_);
    if (!part) return kPartCount;
    usual_ = colour_by_name(name_, material_);
    Group& group = groups_[std::size_t(*part)];
    if (group.triangles.empty()) {
      group.name = name_;
      group.material = material_;
    }
    return int(*part);
  }

  Result<ObjFile> finish() {
    ObjFile file;
    file.vertices.resize(places_.size());
    const bool coloured = colours_.size() == places_.size();
    for (const Group& group : groups_) {
      if (group.triangles.empty()) continue;
      Piece piece{.name = group.name, .material = group.material, .mesh = {}, .neck_weights = {}};
      std::vector<std::uint32_t> index(places_.size(), kMissing);
      for (std::size_t k = 0; k < group.triangles.size(); ++k) {
        Triangle t = group.triangles[k];
        for (std::uint32_t& v : t) {
          if (index[v] == kMissing) {
            index[v] = std::uint32_t(piece.mesh.positions.size());
            piece.mesh.positions.push_back(places_[v]);
            piece.mesh.colours.push_back(coloured ? colours_[v] : group.colours[k]);
            if (file.vertices[v].vertex == kMissing) {
              file.vertices[v] = {file.pieces.size(), index[v]};
            }
          }
          v = index[v];
        }
        piece.mesh.triangles.push_back(t);
      }
      file.pieces.push_back(std::move(piece));
    }
    if (file.pieces.empty()) {
      return make_error(Code::invalid_argument, "the OBJ file has no face to show");
    }
    return file;
  }

  struct Group {
    std::string name, material;
    std::vector<Triangle> triangles;
    std::vector<Vec3> colours;  // of triangles, where the file has none
  };
  std::vector<Vec3> places_, colours_;
  std::array<Group, kPartCount> groups_;
  std::size_t triangles_ = 0;
  std::string name_, material_;
  Vec3 usual_ = kNoColour;
  int target_ = -1;  // part of the faces that come; -1: not looked up yet
};

}  // namespace

Result<ObjFile> read_obj(std::string_view text) { return Reader().read(text); }

std::string write_obj(const Head& head) {
  std::string out = "# " + head.name + "\n";
  std::size_t first = 1;
  char line[160];
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    const Mesh& mesh = head.parts[part];
    if (mesh.positions.empty()) continue;
    out += "g " + std::string(kPartNames[part]) + "\n";
    const bool coloured = mesh.colours.size() == mesh.positions.size();
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = mesh.positions[v];
      std::snprintf(line, sizeof line, "v %.6g %.6g %.6g", double(p.x), double(p.y), double(p.z));
      out += line;
      if (coloured) {
        const Vec3 c = mesh.colours[v];
        std::snprintf(line, sizeof line, " %.4f %.4f %.4f", double(c.x), double(c.y), double(c.z));
        out += line;
      }
      out += '\n';
    }
    for (const Triangle& t : mesh.triangles) {
      std::snprintf(line, sizeof line, "f %zu %zu %zu\n", first + t[0], first + t[1], first + t[2]);
      out += line;
    }
    first += mesh.positions.size();
  }
  return out;
}

std::string points_of(const Head& head) {
  std::array<std::size_t, kPartCount + 1> first{};
  for (std::size_t part = 0; part < head.parts.size(); ++part) {
    first[part + 1] = first[part] + head.parts[part].positions.size();
  }
  std::string out = "feature_point,vertex,name\n";
  for (std::size_t i = 0; i < head.feature_points.size(); ++i) {
    const FeaturePoint point = head.feature_points[i];
    if (!point.exists()) continue;
    out += std::string(fap::kFeaturePoints[i].id) + "," +
           std::to_string(first[std::size_t(point.part)] + point.vertex) + "," +
           std::string(fap::kFeaturePoints[i].name) + "\n";
  }
  return out;
}

}  // namespace animeme::head
