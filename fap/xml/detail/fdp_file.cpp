#include "fap/xml/detail/fdp_file.h"

#include <algorithm>
#include <map>

#include "fap/detail/text_scanner.h"
#include "fap/xml/detail/numbers.h"

namespace animeme::head::detail {
namespace {

using fap::detail::in_quotes;
using fap::detail::lower_case;

constexpr std::size_t kMostInfluences = 4'000'000;

class Loader {
 public:
  Loader(const XmlElement& root, const LoadMeshFile& load) : root_(root), load_(load) {}

  Result<FdpFile> run() {
    if (auto done = read_fapu(); !done) return done.error();
    if (auto done = read_entities(); !done) return done.error();
    for (const XmlElement& child : root_.children) {
      if (child.name != "fdp") continue;
      if (auto done = read_item(child); !done) return done.error();
    }
    if (items_ > 0 && file_.items.empty()) {
      return root_.error(
          Code::not_found,
          "no <fdp> refers to a mesh of the entity Rest; its meshes are " + mesh_names());
    }
    if (homeless_ > 0) {
      file_.notes.push_back(
          std::to_string(homeless_) +
          " <fdp> elements refer to meshes that are not in the entity Rest; ignored");
    }
    return std::move(file_);
  }

 private:
  Result<void> read_fapu() {
    const XmlElement* head = root_.child("head");
    const XmlElement* fapu = head == nullptr ? nullptr : head->child("fapu");
    if (fapu == nullptr) {
      file_.notes.push_back("the file has no <fapu>; measured on its feature points");
      return {};
    }
    const std::pair<const char*, double*> fields[] = {{"ES0", &file_.fapu.es},
                                                      {"IRISD0", &file_.fapu.irisd},
                                                      {"ENS0", &file_.fapu.ens},
                                                      {"MNS0", &file_.fapu.mns},
                                                      {"MW0", &file_.fapu.mw}};
    for (const auto& [name, value] : fields) {
      const auto number = number_in(*fapu, name);
      if (!number) return number.error();
      *value = number->value_or(0);
      if (*value < 0 || *value > 1e9) {
        return fapu->error(Code::out_of_range, std::string(name) + " has to be a length");
      }
    }
    return {};
  }

  // The entity that shows the neutral face.
  const XmlElement* find_rest(const XmlElement& source) {
    for (const std::string_view wanted : {"rest", "neutral"}) {
      for (const XmlElement& entity : source.children) {
        const std::string* alias = entity.attribute("alias");
        if (entity.name == "entity" && alias != nullptr && lower_case(*alias) == wanted)
          return &entity;
      }
    }
    return nullptr;
  }

  Result<void> read_entities() {
    const XmlElement* source = root_.child("source");
    if (source == nullptr) return root_.error(Code::syntax, "<xfdp> has no <source>");
    const XmlElement* rest = find_rest(*source);
    if (rest == nullptr) {
      return source->error(Code::not_found, "no <entity> has the alias \"Rest\"");
    }
    if (auto done = load_fdp_meshes(*rest, load_, file_); !done) return done;
    for (std::size_t m = 0; m < file_.meshes.size(); ++m) {
      for (const std::string& name : file_.meshes[m].names) mesh_of_.try_emplace(name, m);
    }
    for (const XmlElement& bind : rest->children) {
      if (bind.name != "bind") continue;
      if (auto done = read_binding(bind); !done) return done;
    }
    std::size_t others = 0;
    for (const XmlElement& entity : source->children) {
      others += entity.name == "entity" && &entity != rest ? 1 : 0;
    }
    if (others > 0) {
      file_.notes.push_back(
          std::to_string(others) +
          " visemes, expressions and modifiers given as whole meshes are not used; FAP "
          "1 and 2 are shown by the built-in shapes");
    }
    return {};
  }

  FdpMesh* find_mesh(const std::string* name) {
    if (name == nullptr) return nullptr;
    const auto found = mesh_of_.find(*name);
    return found == mesh_of_.end() ? nullptr : &file_.meshes[found->second];
  }
  std::string mesh_names() const {
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(file_.meshes.size(), 12); ++i) {
      names += (i > 0 ? ", " : "") + file_.meshes[i].names.back();
    }
    return names.empty() ? "none" : names;
  }

  Result<void> read_binding(const XmlElement& bind) {
    const std::string* item = bind.attribute("item");
    FdpMesh* mesh = find_mesh(bind.attribute("submesh"));
    if (item == nullptr || mesh == nullptr) {
      file_.notes.push_back("line " + std::to_string(bind.line) +
                            ": <bind> refers to no mesh of the entity Rest; ignored");
      return {};
    }
    // A binding is the better name: "alice.wrl_1" says nothing. Parts of an .obj have their own.
    if (mesh->names.size() == 1 && !mesh->where.empty() && mesh->where[0].vertex != kMissing) {
      mesh->binding = *item;
      file_.pieces[mesh->where[0].piece].name = *item;
    }
    const bool left = *item == "LeftEye";
    if (!left && *item != "RightEye") return {};
    Vec3 pivot;
    const std::pair<const char*, float*> fields[] = {
        {"pivotX", &pivot.x}, {"pivotY", &pivot.y}, {"pivotZ", &pivot.z}};
    bool any = false;
    for (const auto& [name, value] : fields) {
      const auto number = number_in(bind, name);
      if (!number) return number.error();
      any = any || *number;
      *value = float(number->value_or(0));
    }
    if (any) file_.eyes[left ? 0 : 1] = eye_centre(*mesh, pivot);
    return {};
  }

  // Xface moves the eye by -pivot, turns it and moves it back by pivot, so the pivot of its files
  // is the centre with all signs turned. Of both the one that is nearer to the middle of the mesh.
  static Vec3 eye_centre(const FdpMesh& mesh, Vec3 pivot) {
    const auto& places = mesh.positions;
    Vec3 sum;
    for (const Vec3& p : places) sum += p;
    const Vec3 middle = places.empty() ? sum : sum * (1 / float(places.size()));
    const Vec3 turned = mesh.place(pivot * -1.0f);
    const Vec3 plain = mesh.place(pivot);
    return length(turned - middle) <= length(plain - middle) ? turned : plain;
  }

  Result<void> read_item(const XmlElement& element) {
    ++items_;
    const FdpMesh* mesh = find_mesh(element.attribute("affects"));
    if (mesh == nullptr) {
      ++homeless_;
      return {};
    }
    const std::size_t count = mesh->positions.size();
    if (count == 0)
      return element.error(Code::out_of_range, "the mesh " + mesh->names.front() + " is empty");
    XfaceItem item;
    item.mesh = std::size_t(mesh - file_.meshes.data());
    if (const std::string* name = element.attribute("name")) item.name = *name;
    const auto pivot = index_in(element, "index", std::uint32_t(count - 1));
    if (!pivot) return wrong_mesh(pivot.error(), *mesh);
    item.pivot = *pivot;
    for (const XmlElement& child : element.children) {
      Result<void> done;
      if (child.name == "indices") done = read_region(child, *mesh, item);
      if (child.name == "influence") done = read_influence(child, item);
      if (!done) return done;
    }
    std::sort(item.region.begin(), item.region.end());
    item.region.erase(std::unique(item.region.begin(), item.region.end()), item.region.end());
    influences_ += item.region.size() * item.influences.size();
    if (influences_ > kMostInfluences) {
      return element.error(
          Code::out_of_range,
          "the file has more than 4 million influences; reduce its meshes or regions");
    }
    file_.items.push_back(std::move(item));
    return {};
  }

  static Error wrong_mesh(Error error, const FdpMesh& mesh) {
    if (error.code == Code::out_of_range) {
      error.message += "; the mesh " + mesh.names.front() + " has " +
                       std::to_string(mesh.positions.size()) +
                       " vertices (is it the one that the .fdp was made for?)";
    }
    return error;
  }

  static Result<void> read_region(const XmlElement& element, const FdpMesh& mesh, XfaceItem& item) {
    const auto numbers = number_list(element, "<indices>", element.text);
    if (!numbers) return numbers.error();
    const std::size_t count = mesh.positions.size();
    for (const double n : *numbers) {
      if (n != std::floor(n)) {
        return element.error(Code::syntax, "<indices> has an invalid vertex index");
      }
      if (n < 0 || n >= double(count)) {
        return wrong_mesh(element.error(Code::out_of_range,
                                        "<indices> names a vertex that does not "
                                        "exist"),
                          mesh);
      }
      item.region.push_back(std::uint32_t(n));
    }
    return {};
  }

  Result<void> read_influence(const XmlElement& element, XfaceItem& item) {
    const auto fap = index_in(element, "fap", fap::kFapCount - 1);
    if (!fap) {
      Error error = fap.error();
      error.message += " (FAP 1 is number 0 there)";
      return error;
    }
    const auto weight = number_in(element, "weight");
    if (!weight) return weight.error();
    const std::string* type = element.attribute("type");
    const auto reach = type == nullptr ? kReachNames.end()
                                       : std::find(kReachNames.begin(), kReachNames.end(), *type);
    if (reach == kReachNames.end()) {
      file_.notes.push_back("line " + std::to_string(element.line) + ": influence of the type " +
                            in_quotes(type == nullptr ? "" : *type) + " is unknown; left out");
      return {};
    }
    XfaceInfluence influence;
    influence.fap = int(*fap) + 1;
    influence.reach = Reach(reach - kReachNames.begin());
    influence.weight = float(weight->value_or(0));
    if (!(std::abs(influence.weight) < 1e6f)) {
      return element.error(Code::out_of_range, "attribute weight of <influence> is too large");
    }
    if (influence.weight != 0) item.influences.push_back(influence);
    return {};
  }

  const XmlElement& root_;
  const LoadMeshFile& load_;
  FdpFile file_;
  std::map<std::string, std::size_t> mesh_of_;  // by name
  std::size_t items_ = 0;
  std::size_t influences_ = 0;  // on vertices
  std::size_t homeless_ = 0;
};

}  // namespace

Result<FdpFile> load_fdp(std::string_view text, const LoadMeshFile& load) {
  const auto root = parse_xml(text);
  if (!root) return root.error();
  if (root->name != "xfdp") {
    return root->error(Code::syntax, "the root element is <" + root->name +
                                         ">, not <xfdp>: this is not an Xface file");
  }
  return Loader(*root, load).run();
}

}  // namespace animeme::head::detail
