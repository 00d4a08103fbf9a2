// Many talking heads in one process, on one port.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>

#include "tools/app/commands/common.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/line.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/over_options.h"
#include "tools/app/commands/shown_heads.h"
#include "tools/app/commands/stream_options.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/programs/command_template.h"
#include "tools/live/serve/server.h"
#include "tools/live/sessions/address.h"

namespace animeme::tools {

namespace {

// What was said on the command line.
struct ServeOptions {
  std::string heads;                  // file with heads that are there from the beginning
  std::string settings;               // --settings, which line.cpp has read
  std::string token_file;             // --token-file
  std::vector<std::string> models;    // --model, NAME=FILE
  std::vector<std::string> tts;       // --tts, NAME=COMMAND
  std::string viewers = "open";       // --viewers
  std::vector<std::string> ice;       // --ice-server
  std::string audio_repeat = "auto";  // --audio-repeat
  std::vector<std::string> overs;     // --over, likewise
  HeadChoices faces;                  // --head and what belongs to it
  serve::ServerOptions server;        // all others
  bool stats = false;                 // --stats
  double drain = 30;                  // --drain
  std::string log;                    // --log
  bool json = false;                  // --json
};

std::string bad_url(const std::string& text) {
  const auto sink = web::make_web_sink(text);
  return sink ? std::string() : sink.error().message;
}

std::string bad_model(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string::npos && serve::is_head_name(text.substr(0, equals));
  return named && equals + 1 < text.size() ? std::string() : "write it as NAME=FILE";
}

std::string bad_tts(const std::string& text) {
  if (const std::string problem = bad_model(text); !problem.empty()) {
    return "write it as NAME=COMMAND";
  }
  const auto command = parse_command(text.substr(text.find('=') + 1));
  return command ? std::string() : command.error().message;
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

// Adds them.
void add_options(OptionTable& cli, ServeOptions& options) {
  serve::ServerOptions& server = options.server;
  cli.add("heads", options.heads,
          "File with heads that exist from the start: {\"defaults\": {...}, \"heads\": [{\"name\": "
          "\"anna\", \"lang\": \"en+f3\"}, ...]}");
  cli.add("--settings", options.settings,
          "File with options, a line each: max-heads = 50, make-on-say = true, heads = FILE; the "
          "command line comes first; SIGHUP reads it again")
      ->value("FILE");
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
  cli.add("--tts", options.tts,
          "External TTS command, as that of speak --tts, with a name by which heads may ask for "
          "it; may be repeated; default: espeak-ng alone")
      ->value("NAME=COMMAND")
      ->check(bad_tts)
      ->one_at_a_time();
  cli.add("--viewers", options.viewers,
          "Who may watch: open, everybody; token, who has the token, or a ticket for the head")
      ->one_of("open token")
      ->show_default();
  cli.add("--over", options.overs,
          "Performance (a file with a face) that heads may keep under their speech, with its name; "
          "it repeats; may be repeated")
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
  cli.add("--max-waiting", server.most_seconds,
          "Most seconds of speech that may wait for a head, besides one line; more is refused")
      ->between(1.0, 1e6)
      ->show_default();
  cli.add("--drain", options.drain,
          "Seconds in which what is being said may end after SIGTERM; the rest is cancelled")
      ->between(0.0, 3600.0)
      ->show_default();
  cli.add("--make-on-say", server.make_on_say,
          "Create a head that does not exist when it is told to speak, with the defaults of "
          "the file");
  cli.add("--threads", server.threads, "Threads for synthesis; 0: one per core")
      ->between(0, 64)
      ->show_default();
  add_server_web_options(cli, server.web);
  add_rtc_options(cli, options.ice, options.audio_repeat);
  add_heads_options(cli, options.faces.heads, options.faces.rest);
  cli.add("--log", options.log,
          "Write requests, heads and lines to standard error, without texts: text, or a JSON "
          "object per line")
      ->one_of("text json");
  cli.add("--stats", options.stats, "Print statistics once per second");
  cli.add("--json", options.json, "Print the address as JSON at the start, statistics at the end");
  cli.show_in_help_all("Server",
                       "--threads --ice-server --audio-repeat --max-waiting --drain --max-clients "
                       "--max-per-address --allow-origin --host-name "
                       "--points --shape-name --shape-names --gain");
}

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

// An entry of the log with the time of day.
void write_log(const Json& entry, bool as_json) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  const std::time_t seconds = std::time_t(ms / 1000);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  const std::string time =
      format("%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
             utc.tm_hour, utc.tm_min, utc.tm_sec, int(ms % 1000));
  std::string line;
  if (as_json) {
    Json all{{"time", time}};
    all.update(entry);
    line = all.dump();
  } else {
    line = time;
    for (const auto& [key, value] : entry.items()) {
      line += " " + (value.is_string() ? value.text() : key + "=" + value.dump());
    }
  }
  std::fprintf(stderr, "%s\n", line.c_str());
}

// No new lines; those that were accepted are spoken.
void wait_for_silence(serve::HeadServer& server, double seconds) {
  server.drain();
  const double end = media::steady_clock().now() + seconds;
  while (!server.silent() && media::steady_clock().now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

using NamedHeads = std::vector<std::pair<std::string, serve::HeadSettings>>;

// What is read from files, and named: the token, models, voices, performances, heads. Gives what
// is wrong with the options; empty: nothing.
Result<std::string> read_named(const ServeOptions& options, serve::ServerOptions& wanted,
                               NamedHeads& heads) {
  Result<std::string> token = read_token(options.token_file);
  if (!token) return token.error();
  wanted.token = *token;
  if (wanted.token.empty() && web::is_open_to_others(wanted.url)) {
    return std::string(
        "anyone who can reach that address could create heads and let them talk; give a token "
        "(--token-file), or listen on this machine only");
  }
  for (const std::string& model : options.models) {
    const std::size_t equals = model.find('=');
    wanted.models[model.substr(0, equals)] = model.substr(equals + 1);
  }
  for (const std::string& tts : options.tts) {
    const std::size_t equals = tts.find('=');
    wanted.tts[tts.substr(0, equals)] = tts.substr(equals + 1);
  }
  wanted.guard_viewers = options.viewers == "token";
  if (wanted.guard_viewers && wanted.token.empty()) {
    return std::string("--viewers token needs a token (--token-file)");
  }
  for (const std::string& over : options.overs) {
    const std::size_t equals = over.find('=');
    auto performance = read_performance(over.substr(equals + 1));
    if (!performance) return performance.error();
    wanted.performances[over.substr(0, equals)] =
        std::make_shared<const dam::Performance>(std::move(*performance));
  }
  if (options.heads.empty()) return std::string();
  Result<serve::HeadList> list = serve::read_head_list(options.heads, wanted.defaults);
  if (!list) return list.error();
  wanted.defaults = list->defaults;
  heads = std::move(list->heads);
  if (heads.size() > std::size_t(wanted.most_heads)) {
    return "the file has " + std::to_string(heads.size()) +
           " heads; allow as many with --max-heads";
  }
  return std::string();
}

// SIGHUP: the files as they are now, for what comes from now on. Where something is wrong with
// them, all stays as it is.
Result<void> read_again(serve::HeadServer& server) {
  ServeOptions options;
  OptionTable table("serve", "", "");
  add_options(table, options);
  if (auto ok = parse_again(table); !ok) return ok;
  NamedHeads heads;
  const Result<std::string> problem = read_named(options, options.server, heads);
  if (!problem) return problem.error();
  if (!problem->empty()) return make_error(Code::invalid_argument, *problem);
  if (auto ok = server.change(options.server); !ok) return ok;
  for (const auto& [name, settings] : heads) {
    if (server.find(name)) continue;
    const auto made = server.make(name, settings, false);
    if (!made) return make_error(made.error().code, name + ": " + made.error().describe());
  }
  return {};
}

void take_settings(serve::HeadServer& server, const serve::Log& log) {
  const Result<void> taken = read_again(server);
  if (!taken) {
    warn("the settings stay as they were: " + taken.error().describe());
  } else {
    say("read the settings again");
  }
  if (!log) return;
  Json entry{{"kind", "settings"}, {"what", taken ? "read again" : "refused"}};
  if (!taken) entry["why"] = taken.error().describe();
  log(entry);
}

Result<int> run(ServeOptions& options) {
  serve::ServerOptions& wanted = options.server;
  if (const std::string problem = problem_of(options.faces); !problem.empty()) {
    return usage_error(problem);
  }
  NamedHeads heads;
  const Result<std::string> problem = read_named(options, wanted, heads);
  if (!problem) return problem.error();
  if (!problem->empty()) return usage_error(*problem);
  allow_many_files();
  voice::keep_voices();  // while this process is small
  const studio::HeadChoice& rest = options.faces.rest;
  if (!options.faces.heads.empty() || rest.names_shapes() || !rest.points.empty() ||
      rest.gain != "1") {
    if (auto given = give_heads(options.faces, wanted.web); !given) return given.error();
  }
  if (auto ok = use_rtc_options(options.ice, options.audio_repeat, wanted.web); !ok) {
    return usage_error(ok.error().message);
  }
  wanted.web = live::with_head(wanted.web);
  if (!options.log.empty()) {
    wanted.log = [json = options.log == "json"](const Json& entry) { write_log(entry, json); };
  }
  const Interrupt interrupt(kLiveGrace + unsigned(std::ceil(options.drain)));
  std::optional<Hangup> hangup;
  if (!options.settings.empty() || !options.token_file.empty() || !options.heads.empty()) {
    hangup.emplace();  // without such files SIGHUP ends the program, as a terminal that closes does
  }
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
    if (hangup && Hangup::taken()) take_settings(**server, wanted.log);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (i % 10 != 0) continue;
    (*server)->look();
    if (options.stats) show_figures(status, **server);
  }
  status.clear();
  if (Interrupt::terminated()) wait_for_silence(**server, options.drain);
  const Json figures = (*server)->figures();
  (*server)->finish();
  if (options.json) std::printf("%s\n", pretty(figures).c_str());
  return Interrupt::terminated() ? kOk : kInterrupted;
}

}  // namespace

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
    "  animeme serve --head me.glb --gain auto          # pages show your avatar\n"
    "SIGTERM ends it in good order, exit code 0, Ctrl-C with 130: viewers are told.",
    set_up<ServeOptions>};

}  // namespace animeme::tools
