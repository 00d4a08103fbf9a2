#include "tools/characters/crossmap/project.h"

// What it asserts of input, it also reports as an error.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace animeme::crossmap {
namespace {

Error wrong(const toml::node& node, const std::string& what) {
  const auto at = node.source().begin;
  return error_at_line(Code::syntax, what, std::int64_t(at.line), std::int64_t(at.column));
}

// Reads the words of one table of the project; the first error stays.
class Section {
 public:
  Section(const toml::table& table, std::string name, std::string folder)
      : table_(table), name_(std::move(name)), folder_(std::move(folder)) {}

  const toml::node* find(const char* word) {
    known_.emplace_back(word);
    return table_.get(word);
  }
  void fail(const toml::node& node, const std::string& what) {
    if (!error_) error_ = wrong(node, what);
  }
  void read(const char* word, std::string& out) {
    const toml::node* node = find(word);
    if (node == nullptr) return;
    if (const auto* text = node->as_string()) {
      out = text->get();
    } else if (node->is_number()) {  // rate = 25
      const double value = node->value_or(0.0);
      out = std::to_string(value);
      while (out.ends_with('0')) out.pop_back();
      if (out.ends_with('.')) out.pop_back();
    } else {
      fail(*node, full(word) + " is a text in quotes");
    }
  }
  void read_path(const char* word, std::string& out) {
    read(word, out);
    out = path(out);
  }
  void read(const char* word, double& out, double least, double most) {
    const toml::node* node = find(word);
    if (node == nullptr) return;
    const auto value = node->value<double>();
    if (!node->is_number() || !value || !(*value >= least && *value <= most)) {
      char text[80];
      std::snprintf(text, sizeof text, " is a number from %g to %g", least, most);
      return fail(*node, full(word) + text);
    }
    out = *value;
  }
  void read(const char* word, std::size_t& out, std::size_t most) {
    double value = double(out);
    read(word, value, 0, double(most));
    if (value != std::floor(value))
      return fail(*table_.get(word), full(word) + " is a whole number");
    out = std::size_t(value);
  }
  void read(const char* word, bool& out) {
    const toml::node* node = find(word);
    if (node == nullptr) return;
    if (!node->is_boolean()) return fail(*node, full(word) + " is true or false");
    out = node->value_or(out);
  }
  void read(const char* word, std::vector<std::string>& out) {
    if (const toml::node* node = find(word)) out = texts(*node, full(word));
  }
  void read_paths(const char* word, std::vector<std::string>& out) {
    read(word, out);
    for (std::string& one : out) one = path(one);
  }
  std::vector<std::string> texts(const toml::node& node, const std::string& what) {
    std::vector<std::string> out;
    const toml::array* list = node.as_array();
    if (list == nullptr) {
      if (const auto* text = node.as_string()) return {text->get()};
      fail(node, what + " is a list of texts, such as [\"a\", \"b\"]");
      return out;
    }
    for (const toml::node& one : *list) {
      if (const auto* text = one.as_string()) {
        out.push_back(text->get());
      } else {
        fail(one, what + " is a list of texts, such as [\"a\", \"b\"]");
      }
    }
    return out;
  }
  const toml::table* table(const char* word) {
    const toml::node* node = find(word);
    if (node != nullptr && !node->is_table()) fail(*node, full(word) + " is a table");
    return node == nullptr ? nullptr : node->as_table();
  }
  const toml::array* list(const char* word) {
    const toml::node* node = find(word);
    if (node != nullptr && !node->is_array()) fail(*node, full(word) + " is a list");
    return node == nullptr ? nullptr : node->as_array();
  }
  std::string path(const std::string& name) const {
    if (name.empty() || folder_.empty() || name == "-") return name;
    return (std::filesystem::path(folder_) / name).string();
  }
  std::string full(const char* word) const {
    return name_.empty() ? word : "[" + name_ + "] " + word;
  }
  /// The first error, or a word that nobody asked for.
  Result<void> finish() {
    if (error_) return *error_;
    for (const auto& [key, node] : table_) {
      const std::string word(key.str());
      if (std::find(known_.begin(), known_.end(), word) != known_.end()) continue;
      std::string words;
      for (const std::string& k : known_) words += (words.empty() ? "" : ", ") + k;
      return wrong(node,
                   full(word.c_str()) + " is not a key of a project; known keys are " + words);
    }
    return {};
  }

 private:
  const toml::table& table_;
  std::string name_, folder_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

void read_pairs(Section& section, const char* word,
                std::vector<std::pair<std::string, std::string>>& out) {
  const toml::array* list = section.list(word);
  if (list == nullptr) return;
  for (const toml::node& one : *list) {
    const auto pair = section.texts(one, section.full(word));
    if (pair.size() != 2) return section.fail(one, section.full(word) + " are pairs of points");
    out.emplace_back(pair[0], pair[1]);
  }
}

Result<void> read_capture(const toml::table& table, const std::string& folder, Project& out) {
  Section in(table, "capture", folder);
  in.read("rate", out.rate);
  in.read("size", out.size);
  in.read("layout", out.layout);
  in.read("axes", out.axes);
  in.read("unit", out.unit);
  in.read("neutral", out.neutral);
  if (const std::string file = in.path(out.neutral); std::filesystem::exists(file)) {
    out.neutral = file;
  }
  in.read("points", out.points);
  in.read("head", out.head);
  read_pairs(in, "contacts", out.contacts);
  if (const toml::table* face = in.table("face")) {
    for (const auto& [id, node] : *face) {
      for (const std::string& point : in.texts(node, in.full("face"))) {
        out.face.emplace_back(std::string(id.str()), point);
      }
    }
  }
  if (const toml::table* fapu = in.table("fapu")) {
    for (const auto& [unit, node] : *fapu) {
      const auto value = node.value<double>();
      if (!value || !node.is_number()) in.fail(node, "a FAP unit is a number");
      out.fapu[std::string(unit.str())] = value.value_or(0);
    }
  }
  if (const toml::table* regions = in.table("regions")) {
    for (const auto& [name, node] : *regions) {
      NamedRegion region{std::string(name.str()), {}, 1};
      if (const toml::table* more = node.as_table()) {
        Section one(*more, "capture.regions." + region.name, folder);
        one.read("points", region.points);
        one.read("weight", region.weight, 0, 1e6);
        if (auto ok = one.finish(); !ok) return ok;
      } else {
        region.points = in.texts(node, in.full("regions"));
      }
      out.regions.push_back(std::move(region));
    }
  }
  return in.finish();
}

Result<void> read_keys(const toml::table& table, const std::string& folder, Project& out) {
  Section in(table, "keys", folder);
  in.read("count", out.search.count, 200);
  double preference = 1;
  in.read("preference", preference, -1e300, 0);
  if (preference <= 0) out.search.preference = preference;
  in.read("damping", out.search.damping, 0.5, 0.99);
  in.read("frames", out.search.most_frames, 4000);
  in.read_path("from", out.keys);
  if (const toml::array* named = in.list("named")) {
    for (const toml::node& node : *named) {
      const toml::table* one = node.as_table();
      if (one == nullptr) {
        in.fail(node, "[keys] named is a list such as [{name = \"M\", time = 1.24}]");
        continue;
      }
      Section key(*one, "keys.named", folder);
      NamedKey made;
      key.read("name", made.name);
      key.read_path("input", made.input);
      key.read("time", made.seconds, 0, 1e6);
      if (auto ok = key.finish(); !ok) return ok;
      out.named.push_back(std::move(made));
    }
  }
  return in.finish();
}

}  // namespace

Result<Project> read_project(std::string_view toml, const std::string& folder) {
  try {
    const toml::table table = toml::parse(toml);
    Project out;
    Section in(table, "", folder);
    in.read_paths("inputs", out.inputs);
    if (const toml::table* capture = in.table("capture")) {
      if (auto ok = read_capture(*capture, folder, out); !ok) return ok.error();
    }
    if (const toml::table* keys = in.table("keys")) {
      if (auto ok = read_keys(*keys, folder, out); !ok) return ok.error();
    }
    if (const toml::table* fit = in.table("fit")) {
      Section one(*fit, "fit", folder);
      one.read("contact_weight", out.fit.contact_weight, 0, 1e6);
      one.read("convex", out.fit.convex);
      one.read("ridge", out.fit.ridge, 0, 1);
      one.read("smooth", out.fit.smooth, 0, 1);
      one.read("control_ridge", out.controls_fit.ridge, 0, 1);
      if (auto ok = one.finish(); !ok) return ok.error();
    }
    if (const toml::table* target = in.table("target")) {
      Section one(*target, "target", folder);
      one.read("to", out.to);
      if (const std::string file = one.path(out.to); std::filesystem::exists(file)) out.to = file;
      one.read_path("points", out.head_points);
      one.read_paths("shapes", out.shapes);
      one.read("controls", out.controls);
      if (auto ok = one.finish(); !ok) return ok.error();
    }
    if (auto ok = in.finish(); !ok) return ok.error();
    return out;
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    return error_at_line(Code::syntax, std::string(error.description()), std::int64_t(at.line),
                         std::int64_t(at.column));
  }
}

}  // namespace animeme::crossmap
