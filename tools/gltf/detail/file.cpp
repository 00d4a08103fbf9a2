#include "tools/gltf/detail/file.h"

#include <algorithm>
#include <array>

#include "tools/gltf/detail/extensions.h"

namespace animeme::gltf {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kHeader = 12;
constexpr std::size_t kChunkHeader = 8;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t(bytes[at]) | std::uint32_t(bytes[at + 1]) << 8 |
         std::uint32_t(bytes[at + 2]) << 16 | std::uint32_t(bytes[at + 3]) << 24;
}

Error cut_off(std::size_t at) {
  return error_at_bit(Code::truncated, "the .glb file ends too early: copy or export it again",
                      std::int64_t(at) * 8);
}

struct Chunks {
  std::span<const std::uint8_t> json;
  std::optional<std::span<const std::uint8_t>> binary;
};

Result<Chunks> chunks_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader + kChunkHeader) return cut_off(bytes.size());
  if (word(bytes, 4) != 2) {
    return error_at_bit(Code::unsupported,
                        "this is glTF " + std::to_string(word(bytes, 4)) +
                            ", only version 2 can be read: export it again as glTF 2.0",
                        32);
  }
  if (word(bytes, 8) > bytes.size()) return cut_off(bytes.size());
  const auto file = bytes.first(word(bytes, 8));
  Chunks chunks;
  std::size_t at = kHeader;
  for (bool is_first = true; at + kChunkHeader <= file.size(); is_first = false) {
    const std::size_t size = word(file, at);
    const std::uint32_t type = word(file, at + 4);
    at += kChunkHeader;
    if (size > file.size() - at) return cut_off(bytes.size());
    if (is_first != (type == kJsonChunk)) {
      return error_at_bit(Code::syntax, "the first part of a .glb file has to be its JSON",
                          std::int64_t(at) * 8);
    }
    if (is_first) chunks.json = file.subspan(at, size);
    if (type == kBinChunk && !chunks.binary) chunks.binary = file.subspan(at, size);
    at += size;
  }
  return chunks;
}

std::array<int, 256> base64_values() {
  std::array<int, 256> values;
  values.fill(-1);
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i) values[std::uint8_t(kDigits[i])] = int(i);
  values['-'] = 62;  // of URLs
  values['_'] = 63;
  return values;
}

Result<Bytes> base64(std::string_view text) {
  static const std::array<int, 256> values = base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = values[std::uint8_t(c)];
    if (value < 0) return make_error(Code::syntax, "a data URI is not base64");
    bits = bits << 6 | std::uint32_t(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(std::uint8_t(bits >> count));
  }
  return out;
}

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool coded =
        text[i] == '%' && i + 2 < text.size() && hex(text[i + 1]) >= 0 && hex(text[i + 2]) >= 0;
    out += coded ? char(hex(text[i + 1]) * 16 + hex(text[i + 2])) : text[i];
    if (coded) i += 2;
  }
  return out;
}

Result<Bytes> buffer_of(const Json& entry, std::size_t index, const Chunks& chunks,
                        const LoadFile& load) {
  const std::string label = "buffer " + std::to_string(index);
  const std::optional<std::size_t> size = whole(member(entry, "byteLength"));
  if (!size) return make_error(Code::syntax, label + " has no byteLength");
  Bytes bytes;
  if (member(entry, "uri").is_string()) {
    Result<Bytes> loaded = resolve(text_or(member(entry, "uri")), load);
    if (!loaded) return loaded;
    bytes = std::move(*loaded);
  } else if (index == 0 && chunks.binary) {
    bytes.assign(chunks.binary->begin(), chunks.binary->end());
  } else if (*size > 0 && !is_fallback_buffer(entry)) {
    return make_error(
        Code::truncated,
        label + " is not in the file: copy it again as a whole, or export it as .glb");
  }
  if (bytes.size() < *size && !is_fallback_buffer(entry)) {
    return make_error(Code::truncated, label + " has " + std::to_string(bytes.size()) + " of its " +
                                           std::to_string(*size) +
                                           " bytes: copy or export it again");
  }
  if (bytes.size() > *size) bytes.resize(*size);
  return bytes;
}

// Beyond a byte order mark and white space JSON begins with a brace.
bool looks_like_json(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes.first(std::min<std::size_t>(bytes.size(), 1000))) {
    if (byte == '{') return true;
    const bool skipped = byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r' ||
                         byte == 0xEF || byte == 0xBB || byte == 0xBF;
    if (!skipped) return false;
  }
  return false;
}

}  // namespace

bool File::uses(std::string_view extension) const {
  for (const Json& entry : list(root, "extensionsUsed")) {
    if (entry.is_string() && entry.get_ref<const std::string&>() == extension) return true;
  }
  return false;
}

Result<Bytes> resolve(const std::string& uri, const LoadFile& load) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    const std::string_view text = uri;
    if (comma == std::string::npos || !text.substr(0, comma).ends_with(";base64")) {
      return make_error(Code::syntax, "a data URI is not base64");
    }
    return base64(text.substr(comma + 1));
  }
  const std::string path = percent_decoded(uri);
  if (!load) {
    return make_error(Code::not_found,
                      "the file needs " + path + " beside it: read it by its path, or use a .glb");
  }
  return load(path);
}

Result<File> open_file(std::span<const std::uint8_t> bytes, const LoadFile& load) {
  Chunks chunks;
  if (bytes.size() >= 4 && word(bytes, 0) == kMagic) {
    Result<Chunks> found = chunks_of(bytes);
    if (!found) return found.error();
    chunks = *found;
  } else if (looks_like_json(bytes)) {
    chunks.json = bytes;
  } else {
    return make_error(Code::syntax, "this is no glTF file: it begins neither as .glb nor as JSON");
  }
  File file;
  file.root = Json::parse(chunks.json.begin(), chunks.json.end(), nullptr, false);
  if (!file.root.is_object()) {
    return make_error(Code::syntax, "the JSON of the glTF file cannot be read: export it again");
  }
  if (!text_or(member(file.root, "asset", "version")).starts_with("2.")) {
    return make_error(Code::unsupported, "only glTF 2.0 can be read: export it again as glTF 2.0");
  }
  if (auto fine = check_extensions(file.root); !fine) return fine.error();
  const std::vector<Json>& buffers = list(file.root, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    Result<Bytes> buffer = buffer_of(buffers[i], i, chunks, load);
    if (!buffer) return buffer.error();
    file.buffers.push_back(std::move(*buffer));
  }
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
                                        " does not lie in its buffer: export the file again");
  }
  return std::span<const std::uint8_t>(file.buffers[buffer]).subspan(offset, *size);
}

}  // namespace animeme::gltf
