#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "tools/formats/media/live/audio_segments.h"
#include "tools/live/web/detail/server.h"

namespace animeme::web {
namespace {

constexpr lws_usec_t kLookEvery = 250'000;      // microseconds
constexpr std::size_t kPiece = 16384;           // of a body, at once
constexpr std::size_t kMostFromClient = 65536;  // bytes; clients have nothing to say

Channel channel_of(const Session& session) {
  if (session.resource == Resource::say) return Channel::owner;
  if (session.resource == Resource::face) return session.as_sent ? Channel::sent : Channel::face;
  if (session.resource != Resource::faps) return Channel::audio;
  return session.small ? Channel::planes : Channel::faps;
}

/// Writes `size` bytes with the room that libwebsockets wants in front of them.
bool send_bytes(lws* wsi, const void* bytes, std::size_t size, lws_write_protocol how) {
  std::vector<unsigned char> buffer(LWS_PRE + size);
  std::memcpy(buffer.data() + LWS_PRE, bytes, size);
  return lws_write(wsi, buffer.data() + LWS_PRE, size, how) >= int(size);
}

/// Of a client whose messages are deflated: 40 kB, not the 270 kB of zlib's own choice. A window of
/// 4 kB has the dozen planes before, and more make nothing smaller.
void set_deflate(lws* wsi) {
  for (const auto& [name, value] : {std::pair{"server_max_window_bits", "12"},
                                    {"mem_level", "5"},
                                    {"compression_level", "6"},
                                    {"tx_buf_size", "13"}}) {
    (void)lws_set_extension_option(wsi, "permessage-deflate", name, value);
  }
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
    case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:  // `in` is the handle
      entering_ = peer_of(int(reinterpret_cast<std::intptr_t>(in)));
      return limiter_.may_enter(entering_) ? 0 : -1;
    case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED:
      limiter_.enter(wsi, entering_, ConnectionLimiter::Clock::now());
      disconnect_overdue();
      return 0;
    case LWS_CALLBACK_HTTP:
      return request(wsi);
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return upgrade(wsi);
    case LWS_CALLBACK_CONFIRM_EXTENSION_OKAY:
      return may_deflate(wsi) ? 0 : 1;
    case LWS_CALLBACK_ESTABLISHED:
      set_deflate(wsi);
      lws_callback_on_writable(wsi);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      if (sessions_[wsi].intake) return take_message(wsi, in, size);
      return (sessions_[wsi].received += size) > kMostFromClient ? -1 : 0;
    case LWS_CALLBACK_HTTP_BODY:
      return waits_for_peer_connections(wsi) ? whep_body(wsi, in, size) : take_body(wsi, in, size);
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
      return body_over(wsi);
    case LWS_CALLBACK_HTTP_WRITEABLE: {
      const auto session = sessions_.find(wsi);
      if (session == sessions_.end()) return 0;
      if (session->second.late) return serve_late(session->second);
      if (session->second.reply) return write_reply(wsi, session->second);
      if (session->second.resource == Resource::whep) return whep_answer(wsi, session->second);
      return session->second.resource == Resource::talk ? write_message(wsi, session->second)
                                                        : write_body(wsi, session->second);
    }
    case LWS_CALLBACK_SERVER_WRITEABLE: {
      const auto session = sessions_.find(wsi);
      return session == sessions_.end() ? -1 : write_message(wsi, session->second);
    }
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      look_at_news();
      return 0;
    case LWS_CALLBACK_CLOSED:
    case LWS_CALLBACK_CLOSED_HTTP:
      leave(wsi);
      return 0;
    case LWS_CALLBACK_WSI_DESTROY:
      leave(wsi);
      limiter_.leave(wsi);
      viewers_ = limiter_.viewers();
      return 0;
    default:
      return 0;
  }
}

/// What a path leads to. Resources lie below the paths of broadcasts.
Server::Place Server::place_of(const std::string& path) const {
  const std::lock_guard lock(mutex_);
  auto found = broadcasts_.find("");
  if (found != broadcasts_.end()) return {found->second, path, resource_of(path), {}};
  std::size_t slash = path.rfind('/');
  for (; slash != std::string::npos && slash > 0; slash = path.rfind('/', slash - 1)) {
    found = broadcasts_.find(std::string_view(path).substr(0, slash));
    if (found == broadcasts_.end()) continue;
    return {found->second, path.substr(slash), resource_of(path.substr(slash)),
            path.substr(0, slash)};
  }
  return {};
}

bool Server::exists(const Place& place) const {
  const Resource resource = place.resource;
  if (!place.broadcast) return false;
  if (documents_.contains(place.path) || resource == Resource::info) return true;
  if (resource == Resource::face || resource == Resource::faps) return true;
  if (resource == Resource::say) return intake_ != nullptr;
  return (resource == Resource::audio || resource == Resource::talk) &&
         place.broadcast->sample_rate() > 0;
}

/// Why it is not answered, whatever it asks for; 0: it is.
unsigned Server::objection(lws* wsi, const Request& request) {
  if (!limiter_.ask(wsi, ConnectionLimiter::Clock::now())) return 429;
  if (request.host.empty() || request.blank_in_name) return HTTP_STATUS_BAD_REQUEST;
  return names_.contains(request.host) ? 0 : 421;
}

bool Server::may_watch(const Request& request, bool socket) const {
  return !may_watch_ || may_watch_(head_of(request, socket));
}

/// Where not everybody may watch, what is the same for all presentations tells nothing of one.
bool Server::is_open_document(const Request& request) const {
  if (!may_watch_ || !request.is_read()) return false;
  // /heads/NAME/...
  const std::size_t name = request.path.find('/', 1);
  if (name == std::string::npos) return false;
  const std::size_t end = request.path.find('/', name + 1);
  return end != std::string::npos && end > name + 1 &&
         documents_.contains(request.path.substr(end));
}

/// The origin for which an answer is meant, too; empty: for that of the server alone.
std::string Server::shared_with(const Request& request) const {
  for (const std::string& allowed : options_.allow_origins) {
    if (allowed == "*" || allowed == request.origin) return allowed;
  }
  return {};
}

/// JSON alone gains by it. Whoever wants a window of another size, or none that is kept, gets the
/// text as it is: libwebsockets would agree and go on as before.
bool Server::may_deflate(lws* wsi) const {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || channel_of(session->second) != Channel::faps) return false;
  const std::string offers = extensions_of(wsi);
  return !offers.empty() && offers.find("server_") == offers.npos;
}

/// A place in the hub. False: all are taken.
bool Server::admit(lws* wsi, Session& session) {
  const Channel channel = channel_of(session);
  if (!limiter_.watch(wsi, channel == Channel::audio)) return false;
  viewers_ = limiter_.viewers();
  const std::optional<ClientId> client = session.broadcast->add(channel);
  if (!client) return false;
  session.client = *client;
  session.open = true;
  session.broadcast->watching.insert(wsi);
  return true;
}

/// A client that sends its next request before it has the answer to this one is disconnected:
/// libwebsockets takes the next request for the end of this one, again and again, and serves nobody
/// else. (Flow control would hold back the answer, too.)
int Server::body_over(lws* wsi) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || session->second.body_over) return -1;
  session->second.body_over = true;
  return waits_for_peer_connections(wsi) ? whep_offer(wsi) : ask_handler(wsi);
}

/// The answer is complete.
int Server::transaction_over(lws* wsi) {
  const auto session = sessions_.find(wsi);
  const bool last =
      session != sessions_.end() && session->second.exchange && session->second.exchange->last;
  leave(wsi);
  if (last) return -1;
  limiter_.answered(wsi, ConnectionLimiter::Clock::now());
  return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

int Server::refuse(lws* wsi, const Request& request, unsigned status) {
  if (!send_refusal(wsi, status, request.method != Request::Method::head, handler_ != nullptr,
                    !request.is_read())) {
    return -1;
  }
  // Whatever comes behind another method stays unread.
  return request.is_read() ? transaction_over(wsi) : -1;
}

int Server::request(lws* wsi) {
  const Request request = request_of(wsi);
  const unsigned status = objection(wsi, request);
  if (status != 0) return refuse(wsi, request, status);
  if (is_open_document(request)) {
    leave(wsi);
    const std::size_t end = request.path.find('/', request.path.find('/', 1) + 1);
    const std::string path = request.path.substr(end);
    return serve(wsi, request, {nullptr, path, resource_of(path)});
  }
  Place place = place_of(request.path);
  const bool offers = request.method == Request::Method::post && request.path.ends_with("/whep");
  if ((request.is_read() || offers) && !may_watch(request, false)) {
    return refuse(wsi, request, HTTP_STATUS_FORBIDDEN);
  }
  if (place.resource == Resource::whep && place.broadcast->peers()) {
    return whep(wsi, request, place);
  }
  if (!request.is_read() && (!handler_ || request.verb.empty())) {
    return refuse(wsi, request, HTTP_STATUS_METHOD_NOT_ALLOWED);
  }
  if (!request.is_read()) place = {};
  if (!exists(place)) {
    return handler_ ? begin_exchange(wsi, request) : refuse(wsi, request, HTTP_STATUS_NOT_FOUND);
  }
  if (is_socket(place.resource)) return refuse(wsi, request, 426);  // upgrade required
  leave(wsi);
  return place.resource == Resource::talk ? talk(wsi, request, place) : serve(wsi, request, place);
}

/// What there is as a whole.
int Server::serve(lws* wsi, const Request& request, const Place& place) {
  const Resource resource = place.resource;
  Session session{.resource = resource, .broadcast = place.broadcast};
  if (resource == Resource::info) {
    session.document = place.broadcast->info();
  } else {
    const auto found = documents_.find(place.path);
    if (found == documents_.end()) return refuse(wsi, request, HTTP_STATUS_NOT_FOUND);
    session.document = found->second;
  }
  if (!session.document) {
    session.late = [this, wsi, request, place] { return serve(wsi, request, place); };
    sessions_[wsi] = std::move(session);
    lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
    return 0;
  }
  const Document& document = *session.document;
  session.packed = !document.packed.empty() && takes_gzip(request.accept_encoding);
  const bool comes = resource == (may_watch_ ? Resource::info : Resource::page);
  if (comes && place.broadcast && place.broadcast->peers()) place.broadcast->peers()->expect();
  Answer answer{.type = type_of(resource), .origin = shared_with(request)};
  answer.embedded = answer.origin == "*";
  answer.frames = frames_;
  answer.has_head = resource == Resource::page && documents_.contains("/head.js");
  answer.packed = session.packed;
  answer.size = session.packed ? document.packed.size() : document.bytes.size();
  if (!document.etag.empty()) answer.etag = document.etag_of(session.packed);
  const bool known = !answer.etag.empty() && has_version(request.if_none_match, answer.etag);
  if (known) answer.status = HTTP_STATUS_NOT_MODIFIED;
  if (!send_header(wsi, answer)) return -1;
  if (known || request.method == Request::Method::head) return transaction_over(wsi);
  sessions_[wsi] = std::move(session);
  lws_callback_on_writable(wsi);
  return 0;
}

/// What waits for the head is asked for again, when that is there or there is none.
int Server::serve_late(Session& session) {
  const auto found = documents_.find("/head.bin");
  if (found != documents_.end() && !found->second) return 0;
  const std::function<int()> again = std::exchange(session.late, nullptr);
  return again();
}

int Server::talk(lws* wsi, const Request& request, const Place& place) {
  Answer answer{.type = type_of(Resource::talk),
                .size = LWS_ILLEGAL_HTTP_CONTENT_LEN,
                .origin = shared_with(request)};
  answer.embedded = answer.origin == "*";
  if (request.method == Request::Method::head) return send_header(wsi, answer), -1;
  Session& session = sessions_[wsi];
  session.resource = Resource::talk;
  session.broadcast = place.broadcast;
  if (!admit(wsi, session)) return refuse(wsi, request, HTTP_STATUS_SERVICE_UNAVAILABLE);
  if (!send_header(wsi, answer)) return -1;
  lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::upgrade(lws* wsi) {
  const Request request = request_of(wsi);
  const auto refused = [&](unsigned status) { return send_refusal(wsi, status, true), -1; };
  const unsigned status = objection(wsi, request);
  if (status != 0) return refused(status);
  if (request.has_origin && !origin_allowed(request.origin, request.host, options_.allow_origins)) {
    return refused(HTTP_STATUS_FORBIDDEN);
  }
  const Place place = place_of(request.path);
  if (intake_ && resource_of(request.path.substr(request.path.rfind('/'))) == Resource::say) {
    return open_intake(wsi, request, place);
  }
  if (!may_watch(request, true)) return refused(HTTP_STATUS_FORBIDDEN);
  if (!is_socket(place.resource) || !exists(place)) return refused(HTTP_STATUS_NOT_FOUND);
  leave(wsi);
  Session& session = sessions_[wsi];
  session.resource = place.resource;
  session.broadcast = place.broadcast;
  session.small = request.asks("binary");
  session.as_sent = request.asks("as-sent");
  return admit(wsi, session) ? 0 : refused(HTTP_STATUS_SERVICE_UNAVAILABLE);
}

int Server::write_body(lws* wsi, Session& session) {
  const std::string& body = session.packed ? session.document->packed : session.document->bytes;
  const std::size_t size = std::min(kPiece, body.size() - session.at);
  const bool last = session.at + size == body.size();
  if (!send_bytes(wsi, body.data() + session.at, size,
                  last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP)) {
    return -1;
  }
  session.at += size;
  limiter_.progress(wsi, ConnectionLimiter::Clock::now());
  if (last) return transaction_over(wsi);
  lws_callback_on_writable(wsi);
  return 0;
}

bool Server::send_message(lws* wsi, Session& session, const Message& message) {
  if (session.resource != Resource::talk) {
    const lws_write_protocol how = message.text ? LWS_WRITE_TEXT : LWS_WRITE_BINARY;
    return send_bytes(wsi, message.bytes.data(), message.bytes.size(), how);
  }
  std::vector<std::uint8_t> bytes = message.bytes;
  if (message.entry) {  // a segment: the first one begins at 0, for players that wait for it
    const std::int64_t time = std::llround(message.time * session.broadcast->sample_rate());
    if (session.begin < 0) session.begin = time;
    media::set_segment_time(bytes, time - session.begin);
  }
  return send_bytes(wsi, bytes.data(), bytes.size(), LWS_WRITE_HTTP);
}

int Server::write_message(lws* wsi, Session& session) {
  if (!session.told.empty()) {
    const std::string text = std::move(session.told.front());
    session.told.pop_front();
    lws_callback_on_writable(wsi);
    return send_bytes(wsi, text.data(), text.size(), LWS_WRITE_TEXT) ? 0 : -1;
  }
  const auto [message, more, over, goes_away] = session.broadcast->next(session.client);
  if (message && !send_message(wsi, session, *message)) return -1;
  if (!message && over) {
    std::array<unsigned char, 4> reason{'e', 'n', 'd', 0};
    if (session.resource != Resource::talk) {
      lws_close_reason(wsi, goes_away ? LWS_CLOSE_STATUS_GOINGAWAY : LWS_CLOSE_STATUS_NORMAL,
                       reason.data(), 3);
    }
    return -1;
  }
  if (more || over) lws_callback_on_writable(wsi);
  return 0;
}

void Server::look_at(const Broadcast& broadcast, Hub::Clock::time_point since) {
  for (lws* wsi : broadcast.watching) {
    const Broadcast::Need need = broadcast.need_of(sessions_[wsi].client, since);
    if (need == Broadcast::Need::to_go) {
      lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
    } else if (need == Broadcast::Need::to_write) {
      lws_callback_on_writable(wsi);
    }
  }
}

void Server::look_around() {
  const auto patience = std::chrono::microseconds(std::int64_t(options_.stall_seconds * 1e6));
  const auto since = Hub::Clock::now() - patience;
  std::set<std::shared_ptr<Broadcast>> broadcasts;  // also those that are over
  for (const auto& [wsi, session] : sessions_) {
    if (session.open) broadcasts.insert(session.broadcast);
  }
  for (const auto& broadcast : broadcasts) look_at(*broadcast, since);
}

/// Something was published, is over, or was answered.
void Server::look_at_news() {
  std::vector<std::shared_ptr<Broadcast>> broadcasts;
  {
    const std::lock_guard lock(mutex_);
    broadcasts.swap(touched_);
  }
  std::sort(broadcasts.begin(), broadcasts.end());
  broadcasts.erase(std::unique(broadcasts.begin(), broadcasts.end()), broadcasts.end());
  for (const auto& broadcast : broadcasts) look_at(*broadcast, {});
  hand_out_answers();
  take_late_head();
  std::vector<std::pair<std::shared_ptr<Exchange>, ServerReply>> given;
  {
    const std::lock_guard lock(answers_->mutex);
    given.swap(answers_->given);
  }
  for (auto& [exchange, reply] : given) {
    if (exchange->wsi == nullptr) continue;
    Session& session = sessions_[exchange->wsi];
    if (exchange->socket) {
      session.told.push_back(std::move(reply.body));
    } else {
      session.reply = std::move(reply);
    }
    lws_callback_on_writable(exchange->wsi);
  }
}

/// Disconnects idle connections at intervals.
void Server::keep_looking() {
  const auto look = [](lws_sorted_usec_list_t* entry) {
    // The entry is the first member.
    reinterpret_cast<Timer*>(entry)->server->keep_looking();
  };
  disconnect_overdue();
  look_around();
  look_at_intakes();
  lws_sul_schedule(service_.context(), 0, &timer_.entry, look, kLookEvery);
}

void Server::disconnect_overdue() {
  for (const ConnectionLimiter::Key key : limiter_.overdue(ConnectionLimiter::Clock::now())) {
    auto* wsi = const_cast<lws*>(static_cast<const lws*>(key));
    lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  }
}

void Server::leave(lws* wsi) {
  const auto found = sessions_.find(wsi);
  if (found == sessions_.end()) return;
  Session& session = found->second;
  if (session.exchange) session.exchange->wsi = nullptr;
  if (session.intake && !session.whole) session.intake->end(false);
  if (session.open) {
    session.broadcast->watching.erase(wsi);
    session.broadcast->remove(session.client, channel_of(session));
  }
  sessions_.erase(found);
}

}  // namespace animeme::web
