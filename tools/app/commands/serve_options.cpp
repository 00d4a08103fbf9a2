#include "tools/app/commands/serve_options.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/brief_help.h"
#include "tools/app/commands/stream_options.h"

namespace animeme::tools {

namespace {

std::string bad_model(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string::npos && serve::is_head_name(text.substr(0, equals));
  return named && equals + 1 < text.size() ? std::string() : "write it as NAME=FILE";
}

void add_server_web_options(CLI::App& app, web::WebOptions& options) {
  options.max_clients = 1000;
  options.per_address = 0;
  app.add_option("--max-clients", options.max_clients, "Viewers of all heads at the same time")
      ->check(between(1, 10000))
      ->capture_default_str();
  app.add_option("--max-per-address", options.per_address,
                 "Connections of one address at the same time, about two a viewer; its requests "
                 "are then limited, too; 0: any number, behind a proxy")
      ->check(between(0, 10000))
      ->capture_default_str();
  add_guard_options(app, options);
}

}  // namespace

void add_options(CLI::App& app, ServeOptions& options) {
  serve::ServerOptions& server = options.server;
  app.add_option("heads", options.heads,
                 "File with heads that are there from the beginning: {\"defaults\": {...}, "
                 "\"heads\": [{\"name\": \"anna\", \"lang\": \"en+f3\"}, ...]}");
  app.add_option("--listen", server.url,
                 "Address: this machine alone, or http://0.0.0.0:8080 for all (with a token)")
      ->option_text("URL=http://127.0.0.1:8080/")
      ->check(read_by([](const std::string& url) { return web::make_web_sink(url); }));
  app.add_option("--token-file", options.token_file,
                 "File with the token that requests bring, as \"Authorization: Bearer TOKEN\"; "
                 "default: the variable ANIMEME_TOKEN, else none");
  app.add_option(
         "--model", options.models,
         "A model that heads may have, and its name; may be repeated; else the built-in one")
      ->option_text("NAME=FILE")
      ->check(written_so(bad_model))
      ->allow_extra_args(false);
  app.add_option("--max-heads", server.most_heads, "Heads at the same time")
      ->check(between(1, 10000))
      ->capture_default_str();
  app.add_option(
         "--expire", server.expire,
         "Seconds without a line and a viewer after which a head that was made by a request "
         "is forgotten; 0: never")
      ->check(at_least_zero())
      ->capture_default_str();
  app.add_flag("--make-on-say", server.make_on_say,
               "What is said to a head that is not there makes it, with the defaults of the file");
  app.add_option("--threads", server.threads, "Threads that make planes and sound; 0: one a core")
      ->check(between(0, 64))
      ->capture_default_str();
  add_server_web_options(app, server.web);
  app.add_flag("--stats", options.stats, "Tell once a second how it goes");
  app.add_flag("--json", options.json,
               "The address as JSON on standard output at the start, the figures at the end");
  show_in_help_all(
      app, "Details of the server",
      {"--threads", "--max-clients", "--max-per-address", "--allow-origin", "--host-name"});
}

}  // namespace animeme::tools
