#include "tools/view/gltf/detail/file.h"

#include <map>

#include "tools/view/gltf/detail/container.h"
#include "tools/view/gltf/detail/extensions.h"
#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {
namespace {

// Opens the buffers of a file; those with the same URI are one.
class BufferReader {
 public:
  BufferReader(File& file, const Chunks& chunks, const LoadFile& load)
      : file_(file), chunks_(chunks), load_(load) {}

  Result<void> read() {
    const std::size_t count = list(file_.root, "buffers").size();
    for (std::size_t i = 0; i < count; ++i) {
      if (auto done = add(file_.root["buffers"][i], i); !done) return done;
    }
    return {};
  }

 private:
  Result<void> add(Json& entry, std::size_t index) {
    const std::string label = "buffer " + std::to_string(index);
    const std::optional<std::size_t> size = whole(member(entry, "byteLength"));
    if (!size) return make_error(Code::syntax, label + " has no byteLength");
    std::span<const std::uint8_t> bytes;
    if (member(entry, "uri").is_string()) {
      auto loaded = load(entry["uri"].text());
      if (!loaded) return loaded.error();
      bytes = *loaded;
    } else if (index == 0 && chunks_.binary) {
      bytes = *chunks_.binary;
    } else if (*size > 0 && !is_fallback_buffer(entry)) {
      return make_error(
          Code::truncated,
          label + " is not in the file: copy it again as a whole, or export it as .glb");
    }
    if (bytes.size() < *size && !is_fallback_buffer(entry)) {
      return make_error(Code::truncated, label + " has " + std::to_string(bytes.size()) +
                                             " of its " + std::to_string(*size) +
                                             " bytes: copy or export it again");
    }
    file_.buffers.push_back(bytes.first(std::min(bytes.size(), *size)));
    return {};
  }

  // What a data URI stands for takes its place.
  Result<std::span<const std::uint8_t>> load(std::string& uri) {
    const bool elsewhere = !is_data_uri(uri);
    if (const auto known = loaded_.find(uri); elsewhere && known != loaded_.end()) {
      return known->second;
    }
    Result<Bytes> bytes = resolve(uri, load_);
    if (!bytes) return bytes.error();
    if (auto fine = file_.budget->take_bytes(bytes->size()); !fine) return fine.error();
    file_.owned.push_back(std::move(*bytes));
    const std::span<const std::uint8_t> all = file_.owned.back();
    if (elsewhere) {
      loaded_.emplace(uri, all);
    } else {
      uri = std::string();
    }
    return all;
  }

  File& file_;
  const Chunks& chunks_;
  const LoadFile& load_;
  std::map<std::string, std::span<const std::uint8_t>> loaded_;
};

}  // namespace

bool File::uses(std::string_view extension) const {
  for (const Json& entry : gltf::list(root, "extensionsUsed")) {
    if (entry.is_string() && entry.text() == extension) return true;
  }
  return false;
}

Result<File> open_json(std::span<const std::uint8_t> json, const ReadLimits& limits) {
  const std::string_view text(reinterpret_cast<const char*>(json.data()), json.size());
  if (auto fine = check_values(text); !fine) return fine.error();
  File file;
  file.budget = std::make_unique<Budget>(limits);
  if (Result<Json> root = Json::parse(text, {.sorted = true})) file.root = std::move(*root);
  if (!file.root.is_object()) {
    return make_error(Code::syntax, "the JSON of the glTF file cannot be read: export it again");
  }
  if (!text_or(member(file.root, "asset", "version")).starts_with("2.")) {
    return make_error(Code::unsupported, "only glTF 2.0 can be read: export it again as glTF 2.0");
  }
  return file;
}

Result<File> open_file(std::span<const std::uint8_t> bytes, const LoadFile& load,
                       const ReadLimits& limits) {
  const Result<Chunks> chunks = chunks_of(bytes);
  if (!chunks) return chunks.error();
  Result<File> file = open_json(chunks->json, limits);
  if (!file) return file;
  if (auto fine = check_extensions(file->root); !fine) return fine.error();
  if (auto done = BufferReader(*file, *chunks, load).read(); !done) return done.error();
  if (auto done = unpack_meshopt(*file); !done) return done.error();
  if (auto done = unpack_draco(*file); !done) return done.error();
  return file;
}

Result<std::span<const std::uint8_t>> view_of(const File& file, std::size_t view) {
  const Json& entry = file.entry("bufferViews", view);
  const std::size_t buffer = whole_or(member(entry, "buffer"), file.buffers.size());
  const std::size_t offset = whole_or(member(entry, "byteOffset"), 0);
  const std::optional<std::size_t> size = whole(member(entry, "byteLength"));
  if (buffer >= file.buffers.size() || !size || offset > file.buffers[buffer].size() ||
      *size > file.buffers[buffer].size() - offset) {
    if (is_compressed(entry)) return compressed_error("EXT_meshopt_compression");
    return make_error(Code::syntax, "buffer view " + std::to_string(view) +
                                        " is outside its buffer: export the file again");
  }
  return file.buffers[buffer].subspan(offset, *size);
}

}  // namespace animeme::gltf
