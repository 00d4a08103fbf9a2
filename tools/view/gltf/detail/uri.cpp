#include "tools/view/gltf/detail/uri.h"

#include "tools/formats/files/base64.h"

namespace animeme::gltf {
namespace {

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

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

Result<std::vector<std::uint8_t>> resolve(std::string_view uri, const LoadFile& load) {
  if (is_data_uri(uri)) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
      return make_error(Code::syntax, "a data URI is not base64");
    }
    auto bytes = tools::decode_base64(uri.substr(comma + 1));
    if (!bytes) return make_error(Code::syntax, "a data URI is not base64");
    return std::move(*bytes);
  }
  const std::string path = percent_decoded(uri);
  if (!load) {
    return make_error(Code::not_found,
                      "the file needs " + path + " next to it: read it by its path, or use a .glb");
  }
  return load(path);
}

}  // namespace animeme::gltf
