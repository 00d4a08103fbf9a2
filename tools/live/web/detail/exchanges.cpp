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

int Server::begin_exchange(lws* wsi, const Request& request) {
  if (from_elsewhere(request, options_)) return refuse(wsi, request, HTTP_STATUS_FORBIDDEN);
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
  exchange->request = {request.verb, request.path, request.authorization, {}};
  sessions_[wsi].exchange = std::move(exchange);
  const bool body = request.body > 0 && !request.is_read();
  return body ? 0 : ask_handler(wsi);
}

int Server::take_body(lws* wsi, const char* bytes, std::size_t size) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || !session->second.exchange) return -1;
  std::string& body = session->second.exchange->request.body;
  if (body.size() + size > most_body_) return -1;
  body.append(bytes, size);
  limiter_.progress(wsi, ConnectionLimiter::Clock::now());
  return 0;
}

int Server::ask_handler(lws* wsi) {
  const auto session = sessions_.find(wsi);
  if (session == sessions_.end() || !session->second.exchange) return 0;
  const std::shared_ptr<Exchange> exchange = session->second.exchange;
  if (exchange->request.method.empty()) return 0;  // it has been asked
  lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
  const auto answer = [answers = answers_, exchange](ServerReply reply) {
    const std::lock_guard lock(answers->mutex);
    if (answers->service == nullptr) return;
    answers->given.emplace_back(exchange, std::move(reply));
    answers->service->wake();
  };
  handler_(std::exchange(exchange->request, {}), answer);
  return 0;
}

int Server::write_reply(lws* wsi, Session& session) {
  const ServerReply reply = *std::exchange(session.reply, std::nullopt);
  Answer answer{.status = reply.status, .type = reply.type, .size = reply.body.size()};
  answer.retry_after = reply.retry_after;
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
