// Many talking heads in one process, on one port.
#include "tools/app/commands/serve_options.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tools/app/commands/common.h"
#include "tools/app/commands/interrupt.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/live/sessions/address.h"

namespace animeme::tools {

namespace {

constexpr std::size_t kMostToken = 400;  // bytes; headers of 512 are read

/// Thousands of viewers need as many open files as the system lets one have.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

Result<std::string> read_token(const std::string& path) {
  std::string token;
  if (path.empty()) {
    const char* set = std::getenv("ANIMEME_TOKEN");
    if (set == nullptr) return token;
    token = set;
  } else {
    const auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    token.assign(bytes->begin(), bytes->end());
  }
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  const bool plain =
      std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (token.empty() || token.size() > kMostToken || !plain) {
    const Error bad = make_error(Code::invalid_argument,
                                 "a token is 1 to 400 letters, digits and signs without blanks");
    return path.empty() ? make_error(bad.code, "ANIMEME_TOKEN: " + bad.message) : bad.in_file(path);
  }
  return token;
}

void show_figures(StatusLine& status, const serve::HeadServer& server) {
  const Json figures = server.figures();
  status.show(
      format("%d heads, %d awake, %d viewers, planes late by %.1f ms (half), %.1f ms (99 %%), "
             "%.1f MB",
             figures["count"].get<int>(), figures["awake"].get<int>(),
             figures["viewers"].get<int>(), figures["late_50_ms"].get<double>(),
             figures["late_99_ms"].get<double>(), figures["memory_mb"].get<double>()));
}

}  // namespace

Result<int> run(ServeOptions& options) {
  serve::ServerOptions& wanted = options.server;
  Result<std::string> token = read_token(options.token_file);
  if (!token) return token.error();
  wanted.token = *token;
  if (wanted.token.empty() && web::is_open_to_others(wanted.url)) {
    return usage_error(
        "anyone who can reach that address could create heads and let them talk; give a token "
        "(--token-file), or listen on this machine only");
  }
  for (const std::string& model : options.models) {
    const std::size_t equals = model.find('=');
    wanted.models[model.substr(0, equals)] = model.substr(equals + 1);
  }
  std::vector<std::pair<std::string, serve::HeadSettings>> heads;
  if (!options.heads.empty()) {
    Result<serve::HeadList> list = serve::read_head_list(options.heads, wanted.defaults);
    if (!list) return list.error();
    wanted.defaults = list->defaults;
    heads = std::move(list->heads);
    if (heads.size() > std::size_t(wanted.most_heads)) {
      return usage_error("the file has " + std::to_string(heads.size()) +
                         " heads; allow as many with --max-heads");
    }
  }
  allow_many_files();
  voice::keep_voices();  // while this process is small
  wanted.web = live::with_head(wanted.web);
  const Interrupt interrupt;
  auto server = serve::HeadServer::open(wanted, heads);
  if (!server && server.error().code == Code::invalid_argument) {
    return usage_error(server.error().message);
  }
  if (!server) return server.error();
  say("serving at " + (*server)->address() + "; Ctrl-C ends it");
  if (options.json) {
    std::printf("%s\n", Json{{"address", (*server)->address()}}.dump().c_str());
    std::fflush(stdout);
  }
  StatusLine status;
  for (int i = 1; !Interrupt::requested(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (i % 10 != 0) continue;
    (*server)->look();
    if (options.stats) show_figures(status, **server);
  }
  status.clear();
  const Json figures = (*server)->figures();
  (*server)->finish();
  if (options.json) std::printf("%s\n", pretty(figures).c_str());
  return Interrupt::terminated() ? kOk : kInterrupted;
}

const Command kServe{
    "serve", "Serve many talking heads on one port, controlled by HTTP requests",
    "  animeme serve &\n"
    "  curl -X PUT http://127.0.0.1:8080/heads/anna -d '{\"lang\": \"en+f3\"}'\n"
    "  curl http://127.0.0.1:8080/heads/anna/say -d 'Hello, I am Anna.'\n"
    "  xdg-open http://127.0.0.1:8080/heads/anna/       # a page; /faps, /face, /audio for "
    "programs\n"
    "  curl http://127.0.0.1:8080/heads                 # how all of them are; also /metrics, "
    "/health\n"
    "  curl -X DELETE http://127.0.0.1:8080/heads/anna\n"
    "SIGTERM ends it in good order, exit code 0, Ctrl-C with 130: viewers are told.",
    set_up<ServeOptions>};

}  // namespace animeme::tools
