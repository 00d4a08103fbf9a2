#include "tools/view/gltf/detail/file_edit.h"

#include <algorithm>

#include "tools/formats/files/base64.h"
#include "tools/view/gltf/detail/container.h"

namespace animeme::gltf {
namespace {

constexpr int kFloats = 5126;  // as OpenGL calls them

std::size_t add_entry(const Json& there, Json& more, const Json& entry) {
  if (!more.is_array()) more = Json::array();
  more.push_back(entry);
  return (there.is_array() ? there.size() : 0) + more.size() - 1;
}

}  // namespace

Result<FileEdit> FileEdit::open(std::span<const std::uint8_t> bytes, const ReadLimits& limits) {
  const Result<Chunks> chunks = chunks_of(bytes);
  if (!chunks) return chunks.error();
  Result<File> file = open_json(chunks->json, limits);
  if (!file) return file.error();
  FileEdit edit(std::move(*file),
                {reinterpret_cast<const char*>(chunks->json.data()), chunks->json.size()});
  edit.binary_ = glb_length(bytes).has_value();
  edit.chunk_ = chunks->binary;
  edit.others_ = chunks->others;
  return edit;
}

// The binary part of a .glb is its first buffer, if that has no address of its own.
bool FileEdit::extends_binary() const {
  const std::span<const Json> buffers = list(file_.root, "buffers");
  if (!binary_) return false;
  if (buffers.empty()) return !chunk_;
  return chunk_ && member(buffers[0], "uri").is_null();
}

std::size_t FileEdit::chunk_size() const { return chunk_ ? (chunk_->size() + 3) / 4 * 4 : 0; }

std::size_t FileEdit::view(std::span<const std::uint8_t> bytes) {
  data_.resize((data_.size() + 3) / 4 * 4);
  const bool extends = extends_binary();
  const std::size_t offset = data_.size() + (extends ? chunk_size() : 0);
  data_.insert(data_.end(), bytes.begin(), bytes.end());
  return add("bufferViews", {{"buffer", extends ? 0 : list(file_.root, "buffers").size()},
                             {"byteOffset", offset},
                             {"byteLength", bytes.size()}});
}

std::size_t FileEdit::floats(std::span<const float> values, const char* type, bool bounds) {
  const std::string_view kind = type;
  const std::size_t width = kind == "SCALAR" ? 1 : kind == "VEC3" ? 3 : 4;
  Json entry = {{"bufferView",
                 view({reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()})},
                {"componentType", kFloats},
                {"count", values.size() / width},
                {"type", type}};
  if (bounds) {
    entry["min"] = {*std::min_element(values.begin(), values.end())};
    entry["max"] = {*std::max_element(values.begin(), values.end())};
  }
  return add("accessors", entry);
}

std::size_t FileEdit::add(const char* list, const Json& entry) {
  return add_entry(member(file_.root, list), more_[list], entry);
}

void FileEdit::use(const std::string& extension) {
  if (file_.uses(extension)) return;
  for (const Json& name : list(more_, "extensionsUsed")) {
    if (name == extension) return;
  }
  add("extensionsUsed", extension);
}

std::size_t FileEdit::add_to_extension(const std::string& extension, const char* list,
                                       const Json& entry) {
  return add_entry(member(file_.root, "extensions", extension.c_str(), list),
                   more_["extensions"][extension][list], entry);
}

std::size_t FileEdit::add_to_scene(std::size_t scene, const std::string& extension,
                                   const char* list, const Json& entry) {
  return add_entry(member(file_.entry("scenes", scene), "extensions", extension.c_str(), list),
                   more_of_scenes_[scene]["extensions"][extension][list], entry);
}

void FileEdit::replace_matrix(std::size_t node, const std::string& members) {
  const auto nodes = text_.member(text_.root(), "nodes");
  if (!nodes) return;
  const std::vector<JsonText::Span> entries = text_.entries(*nodes);
  if (node >= entries.size()) return;
  if (const auto matrix = text_.member_and_key(entries[node], "matrix")) {
    text_.replace(*matrix, members);
  }
}

// Where the new data is.
void FileEdit::add_buffer() {
  if (data_.empty()) return;
  data_.resize((data_.size() + 3) / 4 * 4);
  if (!extends_binary()) {
    add("buffers", {{"byteLength", data_.size()},
                    {"uri", "data:application/octet-stream;base64," + tools::base64_of(data_)}});
    return;
  }
  const std::size_t size = chunk_size() + data_.size();
  if (list(file_.root, "buffers").empty()) {
    add("buffers", {{"byteLength", size}});
    return;
  }
  const auto buffers = text_.member(text_.root(), "buffers");
  if (!buffers) return;
  const std::vector<JsonText::Span> entries = text_.entries(*buffers);
  if (entries.empty()) return;
  if (const auto length = text_.member(entries[0], "byteLength")) {
    text_.replace(*length, std::to_string(size));
  } else {
    text_.append(entries[0], "\"byteLength\":" + std::to_string(size));
  }
}

// What is there stays, lists grow at their end. False: it is of another kind than what comes.
bool FileEdit::merge(JsonText::Span into, const Json& more) {
  if (text_.at(into) != (more.is_array() ? '[' : '{')) return false;
  if (more.is_array()) {
    for (const Json& entry : more) text_.append(into, sorted_text(entry));
    return true;
  }
  Json by_name = more;
  by_name.sort();
  for (const auto& [key, value] : by_name.items()) {
    if (value.is_null()) continue;
    if (const auto there = text_.member(into, key)) {
      if (!value.is_structured() || !merge(*there, value)) return false;
    } else {
      text_.append(into, quoted_json(key) + ":" + sorted_text(value));
    }
  }
  return true;
}

Result<EditedFile> FileEdit::finish() {
  add_buffer();
  bool fine = merge(text_.root(), more_);
  for (const auto& [scene, more] : more_of_scenes_) {
    const auto scenes = text_.member(text_.root(), "scenes");
    const auto entries = scenes ? text_.entries(*scenes) : std::vector<JsonText::Span>{};
    fine = fine && scene < entries.size() && merge(entries[scene], more);
  }
  if (!fine) {
    return make_error(Code::syntax,
                      "a list of the glTF file is of another kind than the standard says, so that "
                      "nothing can be added: export it again");
  }
  const std::string text = text_.changed();
  EditedFile out;
  if (!binary_) {
    out.front.assign(text.begin(), text.end());
    return out;
  }
  const bool extends = extends_binary();
  const std::size_t binary = chunk_size() + (extends ? data_.size() : 0);
  auto front = glb_front(text, binary, others_.size());
  if (!front) return front.error();
  out.front = std::move(*front);
  if (chunk_) {
    out.middle = *chunk_;
    out.back.resize(chunk_size() - chunk_->size());
  }
  if (extends) out.back.insert(out.back.end(), data_.begin(), data_.end());
  out.back.insert(out.back.end(), others_.begin(), others_.end());
  return out;
}

}  // namespace animeme::gltf
