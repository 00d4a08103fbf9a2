#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

#include "tools/media/live/audio_segments.h"
#include "tools/web/detail/server_impl.h"

namespace animeme::web {
namespace {

constexpr std::size_t kPiece = 16384;           // of a body, at once
constexpr std::size_t kMostFromClient = 65536;  // bytes; clients have nothing to say

Channel channel_of(Resource resource) {
  if (resource == Resource::face) return Channel::face;
  return resource == Resource::faps ? Channel::faps : Channel::audio;
}

/// Writes `size` bytes with the room that libwebsockets wants in front of them.
bool send_bytes(lws* wsi, const void* bytes, std::size_t size, lws_write_protocol how) {
  std::vector<unsigned char> buffer(LWS_PRE + size);
  std::memcpy(buffer.data() + LWS_PRE, bytes, size);
  return lws_write(wsi, buffer.data() + LWS_PRE, size, how) >= int(size);
}

}  // namespace

int Server::Impl::callback(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t size) {
  auto* impl = static_cast<Impl*>(lws_context_user(lws_get_context(wsi)));
  if (impl == nullptr) return 0;
  try {
    return impl->handle(wsi, reason, static_cast<const char*>(in), size);
  } catch (...) {  // memory: this client has to go, the server stays
    return -1;
  }
}

int Server::Impl::handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return request(wsi, in == nullptr ? std::string() : std::string(in, size));
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return upgrade(wsi);
    case LWS_CALLBACK_ESTABLISHED:
      lws_callback_on_writable(wsi);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return (sessions[wsi].received += size) > kMostFromClient ? -1 : 0;
    case LWS_CALLBACK_HTTP_BODY:  // of a POST: nobody wants it
      return -1;
    case LWS_CALLBACK_HTTP_WRITEABLE: {
      const auto session = sessions.find(wsi);
      if (session == sessions.end()) return 0;
      return session->second.resource == Resource::talk ? write_talk(wsi, session->second)
                                                        : write_body(wsi, session->second);
    }
    case LWS_CALLBACK_SERVER_WRITEABLE: {
      const auto session = sessions.find(wsi);
      return session == sessions.end() ? -1 : write_message(wsi, session->second);
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

bool Server::Impl::exists(Resource resource) const {
  if (resource == Resource::none) return false;
  if (resource == Resource::head) return !options.head_model.empty();
  const bool needs_sound = resource == Resource::audio || resource == Resource::talk;
  return !needs_sound || sound.sample_rate > 0;
}

/// A place in the hub. False: all are taken.
bool Server::Impl::admit(Session& session) {
  const std::lock_guard lock(mutex);
  if (finishing || hub.clients() >= std::size_t(options.max_clients)) return false;
  session.client = hub.add(channel_of(session.resource));
  session.open = true;
  return true;
}

int Server::Impl::refuse(lws* wsi, unsigned status) {
  if (lws_return_http_status(wsi, status, nullptr) != 0) return -1;
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

int Server::Impl::request(lws* wsi, const std::string& path) {
  if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) == 0) {
    refuse(wsi, HTTP_STATUS_METHOD_NOT_ALLOWED);
    return -1;  // whatever it wants to send, it stays unread
  }
  const Resource resource = resource_of(path);
  if (!exists(resource)) return refuse(wsi, HTTP_STATUS_NOT_FOUND);
  const bool socket =
      resource == Resource::face || resource == Resource::faps || resource == Resource::audio;
  if (socket) return refuse(wsi, 426);  // upgrade required
  leave(wsi);
  Session& session = sessions[wsi];
  session.resource = resource;
  if (resource == Resource::talk) {
    if (!admit(session)) return refuse(wsi, HTTP_STATUS_SERVICE_UNAVAILABLE);
    if (!send_header(wsi, "audio/mp4", LWS_ILLEGAL_HTTP_CONTENT_LEN, options.allow_origin)) {
      return -1;
    }
    lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
  } else {
    const char* type = "application/json";
    if (resource == Resource::page) {
      session.body = page;
      type = "text/html; charset=utf-8";
    } else if (resource == Resource::head) {
      session.body.assign(options.head_model.begin(), options.head_model.end());
      type = "application/octet-stream";
    } else {
      const std::lock_guard lock(mutex);
      session.body = info;
    }
    if (!send_header(wsi, type, session.body.size(), options.allow_origin)) return -1;
  }
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::Impl::upgrade(lws* wsi) {
  const Resource resource = resource_of(header_of(wsi, WSI_TOKEN_GET_URI));
  const bool socket =
      resource == Resource::face || resource == Resource::faps || resource == Resource::audio;
  if (!socket || !exists(resource)) return refuse(wsi, HTTP_STATUS_NOT_FOUND), -1;
  if (!may_use(wsi, options.allow_origin)) return refuse(wsi, HTTP_STATUS_FORBIDDEN), -1;
  leave(wsi);
  Session& session = sessions[wsi];
  session.resource = resource;
  if (!admit(session)) return refuse(wsi, HTTP_STATUS_SERVICE_UNAVAILABLE), -1;
  return 0;
}

int Server::Impl::write_body(lws* wsi, Session& session) {
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

int Server::Impl::write_talk(lws* wsi, Session& session) {
  std::unique_lock lock(mutex);
  const MessagePtr message = hub.next(session.client);
  const bool more = hub.waiting(session.client), over = finishing && !more;
  lock.unlock();
  if (message) {
    std::vector<std::uint8_t> bytes = message->bytes;
    if (message->entry) {  // a segment: the first one begins at 0, for players that wait for it
      const std::int64_t time = std::llround(message->time * sound.sample_rate);
      if (session.begin < 0) session.begin = time;
      media::set_segment_time(bytes, time - session.begin);
    }
    if (!send_bytes(wsi, bytes.data(), bytes.size(), LWS_WRITE_HTTP)) return -1;
  }
  if (more || over) lws_callback_on_writable(wsi);
  return !message && over ? -1 : 0;
}

int Server::Impl::write_message(lws* wsi, Session& session) {
  std::unique_lock lock(mutex);
  const MessagePtr message = hub.next(session.client);
  const bool more = hub.waiting(session.client), over = finishing && !more;
  lock.unlock();
  if (message) {
    const lws_write_protocol how = message->text ? LWS_WRITE_TEXT : LWS_WRITE_BINARY;
    if (!send_bytes(wsi, message->bytes.data(), message->bytes.size(), how)) return -1;
  } else if (over) {
    std::array<unsigned char, 4> reason{'e', 'n', 'd', 0};
    lws_close_reason(wsi, LWS_CLOSE_STATUS_NORMAL, reason.data(), 3);
    return -1;
  }
  if (more || over) lws_callback_on_writable(wsi);
  return 0;
}

/// Something was published, or it is over.
void Server::Impl::look_around() {
  const std::lock_guard lock(mutex);
  const auto patience = std::chrono::microseconds(std::int64_t(options.stall_seconds * 1e6));
  const auto since = Hub::Clock::now() - patience;
  for (auto& [wsi, session] : sessions) {
    if (!session.open) continue;
    if (hub.stalled(session.client, since)) {
      lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
    } else if (finishing || hub.waiting(session.client)) {
      lws_callback_on_writable(wsi);
    }
  }
}

void Server::Impl::leave(lws* wsi) {
  const auto session = sessions.find(wsi);
  if (session == sessions.end()) return;
  if (session->second.open) {
    const std::lock_guard lock(mutex);
    hub.remove(session->second.client);
    changed.notify_all();
  }
  sessions.erase(session);
}

}  // namespace animeme::web
