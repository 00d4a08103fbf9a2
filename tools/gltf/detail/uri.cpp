#include "tools/gltf/detail/uri.h"

#include <array>

namespace animeme::gltf {
namespace {

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

Result<std::vector<std::uint8_t>> base64(std::string_view text) {
  static const std::array<int, 256> values = base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::uint8_t> out;
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

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

Result<std::vector<std::uint8_t>> resolve(std::string_view uri, const LoadFile& load) {
  if (is_data_uri(uri)) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
      return make_error(Code::syntax, "a data URI is not base64");
    }
    return base64(uri.substr(comma + 1));
  }
  const std::string path = percent_decoded(uri);
  if (!load) {
    return make_error(Code::not_found,
                      "the file needs " + path + " beside it: read it by its path, or use a .glb");
  }
  return load(path);
}

}  // namespace animeme::gltf
