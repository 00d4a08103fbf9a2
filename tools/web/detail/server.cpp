#include "tools/web/detail/server.h"

#include <sys/resource.h>

#include <chrono>
#include <utility>

#include "tools/web/detail/page.h"

namespace animeme::web {
namespace {

constexpr std::chrono::seconds kGoodbye{2};
constexpr int kSpareHandles = 64;  // our own, and connections that are being closed

constexpr std::string_view kMark = "<!-- head -->\n";

std::map<Resource, DocumentPtr> documents_of(const WebOptions& options) {
  std::map<Resource, DocumentPtr> documents;
  std::string page(page_text()), head;
  if (!options.head_script.empty()) {
    head = "<script type=\"module\" src=\"head.js\"></script>\n";
    documents[Resource::head_script] =
        make_document(options.head_script + std::string(head_glue()));
    documents[Resource::head] =
        make_document({options.head_model.begin(), options.head_model.end()});
  }
  const std::size_t at = page.find(kMark);
  if (at != std::string::npos) page.replace(at, kMark.size(), head);
  documents[Resource::page] = make_document(std::move(page));
  documents[Resource::style] = make_document(std::string(page_style()));
  documents[Resource::script] = make_document(std::string(page_script()));
  return documents;
}

/// Files that may be open: two connections a viewer, those that pass, and others.
Result<unsigned> handles_for(int viewers) {
  const auto wanted = unsigned(2 * viewers + int(Visitors::kMostPassing) + kSpareHandles);
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return wanted;
  return make_error(Code::invalid_argument,
                    std::to_string(viewers) + " viewers take " + std::to_string(wanted) +
                        " open files, and this process may have " + std::to_string(limit.rlim_cur) +
                        "; allow more (ulimit -n) or fewer viewers");
}

}  // namespace

Server::Server(const WebAddress& address, const WebOptions& options, int sample_rate)
    : options_(options),
      sample_rate_(sample_rate),
      names_(address, options.host_names),
      documents_(documents_of(options)),
      hub_(options.client_bytes, options.catch_up),
      info_(make_document("{}")),
      visitors_({options.max_clients, options.per_address, options.stall_seconds}) {
  timer_.server = this;
}

void Server::stop() {
  if (peers_) peers_->finish();  // it answers no more
  service_.stop([this] { lws_sul_cancel(&timer_.entry); });
}

Result<std::unique_ptr<Server>> Server::listen(const WebAddress& address, const WebOptions& options,
                                               int sample_rate) {
  static const lws_protocols protocols[] = {{"animeme", &Server::callback, 0, 1024, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  if (Result<void> possible = check_listening(address); !possible) return possible.error();
  Result<unsigned> handles = handles_for(options.max_clients);
  if (!handles) return handles.error();
  std::unique_ptr<Server> server(new Server(address, options, sample_rate));
  lws_context_creation_info info{};
  info.port = address.port;
  info.iface = address.host == "0.0.0.0" || address.host == "::" ? nullptr : address.host.c_str();
  info.protocols = protocols;
  info.user = server.get();
  info.timeout_secs = 10;
  info.keepalive_timeout = 10;
  info.max_http_header_data = 4096;
  info.max_http_header_pool = static_cast<unsigned short>(*handles);
  info.fd_limit_per_thread = *handles;
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
  server->keep_looking();
  return server;
}

void Server::set_hello(Channel channel, Message hello) {
  const std::lock_guard lock(mutex_);
  hub_.set_hello(channel, std::move(hello));
}

void Server::set_info(std::string json) {
  auto document = std::make_shared<Document>();  // small, and another one each second
  document->bytes = std::move(json);
  const std::lock_guard lock(mutex_);
  info_ = std::move(document);
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
  stats.receivers = viewers_;
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
  stop();
}

}  // namespace animeme::web
