#include "tools/view/gltf/obj_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <optional>
#include <set>

#include "fap/arkit.h"
#include "fap/detail/number_text.h"
#include "fap/detail/text_scanner.h"
#include "fap/head/obj.h"
#include "tools/formats/files/files.h"
#include "tools/view/gltf/detail/glb_buffer.h"
#include "tools/view/gltf/detail/gunzip.h"
#include "tools/view/gltf/detail/words.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

namespace fs = std::filesystem;
using fap::detail::lower_case;
using head::Vec3;

constexpr std::size_t kMostFiles = 4096;  // of a folder; what has more is no head
constexpr std::size_t kMostListed = 60;   // in a note or an error

struct ObjPath {
  std::string name;  // "jawOpen"
  std::string path;
};

// "jawOpen" of "jawOpen.obj.gz"; nothing: it is none.
std::optional<std::string> name_of(const fs::path& path) {
  std::string file = path.filename().string();
  for (const std::string_view ending : {".gz", ".obj"}) {
    const bool ends = lower_case(file).ends_with(ending);
    if (!ends && ending == ".obj") return std::nullopt;
    if (ends) file.resize(file.size() - ending.size());
  }
  if (file.empty() || file.starts_with('.')) return std::nullopt;
  return file;
}

Result<std::vector<ObjPath>> files_in(const std::string& folder) {
  std::vector<ObjPath> files;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    std::optional<std::string> name = name_of(at->path());
    std::error_code unknown;
    if (!name || !at->is_regular_file(unknown)) continue;
    files.push_back({std::move(*name), at->path().string()});
    if (files.size() > kMostFiles) {
      return make_error(Code::out_of_range,
                        "there are more than " + std::to_string(kMostFiles) + " .obj files in it");
    }
  }
  if (error) return make_error(Code::io, "the folder cannot be read: " + error.message());
  // A file and its packed copy are one: the plain one counts.
  std::sort(files.begin(), files.end(), [](const ObjPath& a, const ObjPath& b) {
    return std::pair(a.name, a.path.size()) < std::pair(b.name, b.path.size());
  });
  files.erase(std::unique(files.begin(), files.end(),
                          [](const ObjPath& a, const ObjPath& b) { return a.name == b.name; }),
              files.end());
  if (files.empty()) {
    return make_error(
        Code::not_found,
        "there is no .obj in this folder; a head is neutral.obj and one .obj for each "
        "shape, such as jawOpen.obj");
  }
  return files;
}

// How surely a name is that of the head at rest: 0 it is not.
int resting(const std::string& name) {
  const std::vector<std::string> words = words_of(name);
  if (lower_case(name) == "neutral") return 3;
  if (has_word(words, "neutral")) return 2;
  for (const char* word : {"base", "basis", "rest", "mean", "template", "default"}) {
    if (has_word(words, word)) return 1;
  }
  return 0;
}

std::vector<std::string> names_of(const std::vector<ObjPath>& files) {
  std::vector<std::string> names;
  for (const ObjPath& file : files) names.push_back(file.name);
  return names;
}

Result<ObjPath> take_resting(std::vector<ObjPath>& files, const ShapeRules& rules) {
  auto best = files.end();
  int surest = 0;
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (find_rule(rules, file->name) != nullptr || meaning_of(file->name)) continue;
    const int sure = resting(file->name);
    if (sure > surest) {
      best = file;
      surest = sure;
    }
  }
  if (best == files.end()) {
    return make_error(Code::not_found,
                      "none of its files is the head at rest: call it neutral.obj "
                      "(there are: " +
                          list_of(names_of(files), kMostListed) + ")");
  }
  ObjPath found = std::move(*best);
  files.erase(best);
  return found;
}

// The lines "v x y z" alone: those of a shape.
Result<std::vector<Vec3>> places_in(std::string_view text, std::size_t wanted) {
  constexpr std::string_view kSpace = " \t\r";
  std::vector<Vec3> places;
  places.reserve(wanted);
  for (std::int64_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
    if (line.size() < 2 || line[0] != 'v' || kSpace.find(line[1]) == std::string_view::npos) {
      continue;
    }
    line.remove_prefix(1);
    std::array<float, 3> xyz{};
    for (float& value : xyz) {
      line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
      const std::string_view word = line.substr(0, line.find_first_of(kSpace));
      line.remove_prefix(word.size());
      const auto found = fap::detail::finite_number<float>(word);
      if (!found) return error_at_line(Code::syntax, "a vertex needs x, y and z", number);
      value = *found;
    }
    places.push_back({xyz[0], xyz[1], xyz[2]});
    if (places.size() > wanted) break;
  }
  if (places.size() != wanted) {
    return make_error(Code::invalid_argument,
                      "it has " + std::string(places.size() > wanted ? "more" : "fewer") +
                          " vertices than the head at rest (" + std::to_string(wanted) +
                          "): shapes are the same mesh, moved");
  }
  return places;
}

// What a shape does to one piece.
struct Moved {
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3> deltas;
};

class FolderReader {
 public:
  explicit FolderReader(ReadOptions options) : options_(std::move(options)) {}

  Result<HeadFile> read(const std::string& folder) {
    auto files = files_in(folder);
    if (!files) return files.error();
    if (auto known = check_rules(options_.rules, names_of(*files)); !known) return known.error();
    const auto rest = take_resting(*files, options_.rules);
    if (!rest) return rest.error();
    if (auto read = read_rest(*rest); !read) return read.error();
    ShapeRules rules;
    std::vector<std::string> unknown;
    const std::string prefix = common_prefix(names_of(*files));
    for (const ObjPath& file : *files) {
      const ShapeRule* const rule = find_rule(options_.rules, file.name);
      if (rule != nullptr && rule->meaning == "-") continue;
      if (rule == nullptr && !meaning_of(file.name, prefix)) {
        unknown.push_back(file.name);
        continue;
      }
      auto moves = read_shape(file);
      if (!moves) return moves.error();
      if (!*moves) continue;
      if (rule != nullptr) rules.push_back({file.name, rule->meaning});
      if (const auto meaning =
              rule != nullptr ? meaning_of(rule->meaning) : meaning_of(file.name, prefix)) {
        for (const ArkitPart& part : meaning->parts) present_.insert(part.channel);
      }
    }
    options_.rules = std::move(rules);
    auto glb = write();
    if (!glb) return glb.error();
    Result<HeadFile> head = read_head_and_vertices(*glb, options_);
    if (!head) return head.error();
    finish(*head, unknown);
    head->source.notes.insert(head->source.notes.begin(),
                              "\"" + rest->name + "\" is the head at rest");
    return head;
  }

 private:
  Result<void> read_rest(const ObjPath& file) {
    const auto text = read_obj_text(file.path, options_.limits.bytes);
    if (!text) return text.error();
    auto obj = head::read_obj(*text);
    if (!obj) return obj.error().in_file(file.path);
    obj_ = std::move(*obj);
    auto places = places_in(*text, obj_.vertices.size());
    if (!places) return places.error().in_file(file.path);
    rest_ = std::move(*places);
    morphs_.resize(obj_.pieces.size());
    // A vertex may be in several pieces: where parts meet.
    for (std::size_t p = 0; p < obj_.pieces.size(); ++p) {
      numbers_.push_back(numbers_in(p));
    }
    return {};
  }

  // The number in the file of each vertex of a piece. Vertices of the first piece that has them are
  // known; those that several share are found by their places.
  std::vector<std::uint32_t> numbers_in(std::size_t piece) const {
    const std::vector<Vec3>& places = obj_.pieces[piece].mesh.positions;
    std::vector<std::uint32_t> numbers(places.size(), head::kMissing);
    for (std::size_t v = 0; v < obj_.vertices.size(); ++v) {
      const head::ObjFile::Place& place = obj_.vertices[v];
      if (place.piece == piece && place.vertex != head::kMissing) {
        numbers[place.vertex] = std::uint32_t(v);
      }
    }
    const auto key = [](Vec3 p) { return std::array<float, 3>{p.x, p.y, p.z}; };
    std::vector<std::uint32_t> lost;
    for (std::size_t v = 0; v < numbers.size(); ++v) {
      if (numbers[v] == head::kMissing) lost.push_back(std::uint32_t(v));
    }
    if (lost.empty()) return numbers;
    std::vector<std::pair<std::array<float, 3>, std::uint32_t>> all;
    for (std::size_t v = 0; v < rest_.size(); ++v) {
      if (obj_.vertices[v].vertex != head::kMissing && obj_.vertices[v].piece != piece) {
        all.emplace_back(key(rest_[v]), std::uint32_t(v));
      }
    }
    std::sort(all.begin(), all.end());
    for (const std::uint32_t v : lost) {
      const auto at =
          std::lower_bound(all.begin(), all.end(), std::pair(key(places[v]), std::uint32_t(0)));
      if (at != all.end() && at->first == key(places[v])) numbers[v] = at->second;
    }
    return numbers;
  }

  // False: it moves nothing that is shown.
  Result<bool> read_shape(const ObjPath& file) {
    const auto text = read_obj_text(file.path, options_.limits.bytes);
    if (!text) return text.error();
    const auto places = places_in(*text, rest_.size());
    if (!places) return places.error().in_file(file.path);
    bool any = false;
    std::vector<Moved> all(obj_.pieces.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
      for (std::size_t v = 0; v < numbers_[p].size(); ++v) {
        const std::uint32_t number = numbers_[p][v];
        if (number == head::kMissing) continue;
        const Vec3 delta = (*places)[number] - rest_[number];
        if (delta.x == 0 && delta.y == 0 && delta.z == 0) continue;
        all[p].vertices.push_back(std::uint32_t(v));
        all[p].deltas.push_back(delta);
        if (++moves_ > options_.limits.moves) {
          return make_error(Code::out_of_range,
                            "its shapes move more than " + std::to_string(options_.limits.moves) +
                                " vertices; leave out those that a face does not need");
        }
      }
      any = any || !all[p].vertices.empty();
    }
    if (!any) {
      still_.push_back(file.name);
      return false;
    }
    names_.push_back(file.name);
    for (std::size_t p = 0; p < all.size(); ++p) morphs_[p].push_back(std::move(all[p]));
    return true;
  }

  Result<std::vector<std::uint8_t>> write() {
    GlbBuffer buffer;
    Json meshes = Json::array(), nodes = Json::array(), materials = Json::array();
    Json scene = Json::array();
    for (std::size_t p = 0; p < obj_.pieces.size(); ++p) {
      const head::Piece& piece = obj_.pieces[p];
      std::vector<std::uint32_t> corners;
      for (const head::Triangle& t : piece.mesh.triangles) {
        corners.insert(corners.end(), t.begin(), t.end());
      }
      Json primitive = {
          {"attributes",
           {{"POSITION", buffer.vectors(piece.mesh.positions, BufferUse::vertices, true)}}},
          {"indices", buffer.triangles(corners)},
          {"material", p}};
      Json names = Json::array();
      for (std::size_t s = 0; s < names_.size(); ++s) {
        const Moved& moved = morphs_[p][s];
        if (moved.vertices.empty()) continue;
        names.push_back(names_[s]);
        primitive["targets"].push_back({{"POSITION", buffer.sparse(piece.mesh.positions.size(),
                                                                   moved.vertices, moved.deltas)}});
      }
      Json mesh = {{"name", piece.name}, {"primitives", Json::array()}};
      mesh["primitives"].push_back(std::move(primitive));
      if (!names.empty()) mesh["extras"] = {{"targetNames", names}};
      meshes.push_back(std::move(mesh));
      materials.push_back({{"name", piece.material}, {"doubleSided", true}});
      nodes.push_back({{"mesh", p}, {"name", piece.name}});
      scene.push_back(p);
    }
    Json scenes = Json::array();
    scenes.push_back({{"nodes", scene}});
    return buffer.file({{"asset", {{"version", "2.0"}}},
                        {"scene", 0},
                        {"scenes", scenes},
                        {"nodes", nodes},
                        {"meshes", meshes},
                        {"materials", materials},
                        {"accessors", buffer.accessors},
                        {"bufferViews", buffer.views}});
  }

  // Colours and numbers of vertices, which the file at rest has and a .glb would lose.
  void finish(HeadFile& head, const std::vector<std::string>& unknown) const {
    MeshVertices all{"", true, std::vector<PieceVertex>(obj_.vertices.size())};
    const bool each = head.meshes.size() == obj_.pieces.size();
    for (std::size_t p = 0; each && p < obj_.pieces.size(); ++p) {
      const std::vector<PieceVertex>& places = head.meshes[p].vertices;
      for (std::size_t v = 0; v < std::min(places.size(), numbers_[p].size()); ++v) {
        if (places[v].vertex == head::kMissing) continue;
        head::Mesh& mesh = head.source.pieces[places[v].piece].mesh;
        const Vec3 colour = obj_.pieces[p].mesh.colours[v];
        if (colour.x >= 0) {
          mesh.colours.resize(mesh.positions.size(), head::kNoColour);
          mesh.colours[places[v].vertex] = colour;
        }
        if (numbers_[p][v] == head::kMissing) continue;
        PieceVertex& to = all.vertices[numbers_[p][v]];
        if (to.vertex == head::kMissing) to = places[v];
      }
    }
    head.meshes = {std::move(all)};
    head.unknown = unknown;
    std::vector<std::string> missing;
    for (int shape = 0; shape < fap::kArkitShapeCount && !present_.empty(); ++shape) {
      if (present_.count(shape) == 0) missing.emplace_back(fap::kArkitNames[std::size_t(shape)]);
    }
    add_note(head, "shapes of ARKit that it does not have: ", missing);
    add_note(head, "files with unknown names, which are not used: ", unknown);
    add_note(head, "files that are the head at rest: ", still_);
  }

  static void add_note(HeadFile& head, const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) head.source.notes.push_back(what + list_of(names, kMostListed));
  }

  ReadOptions options_;
  head::ObjFile obj_;
  std::vector<Vec3> rest_;                           // by number in the file
  std::vector<std::vector<std::uint32_t>> numbers_;  // by piece and vertex
  std::vector<std::string> names_;                   // of shapes
  std::vector<std::vector<Moved>> morphs_;           // by piece and shape
  std::set<int> present_;                            // of ARKit's shapes
  std::vector<std::string> still_;                   // shapes that move nothing
  std::size_t moves_ = 0;
};

}  // namespace

Result<std::string> read_obj_text(const std::string& path, std::size_t most) {
  Result<std::vector<std::uint8_t>> bytes = tools::read_file(path, most);
  if (!bytes) return bytes.error();
  if (!is_gzip(*bytes)) return tools::read_text_file(path, most);
  Result<std::string> text = gunzip(*bytes, most);
  if (!text) return text.error().in_file(path);
  return text;
}

Result<HeadFile> read_obj_folder(const std::string& folder, ReadOptions options) {
  try {
    Result<HeadFile> head = FolderReader(std::move(options)).read(folder);
    if (!head) return head.error().where.file.empty() ? head.error().in_file(folder) : head.error();
    fs::path name = fs::path(folder).filename();
    if (name.empty()) name = fs::path(folder).parent_path().filename();
    head->source.name = name.string();
    return head;
  } catch (const std::bad_alloc&) {
    return make_error(Code::out_of_range, "there is not enough memory for this head")
        .in_file(folder);
  }
}

}  // namespace animeme::gltf
