#include "tools/view/viewer/detail/bytes.h"

#include <zlib.h>

#include <algorithm>

namespace animeme::viewer::detail {

std::string text_of(const tools::Json& json) { return json.dump(-1, true); }

std::vector<std::uint8_t> with_header(const tools::Json& header, const Bytes& rest) {
  const std::string json = text_of(header);
  const auto size = std::uint32_t(json.size());
  Bytes length;
  length.u32(size);
  std::vector<std::uint8_t> out = length.data();
  out.insert(out.end(), json.begin(), json.end());
  out.insert(out.end(), rest.data().begin(), rest.data().end());
  return out;
}

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = ::compressBound(uLong(bytes.size()));
  std::vector<std::uint8_t> out(size);
  // With room for the worst case, memory alone can be missing; then the result would be empty.
  if (::compress2(out.data(), &size, bytes.data(), uLong(bytes.size()), 9) != Z_OK) size = 0;
  out.resize(size);
  return out;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

}  // namespace animeme::viewer::detail
