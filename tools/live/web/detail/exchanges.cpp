// Requests that are answered by the program around the server.
#include <algorithm>
#include <utility>

#include "tools/live/web/detail/server.h"

namespace animeme::web {
namespace {

// A page elsewhere can send such requests without being allowed to read the answer.
bool from_elsewhere(const Request& request, const WebOptions& options) {
  return request.has_origin && !origin_allowed(request.origin, request.host, options.allow_origins);
}

}  // namespace

ServerRequest head_of(const Request& request, bool socket) {
  return {.method = request.verb,
          .path = request.path,
          .query = request.query,
          .authorization = request.authorization,
          .type = request.content_type,
          .length = request.body,
          .body = {},
          .socket = socket};
}

int Server::begin_exchange(lws* wsi, const Request& request) {
  if (from_elsewhere(request, options_)) return refuse(wsi, request, HTTP_STATUS_FORBIDDEN);
  if (begin_intake(wsi, request)) return 0;
  if (request.body < 0) return refuse(wsi, request, 411);
  if (std::uint64_t(request.body) > most_body_) {
    return refuse(wsi, request, HTTP_STATUS_REQ_ENTITY_TOO_LARGE);
  }
  leave(wsi);
  auto exchange = std::make_shared<Exchange>();
  exchange->wsi = wsi;
  exchange->with_body = request.method != Request::Method::head;
  // Without a length libwebsockets would wait for a body.
  exchange->last = !request.is_read() && !request.has_length;
  exchange->request = head_of(request, false);
  sessions_[wsi].exchange = std::move(exchange);
  const bool body = request.body > 0 && !request.is_read();
  return body ? 0 : ask_handler(wsi);
}

int Server::take_body(lws* wsi, const char* bytes, std::size_t size) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || !session->second.exchange) return -1;
  if (session->second.intake) return take_block(wsi, session->second, bytes, size);
  std::string& body = session->second.exchange->request.body;
  if (body.size() + size > most_body_) return -1;
  body.append(bytes, size);
  limiter_.progress(wsi, ConnectionLimiter::Clock::now());
  return 0;
}

int Server::ask_handler(lws* wsi) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || !session->second.exchange) return 0;
  if (session->second.intake) {
    if (std::exchange(session->second.whole, true)) return 0;
    session->second.intake->end(true);
    return 0;
  }
  const std::shared_ptr<Exchange> exchange = session->second.exchange;
  if (exchange->request.method.empty()) return 0;  // it has been asked
  lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
  handler_(std::exchange(exchange->request, {}), answer_to(exchange));
  return 0;
}

ServerAnswer Server::answer_to(std::shared_ptr<Exchange> exchange) const {
  return [answers = answers_, exchange = std::move(exchange)](ServerReply reply) {
    const std::lock_guard lock(answers->mutex);
    if (answers->service == nullptr) return;
    answers->given.emplace_back(exchange, std::move(reply));
    answers->service->wake();
  };
}

int Server::write_reply(lws* wsi, Session& session) {
  const ServerReply reply = *std::exchange(session.reply, std::nullopt);
  Answer answer{.status = reply.status, .type = reply.type, .size = reply.body.size()};
  answer.retry_after = reply.retry_after;
  if (!reply.allow.empty()) answer.allow = reply.allow;
  answer.has_frames = reply.frames;
  answer.closes = session.exchange->last;
  const bool with_body = session.exchange->with_body && !reply.body.empty();
  if (!send_header(wsi, answer)) return -1;
  limiter_.progress(wsi, ConnectionLimiter::Clock::now());
  if (!with_body) return transaction_over(wsi);
  auto document = std::make_shared<Document>();
  document->bytes = reply.body;
  session.document = std::move(document);
  lws_callback_on_writable(wsi);
  return 0;
}

}  // namespace animeme::web
