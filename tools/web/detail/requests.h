// What a request asks for, and whether it may have it. Nothing here opens a file: every address
// that exists is in this list.
#pragma once

#include <libwebsockets.h>

#include <cstdint>
#include <string>

#include "tools/web/web.h"

namespace animeme::web {

enum class Resource : std::uint8_t { none, page, info, head, talk, face, faps, audio };

/// `path`: as in the request line, without the query.
Resource resource_of(const std::string& path);

/// Value of a header, empty: absent or longer than 512 bytes.
std::string header_of(lws* wsi, lws_token_indexes token);

/// May a page of this origin use the server? Programs that are no browsers send none.
bool may_use(lws* wsi, const std::string& allow_origin);

/// Sends the header of a response; `size` LWS_ILLEGAL_HTTP_CONTENT_LEN: until the connection ends.
/// False: it could not.
bool send_header(lws* wsi, const char* type, lws_filepos_t size, const std::string& allow_origin);

}  // namespace animeme::web
