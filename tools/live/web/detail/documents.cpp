#include "tools/live/web/detail/documents.h"

#include <zlib.h>

#include <array>
#include <cstdio>
#include <utility>

namespace animeme::web {
namespace {

/// Empty: zlib could not.
std::string gzip(const std::string& bytes) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;  // the largest window, and a header of gzip
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    return {};
  }
  std::string out(deflateBound(&stream, uLong(bytes.size())), 0);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(whole ? stream.total_out : 0);
  deflateEnd(&stream);
  return out;
}

}  // namespace

DocumentPtr make_document(std::string bytes) {
  auto document = std::make_shared<Document>();
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto size = uInt(bytes.size());
  std::array<char, 64> tag{};
  std::snprintf(tag.data(), tag.size(), "\"%08lx%08lx-%zx\"", crc32(0, data, size),
                adler32(1, data, size), bytes.size());
  document->etag = tag.data();
  document->packed = gzip(bytes);
  if (document->packed.size() >= bytes.size()) document->packed.clear();
  document->bytes = std::move(bytes);
  return document;
}

}  // namespace animeme::web
