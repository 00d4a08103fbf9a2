#include "tools/web/detail/requests.h"

#include <array>

namespace animeme::web {
namespace {

// The page carries its own script and style and talks to this server alone.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "connect-src 'self' ws: wss:; media-src 'self' blob:; img-src 'self' data: blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

bool add(lws* wsi, const char* name, const std::string& value, unsigned char** at,
         unsigned char* end) {
  return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                     reinterpret_cast<const unsigned char*>(value.data()),
                                     int(value.size()), at, end) == 0;
}

}  // namespace

Resource resource_of(const std::string& path) {
  if (path == "/" || path == "/index.html") return Resource::page;
  if (path == "/info.json") return Resource::info;
  if (path == "/head.bin") return Resource::head;
  if (path == "/talk.mp4") return Resource::talk;
  if (path == "/face") return Resource::face;
  if (path == "/faps") return Resource::faps;
  if (path == "/audio") return Resource::audio;
  return Resource::none;
}

std::string header_of(lws* wsi, lws_token_indexes token) {
  std::array<char, 513> text{};
  const int size = lws_hdr_copy(wsi, text.data(), int(text.size()), token);
  return size > 0 ? std::string(text.data(), std::size_t(size)) : std::string();
}

bool may_use(lws* wsi, const std::string& allow_origin) {
  if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) == 0) return true;
  const std::string origin = header_of(wsi, WSI_TOKEN_ORIGIN);
  if (allow_origin == "*" || (!origin.empty() && origin == allow_origin)) return true;
  const std::string host = header_of(wsi, WSI_TOKEN_HOST);
  return !host.empty() && (origin == "http://" + host || origin == "https://" + host);
}

bool send_header(lws* wsi, const char* type, lws_filepos_t size, const std::string& allow_origin) {
  std::array<unsigned char, LWS_PRE + 2048> buffer{};
  unsigned char* const begin = buffer.data() + LWS_PRE;
  unsigned char* const end = buffer.data() + buffer.size() - 1;
  unsigned char* at = begin;
  if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, type, size, &at, end) != 0) return false;
  bool added = add(wsi, "cache-control:", "no-store", &at, end) &&
               add(wsi, "x-content-type-options:", "nosniff", &at, end) &&
               add(wsi, "referrer-policy:", "no-referrer", &at, end) &&
               add(wsi, "content-security-policy:", kPolicy, &at, end);
  if (!allow_origin.empty()) {
    added = added && add(wsi, "access-control-allow-origin:", allow_origin, &at, end);
  }
  return added && lws_finalize_write_http_header(wsi, begin, &at, end) == 0;
}

}  // namespace animeme::web
