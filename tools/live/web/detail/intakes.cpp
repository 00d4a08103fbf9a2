// What clients send bit by bit, by a WebSocket or as the body of a request.
#include <chrono>
#include <utility>

#include "tools/live/web/detail/server.h"

namespace animeme::web {
namespace {

constexpr std::chrono::minutes kSilence{5};  // of a body that is not whole: nobody is there
constexpr std::size_t kMostTold = 256;       // messages that wait for a client

unsigned status_of(const Error& error) {
  return error.code == Code::not_found ? HTTP_STATUS_NOT_FOUND : HTTP_STATUS_UNAUTHORIZED;
}

}  // namespace

// False: it is none, or has a length and no taker.
bool Server::begin_intake(lws* wsi, const Request& request) {
  if (!intake_ || request.is_read() || !request.path.ends_with("/say")) return false;
  if (request.body < 0 && !request.chunked) return false;
  auto exchange = std::make_shared<Exchange>();
  exchange->wsi = wsi;
  exchange->last = request.chunked;
  Result<std::shared_ptr<Intake>> intake = intake_(head_of(request, false), answer_to(exchange));
  if (!intake || !*intake) return false;
  leave(wsi);
  Session& session = sessions_[wsi];
  session.exchange = std::move(exchange);
  session.intake = std::move(*intake);
  if (request.chunked) session.chunks.emplace();
  if (!request.chunked && request.body == 0) (void)ask_handler(wsi);
  return true;
}

int Server::take_block(lws* wsi, Session& session, const char* bytes, std::size_t size) {
  if (session.whole) return 0;  // what follows is not read
  session.heard = Hub::Clock::now();
  limiter_.progress(wsi, ConnectionLimiter::Clock::now());
  std::string block;
  if (session.chunks) {
    if (!session.chunks->read({bytes, size}, block)) return -1;
  } else {
    block.assign(bytes, size);
  }
  const std::shared_ptr<Intake> intake = session.intake;
  if (!block.empty()) intake->take(std::move(block), false);
  if (session.chunks && session.chunks->over()) return ask_handler(wsi);
  if (intake->full() && !std::exchange(session.paused, true)) lws_rx_flow_control(wsi, 0);
  return 0;
}

int Server::open_intake(lws* wsi, const Request& request, const Place& place) {
  const auto refused = [&](unsigned status) { return send_refusal(wsi, status, true), -1; };
  auto exchange = std::make_shared<Exchange>();
  exchange->wsi = wsi;
  exchange->socket = true;
  Result<std::shared_ptr<Intake>> intake = intake_(head_of(request, true), answer_to(exchange));
  if (!intake) return refused(status_of(intake.error()));
  if (!*intake || !place.broadcast) return refused(HTTP_STATUS_NOT_FOUND);
  leave(wsi);
  Session& session = sessions_[wsi];
  session.resource = Resource::say;
  session.broadcast = place.broadcast;
  session.exchange = std::move(exchange);
  session.intake = std::move(*intake);
  return admit(wsi, session) ? 0 : refused(HTTP_STATUS_SERVICE_UNAVAILABLE);
}

int Server::take_message(lws* wsi, const char* bytes, std::size_t size) {
  Session& session = sessions_[wsi];
  if (session.message.size() + size > most_message_) {
    lws_close_reason(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, nullptr, 0);
    return -1;
  }
  session.message.append(bytes, size);
  if (lws_remaining_packet_payload(wsi) > 0 || lws_is_final_fragment(wsi) == 0) return 0;
  const std::shared_ptr<Intake> intake = session.intake;
  intake->take(std::exchange(session.message, {}), lws_frame_is_binary(wsi) == 0);
  // Who does not read what it is told is not listened to.
  const bool full = intake->full() || session.told.size() > kMostTold;
  if (full && !std::exchange(session.paused, true)) lws_rx_flow_control(wsi, 0);
  return 0;
}

void Server::look_at_intakes() {
  const auto now = Hub::Clock::now();
  for (auto& [wsi, session] : sessions_) {
    if (!session.intake) continue;
    if (session.paused && !session.intake->full() && session.told.size() <= kMostTold) {
      session.paused = false;
      session.heard = now;
      lws_rx_flow_control(wsi, 1);
    }
    if (session.open || session.whole) continue;  // a socket; or it waits for its answer
    if (session.paused || now - session.heard < kSilence) {
      limiter_.progress(wsi, ConnectionLimiter::Clock::now());
      lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);
    } else {
      lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
    }
  }
}

}  // namespace animeme::web
