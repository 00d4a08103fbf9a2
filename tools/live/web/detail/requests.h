// What a request asks for, and how it is answered. Nothing here opens a file: every address that
// exists is in this list.
#pragma once

#include <libwebsockets.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/live/web/detail/documents.h"

namespace animeme::web {

enum class Resource : std::uint8_t {
  none,
  page,
  style,
  script,
  head_script,
  head,
  info,
  talk,
  face,
  faps,
  audio,
  whep,
  say
};

/// `path`: as in the request line, without the query.
Resource resource_of(const std::string& path);
/// Media type of what is served whole.
const char* type_of(Resource resource);
bool is_socket(Resource resource);

/// The part of a request that counts here. Values are empty if they are absent or longer than 512
/// bytes.
struct Request {
  enum class Method : std::uint8_t { get, head, post, patch, remove, options, other };
  Method method = Method::other;
  bool is_read() const { return method == Method::get || method == Method::head; }
  bool has_origin = false;
  /// "GET", also for HEAD; "POST", "PUT", "PATCH", "DELETE"; empty: another method
  std::string verb;
  bool has_length = false;  ///< it says how many bytes are to follow
  std::int64_t body = 0;    ///< in bytes; -1: unknown
  std::string authorization;
  std::string path, query, host, origin, accept_encoding, if_none_match, content_type;
  bool chunked = false;        ///< the body comes in chunks
  bool blank_in_name = false;  ///< a header has a blank in front of its colon

  /// Is `name` in the query, as itself or with a value but 0?
  bool asks(std::string_view name) const;
};
Request request_of(lws* wsi);

/// Sec-WebSocket-Extensions.
std::string extensions_of(lws* wsi);

/// The header of an answer; what is empty is left out.
struct Answer {
  unsigned status = HTTP_STATUS_OK;
  std::string type;
  lws_filepos_t size = 0;  ///< LWS_ILLEGAL_HTTP_CONTENT_LEN: until the connection ends
  std::string etag;        ///< caches may keep it and ask whether there is another version
  bool packed = false;     ///< by gzip
  std::string origin;      ///< pages there may read it; "*": all
  bool embedded = false;   ///< pages elsewhere may show it without reading it
  std::string_view frames =
      "'self'";             ///< origins of pages that may have it in a frame, a blank between them
  bool has_head = false;    ///< a page that shows a head
  bool has_frames = false;  ///< a page that shows others of this server
  bool closes = false;      ///< the connection ends behind this
  std::string location;     ///< of what was made
  std::string allow = "GET, HEAD";  ///< 405, 204: what there is
  int retry_after = 0;              ///< 429, 503: seconds; 0: not said
};

/// False: it could not be sent.
bool send_header(lws* wsi, const Answer& answer);
/// Answers with a status and a sentence. The connection is to be closed if this is false; `closes`
/// says that it will be in any case.
bool send_refusal(lws* wsi, unsigned status, bool with_body, bool as_json = false,
                  bool closes = false);

/// Who is at the other end of a socket: an address of IPv4 or the network of one of IPv6, whose
/// owner has all of it, as bytes. Empty: not known.
std::string peer_of(int handle);

}  // namespace animeme::web
