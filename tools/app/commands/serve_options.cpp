#include "tools/app/commands/serve_options.h"

#include "tools/app/commands/options.h"
#include "tools/app/commands/stream_options.h"

namespace animeme::tools {

namespace {

std::string bad_url(const std::string& text) {
  const auto sink = web::make_web_sink(text);
  return sink ? std::string() : sink.error().message;
}

std::string bad_model(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string::npos && serve::is_head_name(text.substr(0, equals));
  return named && equals + 1 < text.size() ? std::string() : "write it as NAME=FILE";
}

void add_server_web_options(OptionTable& cli, web::WebOptions& options) {
  options.max_clients = 1000;
  options.per_address = 0;
  cli.add("--max-clients", options.max_clients, "Most viewers of all heads at the same time")
      ->between(1, 10000)
      ->show_default();
  cli.add("--max-per-address", options.per_address,
          "Most connections per client address, about two per viewer; also limits its "
          "requests; 0: no limit, behind a proxy")
      ->between(0, 10000)
      ->show_default();
  add_guard_options(cli, options);
}

}  // namespace

void add_options(OptionTable& cli, ServeOptions& options) {
  serve::ServerOptions& server = options.server;
  cli.add("heads", options.heads,
          "File with heads that exist from the start: {\"defaults\": {...}, \"heads\": [{\"name\": "
          "\"anna\", \"lang\": \"en+f3\"}, ...]}");
  cli.add("--listen", server.url,
          "Address: by default this machine only; http://0.0.0.0:8080 for all (with a token)")
      ->value("URL=http://127.0.0.1:8080/")
      ->check(bad_url);
  cli.add("--token-file", options.token_file,
          "File with the token that requests need, as \"Authorization: Bearer TOKEN\"; "
          "default: the variable ANIMEME_TOKEN, else none");
  cli.add("--model", options.models,
          "Model that heads may use, with its name; may be repeated; default: the built-in "
          "model")
      ->value("NAME=FILE")
      ->check(bad_model)
      ->one_at_a_time();
  cli.add("--max-heads", server.most_heads, "Most heads at the same time")
      ->between(1, 10000)
      ->show_default();
  cli.add("--expire", server.expire,
          "Seconds without a line or viewer after which a head that was created by a request "
          "is removed; 0: never")
      ->at_least_zero()
      ->show_default();
  cli.add("--make-on-say", server.make_on_say,
          "Create a head that does not exist when it is told to speak, with the defaults of "
          "the file");
  cli.add("--threads", server.threads, "Threads for synthesis; 0: one per core")
      ->between(0, 64)
      ->show_default();
  add_server_web_options(cli, server.web);
  cli.add("--stats", options.stats, "Print statistics once per second");
  cli.add("--json", options.json, "Print the address as JSON at the start, statistics at the end");
  cli.show_in_help_all("Server",
                       "--threads --max-clients --max-per-address --allow-origin --host-name");
}

}  // namespace animeme::tools
