#include "tools/web/detail/server.h"

#include <chrono>
#include <utility>

#include "tools/web/detail/server_impl.h"

namespace animeme::web {
namespace {

constexpr std::chrono::seconds kGoodbye{2};
constexpr int kSpareConnections = 32;  // pages on their way, and our own

}  // namespace

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() { impl_->service.stop(); }

Result<std::unique_ptr<Server>> Server::listen(const WebAddress& address, const WebOptions& options,
                                               SoundFacts sound) {
  static const lws_protocols protocols[] = {{"animeme", &Impl::callback, 0, 1024, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  if (Result<void> possible = check_listening(address); !possible) return possible.error();
  auto impl = std::make_unique<Impl>(options, sound);
  lws_context_creation_info info{};
  info.port = address.port;
  info.iface = address.host == "0.0.0.0" || address.host == "::" ? nullptr : address.host.c_str();
  info.protocols = protocols;
  info.user = impl.get();
  info.timeout_secs = 10;
  info.keepalive_timeout = 10;
  info.max_http_header_data = 4096;
  info.fd_limit_per_thread = unsigned(options.max_clients + kSpareConnections);
  info.server_string = "animeme";
  if (address.host.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  const bool listening = impl->service.start(info);
  lws_vhost* host = listening ? lws_get_vhost_by_name(impl->service.context(), "default") : nullptr;
  impl->port = host != nullptr ? lws_get_vhost_listen_port(host) : 0;
  if (impl->port <= 0) {
    return make_error(Code::io,
                      "cannot listen at " + address.text() +
                          "; is the port in use, or the host no address of this machine?");
  }
  impl->service.run();
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const { return impl_->port; }

void Server::set_hello(Channel channel, Message hello) {
  const std::lock_guard lock(impl_->mutex);
  impl_->hub.set_hello(channel, std::move(hello));
}

void Server::set_info(std::string json) {
  const std::lock_guard lock(impl_->mutex);
  impl_->info = std::move(json);
}

void Server::publish(Channel channel, Message message) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->hub.publish(channel, std::move(message));
  }
  impl_->service.wake();
}

void Server::forget_before(Channel channel, double time) {
  const std::lock_guard lock(impl_->mutex);
  impl_->hub.forget_before(channel, time);
}

media::SendStats Server::stats() const {
  const std::lock_guard lock(impl_->mutex);
  media::SendStats stats;
  stats.packets = impl_->hub.messages();
  stats.bytes = impl_->hub.bytes();
  stats.dropped = impl_->hub.dropped();
  stats.receivers = std::int64_t(impl_->hub.clients());
  return stats;
}

void Server::finish() {
  std::unique_lock lock(impl_->mutex);
  impl_->finishing = true;
  lock.unlock();
  impl_->service.wake();
  lock.lock();
  impl_->changed.wait_for(lock, kGoodbye, [this] { return impl_->hub.clients() == 0; });
  lock.unlock();
  impl_->service.stop();
}

}  // namespace animeme::web
