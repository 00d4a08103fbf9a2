#include "tools/live/web/detail/server.h"

#include <sys/resource.h>

#include <chrono>
#include <new>
#include <system_error>
#include <utility>

#include "tools/live/web/detail/page.h"

namespace animeme::web {
namespace {

constexpr std::chrono::seconds kGoodbye{2};
constexpr int kSpareHandles = 64;  // our own, and connections that are being closed

constexpr std::string_view kMark = "<!-- head -->\n";

DocumentPtr document_of(const std::vector<std::uint8_t>& bytes) {
  return make_document({bytes.begin(), bytes.end()});
}

std::map<std::string, DocumentPtr> documents_of(const WebOptions& options) {
  std::map<std::string, DocumentPtr> documents;
  std::string page(page_text()), head;
  if (!options.head_script.empty()) {
    head = "<script type=\"module\" src=\"head.js\"></script>\n";
    documents["/head.js"] = make_document(options.head_script + std::string(head_glue()));
    documents["/head.bin"] = options.head_model.empty() ? nullptr : document_of(options.head_model);
    for (std::size_t i = 0; i < options.other_heads.size(); ++i) {
      documents["/heads/" + std::to_string(i + 1) + ".bin"] =
          document_of(options.other_heads[i].model);
    }
  }
  const std::size_t at = page.find(kMark);
  if (at != std::string::npos) page.replace(at, kMark.size(), head);
  documents["/"] = documents["/index.html"] = make_document(std::move(page));
  documents["/live.css"] = make_document(std::string(page_style()));
  documents["/live.js"] = make_document(std::string(page_script()));
  return documents;
}

/// For frame-ancestors of the content security policy: who may use the server may show its page.
std::string frames_of(const WebOptions& options) {
  std::string frames = "'self'";
  for (const std::string& origin : options.allow_origins) frames += " " + origin;
  return frames;
}

/// Files that may be open: two connections a viewer, those that pass, and others.
Result<unsigned> handles_for(int viewers) {
  const auto wanted = unsigned(2 * viewers + int(ConnectionLimiter::kMostPassing) + kSpareHandles);
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return wanted;
  return make_error(Code::invalid_argument,
                    std::to_string(viewers) + " viewers take " + std::to_string(wanted) +
                        " open files, and this process may have " + std::to_string(limit.rlim_cur) +
                        "; allow more (ulimit -n) or fewer viewers");
}

}  // namespace

Server::Server(const WebAddress& address, const ServerOptions& options, ServerHandler handler)
    : options_(options.web),
      most_body_(options.most_body),
      handler_(std::move(handler)),
      intake_(options.intake),
      most_message_(options.most_message),
      may_watch_(options.may_watch),
      names_(address, options_.host_names),
      frames_(frames_of(options_)),
      documents_(documents_of(options_)),
      limiter_({options_.max_clients, options_.per_address, options_.stall_seconds}) {
  timer_.server = this;
}

// Each of them says goodbye three times, as that may get lost: all at once.
void Server::finish_peers(bool over) {
  std::vector<std::shared_ptr<PeerConnections>> all;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [path, broadcast] : broadcasts_) {
      if (broadcast->peers()) all.push_back(broadcast->peers());
    }
  }
  std::vector<std::thread> goodbyes;
  for (const auto& peers : all) {
    if (peers->busy() == 0) {
      peers->finish(over);
      continue;
    }
    try {
      goodbyes.emplace_back([peers, over] { peers->finish(over); });
    } catch (const std::system_error&) {
      peers->finish(over);
    }
  }
  for (std::thread& goodbye : goodbyes) goodbye.join();
}

void Server::serve() {
  service_.run();
  if (!options_.make_head_model || !options_.head_model.empty()) return;
  const auto make = [this] {
    DocumentPtr made;
    try {
      const std::vector<std::uint8_t> model = options_.make_head_model();
      made = model.empty() ? nullptr : document_of(model);
    } catch (const std::bad_alloc&) {
    }
    {
      const std::lock_guard lock(mutex_);
      late_head_.emplace(std::move(made));
    }
    service_.wake();
  };
  try {
    head_maker_ = std::thread(make);
  } catch (const std::system_error&) {
    make();
  }
}

// The head that has been made meanwhile, for those who wait for it.
void Server::take_late_head() {
  std::optional<DocumentPtr> head;
  {
    const std::lock_guard lock(mutex_);
    head.swap(late_head_);
  }
  if (!head) return;
  if (*head) {
    documents_["/head.bin"] = std::move(*head);
  } else {
    documents_.erase("/head.bin");
  }
  for (const auto& [wsi, session] : sessions_) {
    if (session.late) lws_callback_on_writable(wsi);
  }
}

void Server::stop() {
  if (head_maker_.joinable()) head_maker_.join();
  finish_peers(true);  // they answer no more
  {
    const std::lock_guard lock(answers_->mutex);
    answers_->service = nullptr;
  }
  service_.stop([this] { lws_sul_cancel(&timer_.entry); });
}

Result<std::unique_ptr<Server>> Server::listen(const WebAddress& address,
                                               const ServerOptions& options,
                                               ServerHandler handler) {
  static const lws_protocols protocols[] = {{"animeme", &Server::callback, 0, 1024, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  static const lws_extension extensions[] = {
      {"permessage-deflate", lws_extension_callback_pm_deflate, "permessage-deflate"},
      {nullptr, nullptr, nullptr}};
  if (Result<void> possible = check_listening(address); !possible) return possible.error();
  Result<unsigned> handles = handles_for(options.web.max_clients);
  if (!handles) return handles.error();
  std::unique_ptr<Server> server(new Server(address, options, std::move(handler)));
  lws_context_creation_info info{};
  info.port = address.port;
  info.iface = address.host == "0.0.0.0" || address.host == "::" ? nullptr : address.host.c_str();
  info.protocols = protocols;
  info.extensions = extensions;
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
                          "; is the port in use, or is the host not an address of this machine?");
  }
  server->answers_->service = &server->service_;
  server->keep_looking();
  return server;
}

std::shared_ptr<Broadcast> Server::make_broadcast(int sample_rate, std::function<void()> joined) {
  const auto touched = [this](std::shared_ptr<Broadcast> broadcast) {
    bool first = false;
    {
      const std::lock_guard lock(mutex_);
      first = touched_.empty();
      touched_.push_back(std::move(broadcast));
    }
    if (first) service_.wake();
  };
  return std::make_shared<Broadcast>(sample_rate, options_.client_bytes, options_.catch_up, touched,
                                     std::move(joined));
}

bool Server::open(const std::string& path, const std::shared_ptr<Broadcast>& broadcast) {
  const std::lock_guard lock(mutex_);
  return !finishing_ && broadcasts_.try_emplace(path, broadcast).second;
}

void Server::close(const std::string& path, bool comes_back) {
  std::shared_ptr<Broadcast> broadcast;
  {
    const std::lock_guard lock(mutex_);
    const auto found = broadcasts_.find(path);
    if (found == broadcasts_.end()) return;
    broadcast = std::move(found->second);
    broadcasts_.erase(found);
  }
  broadcast->end(comes_back);
}

void Server::finish(bool goes_away) {
  std::vector<std::shared_ptr<Broadcast>> broadcasts;
  {
    const std::lock_guard lock(mutex_);
    finishing_ = true;
    for (const auto& [path, broadcast] : broadcasts_) broadcasts.push_back(broadcast);
  }
  for (const auto& broadcast : broadcasts) broadcast->end(goes_away);
  finish_peers(!goes_away);
  const auto patience = Hub::Clock::now() + kGoodbye;
  for (const auto& broadcast : broadcasts) broadcast->wait_until_empty(patience);
  stop();
}

}  // namespace animeme::web
