#include "tools/live/web/detail/client.h"

#include <utility>

#include "tools/live/web/detail/messages.h"

namespace animeme::web {
namespace {

constexpr std::chrono::seconds kPatience{5};
constexpr std::size_t kLargestMessage = std::size_t(1) << 20;
constexpr std::size_t kItem = 128;  // what a message costs beside its bytes

}  // namespace

int Client::callback(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t size) {
  auto* client = static_cast<Client*>(lws_context_user(lws_get_context(wsi)));
  if (client == nullptr) return 0;
  try {
    return client->handle(wsi, reason, static_cast<const char*>(in), size);
  } catch (...) {  // memory
    return -1;
  }
}

int Client::handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size) {
  if (reason == LWS_CALLBACK_EVENT_WAIT_CANCELLED) {
    resume();
    return 0;
  }
  auto* connection = static_cast<Connection*>(lws_get_opaque_user_data(wsi));
  if (connection == nullptr) return 0;
  // Nothing here calls libwebsockets with the lock held: it may call back at once.
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      established(*connection, wsi);
      return 0;
    case LWS_CALLBACK_CLIENT_RECEIVE:
      connection->message.insert(connection->message.end(), in, in + size);
      if (connection->message.size() > kLargestMessage) return -1;
      if (lws_remaining_packet_payload(wsi) > 0 || lws_is_final_fragment(wsi) == 0) return 0;
      if (lws_frame_is_binary(wsi) == 0) {  // text messages are for pages
        connection->message.clear();
        return 0;
      }
      return receive(*connection);
    case LWS_CALLBACK_WS_PEER_INITIATED_CLOSE:
      connection->goodbye = size >= 2 && static_cast<unsigned char>(in[0]) == 1000 >> 8 &&
                            static_cast<unsigned char>(in[1]) == (1000 & 255);
      return 0;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
      close(*connection, in == nullptr ? "nobody answers" : std::string(in, size));
      return 0;
    case LWS_CALLBACK_CLIENT_CLOSED:
      close(*connection, connection->goodbye ? "" : "the connection broke");
      return 0;
    default:
      return 0;
  }
}

bool Client::ask(Connection& connection) {
  connection.wanted = true;
  lws_client_connect_info info{};
  info.context = service_.context();
  info.address = address_.host.c_str();
  info.host = info.address;
  info.port = address_.port;
  // A server may not send us to machines that it cannot reach itself.
  info.ssl_connection = LCCSCF_HTTP_NO_FOLLOW_REDIRECT;
  std::string path = address_.path + (connection.sound ? "/audio" : "/face?as-sent");
  if (!address_.query.empty()) path += (connection.sound ? "?" : "&") + address_.query;
  info.path = path.c_str();
  info.local_protocol_name = "animeme";
  info.ietf_version_or_minus_one = -1;
  info.opaque_user_data = &connection;
  return lws_client_connect_via_info(&info) != nullptr;
}

void Client::established(Connection& connection, lws* wsi) {
  const std::lock_guard lock(mutex_);
  connection.wsi = wsi;
  connection.open = true;
  changed_.notify_all();
}

/// A message is complete.
int Client::receive(Connection& connection) {
  Connection& sound = connections_[1];
  if (!connection.sound && !sound.wanted) {  // the first message says whether there is a sound
    const Result<Hello> hello = read_hello(connection.message);
    sound.wanted = true;
    if (hello && hello->has_sound) {
      if (!ask(sound)) return -1;
    } else {
      close(sound, "");
    }
  }
  const std::lock_guard lock(mutex_);
  queued_ += connection.message.size() + kItem;
  queue_.push_back({connection.sound, std::move(connection.message)});
  connection.message.clear();
  changed_.notify_all();
  if (queued_ > queue_bytes_ && !paused_) {
    paused_ = true;  // the network waits, and the server sees it
    for (Connection& each : connections_) {
      if (each.wsi != nullptr) lws_rx_flow_control(each.wsi, 0);
    }
  }
  return 0;
}

void Client::resume() {
  const std::lock_guard lock(mutex_);
  if (!paused_ || queued_ > queue_bytes_ / 2) return;
  paused_ = false;
  for (Connection& each : connections_) {
    if (each.wsi != nullptr) lws_rx_flow_control(each.wsi, 1);
  }
}

void Client::close(Connection& connection, const std::string& why) {
  const std::lock_guard lock(mutex_);
  connection.over = true;
  connection.wsi = nullptr;
  if (problem_.empty()) problem_ = why;
  changed_.notify_all();
}

bool Client::over() const {
  if (!problem_.empty()) return true;
  return connections_[0].over && connections_[1].over;
}

/// Both are open, or the first message of the face says that there is no sound.
bool Client::ready() const {
  return connections_[0].open && (connections_[1].open || connections_[1].over);
}

Result<void> Client::connect() {
  static const lws_protocols protocols[] = {{"animeme", &Client::callback, 0, 65536, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = protocols;
  info.user = this;
  info.connect_timeout_secs = 5;
  info.timeout_secs = 5;
  connections_[1].sound = true;
  if (!service_.start(info)) return make_error(Code::io, "libwebsockets cannot be started");
  const bool asked = ask(connections_[0]);
  service_.run();
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPatience, [&] { return ready() || !problem_.empty() || !asked; });
  if (connections_[0].open && problem_.empty()) return {};
  const std::string why = problem_.empty() ? "nobody answers" : problem_;
  return make_error(Code::io, "no face at " + address_.text() + ": " + why +
                                  "; does a server of Animeme run there?");
}

Result<std::optional<Incoming>> Client::next(Clock::time_point until) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, until, [this] { return !queue_.empty() || over(); });
  if (queue_.empty()) {
    if (!problem_.empty()) {
      return make_error(Code::io, "the connection to " + address_.text() + " ended: " + problem_);
    }
    if (over()) return make_error(Code::end_of_stream, "the server has ended the presentation");
    return std::optional<Incoming>();
  }
  std::optional<Incoming> incoming(std::move(queue_.front()));
  queue_.pop_front();
  queued_ -= incoming->bytes.size() + kItem;
  const bool wake = paused_ && queued_ <= queue_bytes_ / 2;
  lock.unlock();
  if (wake) service_.wake();
  return incoming;
}

}  // namespace animeme::web
