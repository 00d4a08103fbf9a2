#include "tools/view/gltf/detail/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

namespace animeme::gltf {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;
constexpr std::size_t kInflated = 1 << 18;

struct Inflater {
  z_stream stream{};
  ~Inflater() { inflateEnd(&stream); }
};

}  // namespace

bool is_gzip(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 2 && bytes[0] == 0x1F && bytes[1] == 0x8B;
}

Result<std::string> gunzip(std::span<const std::uint8_t> bytes, std::size_t most) {
  Inflater unpacker;
  z_stream& stream = unpacker.stream;
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) {
    return make_error(Code::out_of_range, "there is not enough memory to unpack it");
  }
  // zlib does not write through this pointer.
  stream.next_in = const_cast<Bytef*>(bytes.data());
  std::size_t left = bytes.size();
  std::string text;
  for (;;) {
    if (stream.avail_in == 0 && left > 0) {
      stream.avail_in = uInt(std::min<std::size_t>(left, std::numeric_limits<uInt>::max()));
      left -= stream.avail_in;
    }
    const std::size_t before = text.size();
    text.resize(before + kInflated);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream.avail_out = uInt(kInflated);
    const int state = inflate(&stream, Z_NO_FLUSH);
    text.resize(before + kInflated - stream.avail_out);
    if (text.size() > most) {
      return make_error(Code::out_of_range,
                        "it is larger than " + std::to_string(most) + " bytes when unpacked");
    }
    if (state == Z_STREAM_END) {
      // Files may be packed in several parts, one behind the other.
      if (stream.avail_in == 0 && left == 0) return text;
      if (inflateReset(&stream) != Z_OK) break;
      continue;
    }
    if (state == Z_BUF_ERROR ||
        (state == Z_OK && stream.avail_in == 0 && left == 0 && stream.avail_out > 0)) {
      return make_error(Code::truncated, "the packed file ends too early; copy it again");
    }
    if (state != Z_OK) break;
  }
  return make_error(Code::syntax, "the packed file is damaged; pack it again with gzip");
}

}  // namespace animeme::gltf
