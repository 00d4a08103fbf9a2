#include "tools/web/detail/server.h"

#include <chrono>
#include <utility>

#include "tools/web/detail/page.h"

namespace animeme::web {
namespace {

constexpr std::chrono::seconds kGoodbye{2};
constexpr int kSpareConnections = 32;  // pages on their way, and our own

constexpr std::string_view kMark = "<!-- head -->\n";

/// The page as it is served. `head_script`: as WebOptions.
std::string make_page(std::string_view head_script) {
  std::string page(page_text());
  const std::size_t at = page.find(kMark);
  if (at == std::string::npos) return page;
  std::string head;
  if (!head_script.empty()) {
    head = "<script type=\"module\">\n" + std::string(head_script) + std::string(head_glue()) +
           "</script>\n";
  }
  return page.replace(at, kMark.size(), head);
}

}  // namespace

Server::Server(const WebOptions& options, int sample_rate)
    : options_(options),
      sample_rate_(sample_rate),
      page_(make_page(options.head_script)),
      hub_(options.client_bytes, options.catch_up) {}

Result<std::unique_ptr<Server>> Server::listen(const WebAddress& address, const WebOptions& options,
                                               int sample_rate) {
  static const lws_protocols protocols[] = {{"animeme", &Server::callback, 0, 1024, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  if (Result<void> possible = check_listening(address); !possible) return possible.error();
  std::unique_ptr<Server> server(new Server(options, sample_rate));
  lws_context_creation_info info{};
  info.port = address.port;
  info.iface = address.host == "0.0.0.0" || address.host == "::" ? nullptr : address.host.c_str();
  info.protocols = protocols;
  info.user = server.get();
  info.timeout_secs = 10;
  info.keepalive_timeout = 10;
  info.max_http_header_data = 4096;
  info.fd_limit_per_thread = unsigned(options.max_clients + kSpareConnections);
  info.server_string = "animeme";
  if (address.host.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  const bool listening = server->service_.start(info);
  lws_vhost* host =
      listening ? lws_get_vhost_by_name(server->service_.context(), "default") : nullptr;
  server->port_ = host != nullptr ? lws_get_vhost_listen_port(host) : 0;
  if (server->port_ <= 0) {
    return make_error(Code::io,
                      "cannot listen at " + address.text() +
                          "; is the port in use, or the host no address of this machine?");
  }
  server->service_.run();
  return server;
}

void Server::set_hello(Channel channel, Message hello) {
  const std::lock_guard lock(mutex_);
  hub_.set_hello(channel, std::move(hello));
}

void Server::set_info(std::string json) {
  const std::lock_guard lock(mutex_);
  info_ = std::move(json);
}

void Server::publish(Channel channel, Message message) {
  {
    const std::lock_guard lock(mutex_);
    hub_.publish(channel, std::move(message));
  }
  service_.wake();
}

void Server::forget_before(Channel channel, double time) {
  const std::lock_guard lock(mutex_);
  hub_.forget_before(channel, time);
}

media::SendStats Server::stats() const {
  const std::lock_guard lock(mutex_);
  media::SendStats stats;
  stats.packets = hub_.messages();
  stats.bytes = hub_.bytes();
  stats.dropped = hub_.dropped();
  stats.receivers = std::int64_t(hub_.clients());
  return stats;
}

void Server::finish() {
  std::unique_lock lock(mutex_);
  finishing_ = true;
  lock.unlock();
  service_.wake();
  lock.lock();
  changed_.wait_for(lock, kGoodbye, [this] { return hub_.clients() == 0; });
  lock.unlock();
  service_.stop();
}

}  // namespace animeme::web
