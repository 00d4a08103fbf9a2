#include "tools/live/web/detail/requests.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <charconv>
#include <cstring>

namespace animeme::web {
namespace {

// The page talks to its server alone, and nothing in it runs that is not one of the server's files;
// one with a head makes a module of what is in them.
std::string policy_of(const Answer& answer) {
  return std::string("default-src 'none'; script-src 'self'") +
         (answer.has_head ? " 'wasm-unsafe-eval'" : "") +
         "; style-src 'self'; connect-src 'self'; media-src 'self' blob:; img-src 'self' data: "
         "blob:; " +
         (answer.has_frames ? "frame-src 'self'; " : "") +
         "base-uri 'none'; form-action 'none'; frame-ancestors " + std::string(answer.frames);
}

/// Value of a header, empty: absent or longer than 512 bytes.
std::string header_of(lws* wsi, lws_token_indexes token) {
  std::array<char, 513> text{};
  const int size = lws_hdr_copy(wsi, text.data(), int(text.size()), token);
  return size > 0 ? std::string(text.data(), std::size_t(size)) : std::string();
}

/// The query: libwebsockets has taken its parts apart.
std::string query_of(lws* wsi) {
  std::string query;
  std::array<char, 513> part{};
  for (int i = 0;
       lws_hdr_copy_fragment(wsi, part.data(), int(part.size()), WSI_TOKEN_HTTP_URI_ARGS, i) > 0;
       ++i) {
    query += (i > 0 ? "&" : "") + std::string(part.data());
  }
  return query.size() <= 512 ? query : std::string();
}

class Header {
 public:
  /// `more`: bytes that it takes beyond the usual.
  Header(lws* wsi, unsigned status, std::size_t more) : wsi_(wsi), buffer_(LWS_PRE + 3072 + more) {
    good_ = lws_add_http_header_status(wsi, status, &at_, end()) == 0;
  }
  void add(const char* name, std::string_view value) {
    good_ =
        good_ && lws_add_http_header_by_name(wsi_, reinterpret_cast<const unsigned char*>(name),
                                             reinterpret_cast<const unsigned char*>(value.data()),
                                             int(value.size()), &at_, end()) == 0;
  }
  void add_length(lws_filepos_t size) {
    good_ = good_ && lws_add_http_header_content_length(wsi_, size, &at_, end()) == 0;
  }
  bool send() {
    return good_ &&
           lws_finalize_write_http_header(wsi_, buffer_.data() + LWS_PRE, &at_, end()) == 0;
  }

 private:
  unsigned char* end() { return buffer_.data() + buffer_.size() - 1; }

  lws* wsi_;
  std::vector<unsigned char> buffer_;
  unsigned char* at_ = buffer_.data() + LWS_PRE;
  bool good_ = false;
};

std::string_view sentence_of(unsigned status) {
  switch (status) {
    case HTTP_STATUS_BAD_REQUEST:
      return "The request names no host, or a header has a blank in front of its colon.\n";
    case HTTP_STATUS_FORBIDDEN:
      return "Pages of other servers need --allow-origin, and viewers may need a ticket.\n";
    case HTTP_STATUS_METHOD_NOT_ALLOWED:
      return "There is GET and HEAD.\n";
    case HTTP_STATUS_REQ_ENTITY_TOO_LARGE:
      return "The request is too long.\n";
    case 411:
      return "The request does not say how long it is (Content-Length).\n";
    case 421:
      return "This server does not go by that name; it is started with --host-name NAME for others "
             "than those of its machine.\n";
    case 426:
      return "This address is a WebSocket.\n";
    case 429:
      return "Too many requests from this address.\n";
    case HTTP_STATUS_SERVICE_UNAVAILABLE:
      return "All places are taken (--max-clients).\n";
    default:
      return "There is nothing here.\n";
  }
}

}  // namespace

Resource resource_of(const std::string& path) {
  if (path == "/" || path == "/index.html") return Resource::page;
  if (path == "/live.css") return Resource::style;
  if (path == "/live.js") return Resource::script;
  if (path == "/head.js") return Resource::head_script;
  if (path == "/head.bin" || path.starts_with("/heads/")) return Resource::head;
  if (path == "/info.json") return Resource::info;
  if (path == "/talk.mp4") return Resource::talk;
  if (path == "/face") return Resource::face;
  if (path == "/faps") return Resource::faps;
  if (path == "/audio") return Resource::audio;
  if (path == "/whep" || path.starts_with("/whep/")) return Resource::whep;
  if (path == "/say") return Resource::say;
  return Resource::none;
}

const char* type_of(Resource resource) {
  switch (resource) {
    case Resource::page:
      return "text/html; charset=utf-8";
    case Resource::style:
      return "text/css; charset=utf-8";
    case Resource::script:
    case Resource::head_script:
      return "text/javascript; charset=utf-8";
    case Resource::info:
      return "application/json";
    case Resource::talk:
      return "audio/mp4";
    default:
      return "application/octet-stream";
  }
}

bool is_socket(Resource resource) {
  return resource == Resource::face || resource == Resource::faps || resource == Resource::audio ||
         resource == Resource::say;
}

Request request_of(lws* wsi) {
  using Method = Request::Method;
  static constexpr struct {
    lws_token_indexes token;
    Method method;
    const char* verb;
  } kMethods[] = {
      {WSI_TOKEN_GET_URI, Method::get, "GET"},
      {WSI_TOKEN_HEAD_URI, Method::head, "GET"},
      {WSI_TOKEN_POST_URI, Method::post, "POST"},
      {WSI_TOKEN_PUT_URI, Method::other, "PUT"},
      {WSI_TOKEN_PATCH_URI, Method::patch, "PATCH"},
      {WSI_TOKEN_DELETE_URI, Method::remove, "DELETE"},
      {WSI_TOKEN_OPTIONS_URI, Method::options, ""},
  };
  Request request;
  for (const auto& known : kMethods) {
    if (lws_hdr_total_length(wsi, known.token) <= 0) continue;
    request.method = known.method;
    request.verb = known.verb;
    request.path = header_of(wsi, known.token);
    break;
  }
  const std::string length = header_of(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH);
  request.has_length = !length.empty();
  if (lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0) {
    request.body = -1;
    request.chunked =
        header_of(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) == "chunked" && length.empty();
  } else if (!length.empty()) {
    const char* end = length.data() + length.size();
    const auto read = std::from_chars(length.data(), end, request.body);
    if (read.ec != std::errc() || read.ptr != end || request.body < 0) request.body = -1;
  }
  request.authorization = header_of(wsi, WSI_TOKEN_HTTP_AUTHORIZATION);
  request.has_origin = lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 0;
  request.origin = header_of(wsi, WSI_TOKEN_ORIGIN);
  request.query = query_of(wsi);
  request.host = header_of(wsi, WSI_TOKEN_HOST);
  request.accept_encoding = header_of(wsi, WSI_TOKEN_HTTP_ACCEPT_ENCODING);
  request.if_none_match = header_of(wsi, WSI_TOKEN_HTTP_IF_NONE_MATCH);
  request.content_type = header_of(wsi, WSI_TOKEN_HTTP_CONTENT_TYPE);
  // RFC 9112, section 5.1. libwebsockets takes them for other headers; a proxy may not.
  for (const std::string_view name : {"host :", "content-length :", "transfer-encoding :",
                                      "authorization :", "origin :", "connection :", "upgrade :"}) {
    request.blank_in_name |= lws_hdr_custom_length(wsi, name.data(), int(name.size())) >= 0;
  }
  return request;
}

std::string extensions_of(lws* wsi) { return header_of(wsi, WSI_TOKEN_EXTENSIONS); }

bool Request::asks(std::string_view name) const {
  const std::string each = "&" + query + "&", own = "&" + std::string(name);
  return each.find(own + "&") != each.npos ||
         (each.find(own + "=") != each.npos && each.find(own + "=0&") == each.npos);
}

bool send_header(lws* wsi, const Answer& answer) {
  Header header(wsi, answer.status, answer.frames.size());
  if (!answer.type.empty()) header.add("content-type:", answer.type);
  if (answer.status == HTTP_STATUS_NOT_MODIFIED) {
  } else if (answer.size != LWS_ILLEGAL_HTTP_CONTENT_LEN) {
    header.add_length(answer.size);
  } else {
    header.add("connection:", "close");
  }
  if (answer.closes && answer.size != LWS_ILLEGAL_HTTP_CONTENT_LEN) {
    header.add("connection:", "close");
  }
  if (answer.packed) header.add("content-encoding:", "gzip");
  if (answer.etag.empty()) {
    header.add("cache-control:", "no-store");
  } else {
    header.add("cache-control:", "no-cache");  // kept, but asked for again each time
    header.add("etag:", answer.etag);
    header.add("vary:", "accept-encoding, origin");
  }
  if (answer.status == HTTP_STATUS_UNAUTHORIZED) header.add("www-authenticate:", "Bearer");
  if (answer.status == HTTP_STATUS_METHOD_NOT_ALLOWED) header.add("allow:", answer.allow);
  if (answer.status == HTTP_STATUS_NO_CONTENT) {  // what pages elsewhere may do
    header.add("access-control-allow-methods:", answer.allow);
    header.add("access-control-allow-headers:", "content-type, authorization");
    header.add("accept-post:", "application/sdp");
  }
  if (answer.retry_after > 0) header.add("retry-after:", std::to_string(answer.retry_after));
  if (!answer.location.empty()) {
    header.add("location:", answer.location);
    header.add("access-control-expose-headers:", "location");
  }
  header.add("x-content-type-options:", "nosniff");
  header.add("referrer-policy:", "no-referrer");
  header.add("content-security-policy:", policy_of(answer));
  header.add("cross-origin-resource-policy:", answer.embedded ? "cross-origin" : "same-origin");
  if (!answer.origin.empty()) header.add("access-control-allow-origin:", answer.origin);
  return header.send();
}

bool send_refusal(lws* wsi, unsigned status, bool with_body, bool as_json, bool closes) {
  std::string text(sentence_of(status));
  if (as_json) text = "{\"error\":\"" + text.substr(0, text.size() - 1) + "\"}\n";
  const char* type = as_json ? "application/json" : "text/plain; charset=utf-8";
  if (!send_header(wsi, {.status = status, .type = type, .size = text.size(), .closes = closes})) {
    return false;
  }
  if (!with_body) return true;
  std::array<unsigned char, LWS_PRE + 256> buffer{};
  std::memcpy(buffer.data() + LWS_PRE, text.data(), text.size());
  return lws_write(wsi, buffer.data() + LWS_PRE, text.size(), LWS_WRITE_HTTP_FINAL) >=
         int(text.size());
}

std::string peer_of(int handle) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getpeername(handle, reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
  if (address.ss_family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    return {reinterpret_cast<const char*>(&four), sizeof four};
  }
  if (address.ss_family != AF_INET6) return {};
  const in6_addr& six = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  const char* bytes = reinterpret_cast<const char*>(&six);
  if (IN6_IS_ADDR_V4MAPPED(&six)) return {bytes + 12, 4};
  return {bytes, 8};
}

}  // namespace animeme::web
