#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

#include "tools/media/live/audio_segments.h"
#include "tools/web/detail/server.h"

namespace animeme::web {
namespace {

constexpr std::size_t kPiece = 16384;           // of a body, at once
constexpr std::size_t kMostFromClient = 65536;  // bytes; clients have nothing to say

Channel channel_of(Resource resource) {
  if (resource == Resource::face) return Channel::face;
  return resource == Resource::faps ? Channel::faps : Channel::audio;
}

bool is_socket(Resource resource) {
  return resource == Resource::face || resource == Resource::faps || resource == Resource::audio;
}

/// Writes `size` bytes with the room that libwebsockets wants in front of them.
bool send_bytes(lws* wsi, const void* bytes, std::size_t size, lws_write_protocol how) {
  std::vector<unsigned char> buffer(LWS_PRE + size);
  std::memcpy(buffer.data() + LWS_PRE, bytes, size);
  return lws_write(wsi, buffer.data() + LWS_PRE, size, how) >= int(size);
}

}  // namespace

int Server::callback(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t size) {
  auto* server = static_cast<Server*>(lws_context_user(lws_get_context(wsi)));
  if (server == nullptr) return 0;
  try {
    return server->handle(wsi, reason, static_cast<const char*>(in), size);
  } catch (...) {  // memory: this client has to go, the server stays
    return -1;
  }
}

int Server::handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return request(wsi, in == nullptr ? std::string() : std::string(in, size));
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return upgrade(wsi);
    case LWS_CALLBACK_ESTABLISHED:
      lws_callback_on_writable(wsi);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return (sessions_[wsi].received += size) > kMostFromClient ? -1 : 0;
    case LWS_CALLBACK_HTTP_BODY:  // of a POST: nobody wants it
      return -1;
    case LWS_CALLBACK_HTTP_WRITEABLE: {
      const auto session = sessions_.find(wsi);
      if (session == sessions_.end()) return 0;
      return session->second.resource == Resource::talk ? write_message(wsi, session->second)
                                                        : write_body(wsi, session->second);
    }
    case LWS_CALLBACK_SERVER_WRITEABLE: {
      const auto session = sessions_.find(wsi);
      return session == sessions_.end() ? -1 : write_message(wsi, session->second);
    }
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      look_around();
      return 0;
    case LWS_CALLBACK_CLOSED:
    case LWS_CALLBACK_CLOSED_HTTP:
    case LWS_CALLBACK_WSI_DESTROY:
      leave(wsi);
      return 0;
    default:
      return 0;
  }
}

bool Server::exists(Resource resource) const {
  if (resource == Resource::none) return false;
  if (resource == Resource::head) return !options_.head_model.empty();
  const bool needs_sound = resource == Resource::audio || resource == Resource::talk;
  return !needs_sound || sample_rate_ > 0;
}

/// A place in the hub. False: all are taken.
bool Server::admit(Session& session) {
  const std::lock_guard lock(mutex_);
  if (finishing_ || hub_.clients() >= std::size_t(options_.max_clients)) return false;
  session.client = hub_.add(channel_of(session.resource));
  session.open = true;
  return true;
}

int Server::refuse(lws* wsi, unsigned status) {
  if (lws_return_http_status(wsi, status, nullptr) != 0) return -1;
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

int Server::request(lws* wsi, const std::string& path) {
  if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) == 0) {
    refuse(wsi, HTTP_STATUS_METHOD_NOT_ALLOWED);
    return -1;  // whatever it wants to send, it stays unread
  }
  const Resource resource = resource_of(path);
  if (!exists(resource)) return refuse(wsi, HTTP_STATUS_NOT_FOUND);
  if (is_socket(resource)) return refuse(wsi, 426);  // upgrade required
  leave(wsi);
  Session& session = sessions_[wsi];
  session.resource = resource;
  if (resource == Resource::talk) {
    if (!admit(session)) return refuse(wsi, HTTP_STATUS_SERVICE_UNAVAILABLE);
    if (!send_header(wsi, "audio/mp4", LWS_ILLEGAL_HTTP_CONTENT_LEN, options_.allow_origin)) {
      return -1;
    }
    lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
  } else {
    const char* type = "application/json";
    if (resource == Resource::page) {
      session.body = page_;
      type = "text/html; charset=utf-8";
    } else if (resource == Resource::head) {
      session.body.assign(options_.head_model.begin(), options_.head_model.end());
      type = "application/octet-stream";
    } else {
      const std::lock_guard lock(mutex_);
      session.body = info_;
    }
    if (!send_header(wsi, type, session.body.size(), options_.allow_origin)) return -1;
  }
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::upgrade(lws* wsi) {
  const Resource resource = resource_of(header_of(wsi, WSI_TOKEN_GET_URI));
  if (!is_socket(resource) || !exists(resource)) return refuse(wsi, HTTP_STATUS_NOT_FOUND), -1;
  if (!may_use(wsi, options_.allow_origin)) return refuse(wsi, HTTP_STATUS_FORBIDDEN), -1;
  leave(wsi);
  Session& session = sessions_[wsi];
  session.resource = resource;
  if (!admit(session)) return refuse(wsi, HTTP_STATUS_SERVICE_UNAVAILABLE), -1;
  return 0;
}

int Server::write_body(lws* wsi, Session& session) {
  const std::size_t size = std::min(kPiece, session.body.size() - session.at);
  const bool last = session.at + size == session.body.size();
  if (!send_bytes(wsi, session.body.data() + session.at, size,
                  last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP)) {
    return -1;
  }
  session.at += size;
  if (!last) {
    lws_callback_on_writable(wsi);
    return 0;
  }
  leave(wsi);
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

bool Server::send_message(lws* wsi, Session& session, const Message& message) {
  if (session.resource != Resource::talk) {
    const lws_write_protocol how = message.text ? LWS_WRITE_TEXT : LWS_WRITE_BINARY;
    return send_bytes(wsi, message.bytes.data(), message.bytes.size(), how);
  }
  std::vector<std::uint8_t> bytes = message.bytes;
  if (message.entry) {  // a segment: the first one begins at 0, for players that wait for it
    const std::int64_t time = std::llround(message.time * sample_rate_);
    if (session.begin < 0) session.begin = time;
    media::set_segment_time(bytes, time - session.begin);
  }
  return send_bytes(wsi, bytes.data(), bytes.size(), LWS_WRITE_HTTP);
}

int Server::write_message(lws* wsi, Session& session) {
  std::unique_lock lock(mutex_);
  const MessagePtr message = hub_.next(session.client);
  const bool more = hub_.waiting(session.client), over = finishing_ && !more;
  lock.unlock();
  if (message && !send_message(wsi, session, *message)) return -1;
  if (!message && over) {
    std::array<unsigned char, 4> reason{'e', 'n', 'd', 0};
    if (session.resource != Resource::talk) {
      lws_close_reason(wsi, LWS_CLOSE_STATUS_NORMAL, reason.data(), 3);
    }
    return -1;
  }
  if (more || over) lws_callback_on_writable(wsi);
  return 0;
}

/// Something was published, or it is over.
void Server::look_around() {
  const std::lock_guard lock(mutex_);
  const auto patience = std::chrono::microseconds(std::int64_t(options_.stall_seconds * 1e6));
  const auto since = Hub::Clock::now() - patience;
  for (auto& [wsi, session] : sessions_) {
    if (!session.open) continue;
    if (hub_.stalled(session.client, since)) {
      lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
    } else if (finishing_ || hub_.waiting(session.client)) {
      lws_callback_on_writable(wsi);
    }
  }
}

void Server::leave(lws* wsi) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end()) return;
  if (session->second.open) {
    const std::lock_guard lock(mutex_);
    hub_.remove(session->second.client);
    changed_.notify_all();
  }
  sessions_.erase(session);
}

}  // namespace animeme::web
