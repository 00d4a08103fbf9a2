// WHEP: a browser posts its offer and gets the answer of Peers, when there is one. Source:
// draft-ietf-wish-whep.
#include <algorithm>
#include <utility>

#include "tools/live/web/detail/server.h"

namespace animeme::web {
namespace {

using Method = Request::Method;

constexpr unsigned kCreated = 201;
constexpr std::size_t kMostOffer = 65536;  // bytes
constexpr const char* kMethods = "POST, DELETE, OPTIONS";

}  // namespace

/// A status and a sentence, or an answer. The connection is closed behind what was posted: nobody
/// has read on.
int Server::whep_reply(lws* wsi, Answer answer, const std::string& text) {
  answer.size = text.size();
  if (answer.type.empty() && !text.empty()) answer.type = "text/plain; charset=utf-8";
  answer.allow = kMethods;
  if (!send_header(wsi, answer)) return -1;
  if (!text.empty()) {
    std::vector<unsigned char> buffer(LWS_PRE + text.size());
    std::copy(text.begin(), text.end(), buffer.begin() + LWS_PRE);
    if (lws_write(wsi, buffer.data() + LWS_PRE, text.size(), LWS_WRITE_HTTP_FINAL) <
        int(text.size())) {
      return -1;
    }
  }
  return transaction_over(wsi);
}

int Server::whep(lws* wsi, const Request& request, const Place& place) {
  PeerConnections& peers = *place.broadcast->peers();
  const std::string shared = shared_with(request);
  const auto reply = [&](unsigned status, const char* text) {
    const int kept = whep_reply(wsi, {.status = status, .origin = shared}, text);
    return status >= HTTP_STATUS_BAD_REQUEST ? -1 : kept;
  };
  if (request.has_origin && !origin_allowed(request.origin, request.host, options_.allow_origins)) {
    return reply(HTTP_STATUS_FORBIDDEN, "Pages of other servers need --allow-origin.\n");
  }
  const std::string id = place.path.substr(std::min<std::size_t>(place.path.size(), 6));
  if (request.method == Method::options) return reply(HTTP_STATUS_NO_CONTENT, "");
  if (request.method == Method::remove && !id.empty()) {
    if (peers.end(id)) return reply(HTTP_STATUS_OK, "");
    return reply(HTTP_STATUS_NOT_FOUND, "There is no such connection.\n");
  }
  // Candidates come with offer and answer, and a connection that broke is made anew: no PATCH.
  if (request.method != Method::post || !id.empty()) {
    return reply(HTTP_STATUS_METHOD_NOT_ALLOWED, "POST an offer here, DELETE what came of it.\n");
  }
  if (!request.content_type.starts_with("application/sdp")) {
    return reply(HTTP_STATUS_UNSUPPORTED_MEDIA_TYPE, "An offer is application/sdp.\n");
  }
  if (limiter_.viewers() + peers.busy() >= options_.max_clients) {
    return reply(HTTP_STATUS_SERVICE_UNAVAILABLE, "All places are taken (--max-clients).\n");
  }
  leave(wsi);
  Session& session = sessions_[wsi];
  session.resource = Resource::whep;
  session.origin = shared;
  session.broadcast = place.broadcast;
  session.path = place.above;
  return 0;  // the body comes
}

bool Server::waits_for_peer_connections(lws* wsi) const {
  const auto session = sessions_.find(wsi);
  return session != sessions_.end() && session->second.resource == Resource::whep;
}

int Server::whep_body(lws* wsi, const char* bytes, std::size_t size) {
  const auto session = sessions_.find(wsi);
  if (session->second.upload.size() + size > kMostOffer) return -1;
  session->second.upload.append(bytes, size);
  return 0;
}

int Server::whep_offer(lws* wsi) {
  const auto session = sessions_.find(wsi);
  const std::uint64_t ticket = session->second.ticket = ++tickets_;
  session->second.broadcast->peers()->offer(std::move(session->second.upload),
                                            peer_of(lws_get_socket_fd(wsi)),
                                            [this, ticket](PeerAnswer answer) {
                                              {
                                                const std::lock_guard lock(mutex_);
                                                peer_answers_[ticket] = std::move(answer);
                                              }
                                              service_.wake();
                                            });
  session->second.broadcast->expect();
  return 0;
}

/// Gives those who wait what has come for them; others have gone, and their connections will not
/// be made.
void Server::hand_out_answers() {
  std::map<std::uint64_t, PeerAnswer> answers;
  {
    const std::lock_guard lock(mutex_);
    answers.swap(peer_answers_);
  }
  if (answers.empty()) return;
  for (auto& [wsi, session] : sessions_) {
    const auto found = answers.find(session.ticket);
    if (found == answers.end()) continue;
    session.answer = std::move(found->second);
    lws_callback_on_writable(wsi);
  }
}

int Server::whep_answer(lws* wsi, Session& session) {
  if (!session.answer) return 0;
  const PeerAnswer given = std::move(*session.answer);
  Answer answer{.status = given.status, .origin = session.origin};
  if (given.status == kCreated) {
    answer.type = "application/sdp";
    answer.location = session.path + "/whep/" + given.id;
  }
  return whep_reply(wsi, std::move(answer), given.text);
}

}  // namespace animeme::web
