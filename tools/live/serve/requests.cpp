// What is answered to requests that are no viewers'.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>
#include <string_view>

#include "tools/formats/media/detail/tracks/words_internal.h"
#include "tools/live/serve/figures.h"
#include "tools/live/serve/index_page.h"
#include "tools/live/serve/say_intake.h"
#include "tools/live/serve/server.h"
#include "tools/speech/talking/line_command.h"

namespace animeme::serve {
namespace {

using tools::Json;
using web::ServerReply;

constexpr std::string_view kHeads = "/heads/", kSay = "/say", kTicket = "/ticket";
constexpr double kMostTicketSeconds = 30 * 86400.0;

ServerReply reply(unsigned status, const Json& json) { return {status, json.dump() + "\n"}; }

ServerReply refusal(unsigned status, const std::string& sentence) {
  return reply(status, {{"error", sentence}});
}

ServerReply refusal(const Error& error) {
  const bool busy = error.code == Code::out_of_range;
  const bool ours = error.code == Code::io || error.code == Code::internal;
  return refusal(ours ? 500 : busy ? 429 : 400, error.describe());
}

// 405, with what there is.
ServerReply other_method(const char* allow) {
  ServerReply refused = refusal(405, "There is " + std::string(allow) + ".");
  refused.allow = allow;
  return refused;
}

// After so many seconds it is worth asking again.
ServerReply later(unsigned status, const std::string& why, double seconds) {
  ServerReply refused = refusal(status, why);
  refused.retry_after = int(std::ceil(std::clamp(seconds, 1.0, 60.0)));
  return refused;
}

// An object without "do" is a line to say.
std::string said(Json object) {
  if (!object.contains("do")) object["do"] = "say";
  return object.dump();
}

// JSON, or lines of text and commands.
Result<std::vector<std::string>> lines_of(const std::string& body) {
  std::vector<std::string> lines;
  const std::string whole(media::trim(body));
  const Result<Json> json = Json::parse(whole);
  if (json && json->is_object()) {
    lines.push_back(said(*json));
    return lines;
  }
  if (json && json->is_array()) {
    for (const Json& line : *json) {
      if (!line.is_object() && !line.is_string()) {
        return make_error(Code::invalid_argument,
                          "a list of lines has texts and objects: [\"Hello.\", {\"text\": ...}]");
      }
      lines.push_back(line.is_string() ? said(Json{{"text", line.text()}}) : said(line));
    }
    return lines;
  }
  std::istringstream stream(body);
  for (std::string line; std::getline(stream, line);) {
    lines.emplace_back(media::trim(line));
  }
  return lines;
}

// Stops and the like are accepted while the server drains.
bool speaks(const std::string& line) {
  const Result<speech::LineCommand> command = speech::read_line(line, false);
  return command && !line.empty() && command->what == speech::LineCommand::Do::say;
}

}  // namespace

bool HeadServer::allowed(const web::ServerRequest& request) const {
  constexpr std::string_view kBearer = "bearer ";  // in any case: RFC 9110, section 11.1
  const auto options = this->options();
  if (options->token.empty()) return true;
  const std::string_view given = request.authorization;
  if (media::lower_case(std::string(given.substr(0, kBearer.size()))) != kBearer) return false;
  const std::size_t begin = given.find_first_not_of(' ', kBearer.size());
  return begin != std::string_view::npos && same_secret(given.substr(begin), options->token);
}

bool HeadServer::may_watch(const web::ServerRequest& request) const {
  if (!request.path.starts_with(kHeads)) return true;
  const std::size_t end = request.path.find('/', kHeads.size());
  if (end == std::string::npos || allowed(request))
    return true;  // no viewer's, or that of the owner
  const std::string name = request.path.substr(kHeads.size(), end - kHeads.size());
  return Tickets(options()->token)
      .allows(name, query_value(request.query, "ticket"), std::time(nullptr));
}

ServerReply HeadServer::health() const {
  const std::lock_guard lock(mutex_);
  return reply(200, {{"status", draining_ ? "ending"
                                : late_   ? "degraded"
                                          : "ok"},
                     {"heads", heads_.size()}});
}

ServerReply HeadServer::ready() const {
  const bool is_ready = !draining();
  return reply(is_ready ? 200 : 503, {{"ready", is_ready}});
}

ServerReply HeadServer::answer(const web::ServerRequest& request) {
  const bool viewer = request.method == "GET" && request.path.starts_with(kHeads) &&
                      request.path.find('/', kHeads.size()) != std::string::npos;
  if (viewer) return refusal(404, "There is no such head, or it has nothing there.");
  // A page without anything of this server: it asks for the token.
  if (request.method == "GET" && (request.path == "/" || request.path == "/index.html")) {
    return {.status = 200,
            .body = std::string(index_page()),
            .type = "text/html; charset=utf-8",
            .frames = true};
  }
  if (request.method == "GET" && request.path == "/index.js") {
    return {200, std::string(index_script()), "text/javascript; charset=utf-8"};
  }
  if (request.method == "GET" && request.path == "/index.css") {
    return {200, std::string(index_style()), "text/css; charset=utf-8"};
  }
  if (!allowed(request)) {
    return refusal(401,
                   "This needs the header \"Authorization: Bearer TOKEN\" with the token of "
                   "the server.");
  }
  if (request.path.starts_with(kHeads)) {
    return answer_head(request, request.path.substr(kHeads.size()));
  }
  if (request.method != "GET") return other_method("GET, HEAD");
  if (request.path == "/heads") return reply(200, figures());
  if (request.path == "/metrics") return {200, metrics(), "text/plain; version=0.0.4"};
  return refusal(404,
                 "There are /heads, /heads/NAME, /heads/NAME/say, /heads/NAME/ticket, /health, "
                 "/ready and /metrics.");
}

ServerReply HeadServer::answer_head(const web::ServerRequest& request, const std::string& name) {
  const bool made =
      request.method == "PUT" || request.method == "POST" || request.method == "PATCH";
  if (name.ends_with(kSay)) {
    if (request.method != "POST") return other_method("POST");
    return say(name.substr(0, name.size() - kSay.size()), request.body);
  }
  if (name.ends_with(kTicket)) {
    if (request.method != "POST") return other_method("POST");
    return ticket(name.substr(0, name.size() - kTicket.size()), request.body);
  }
  if (made) return put(name, request.method, request.body);
  if (request.method == "DELETE") {
    if (!remove(name)) return refusal(404, "There is no such head.");
    return reply(200, {{"ended", name}});
  }
  const std::shared_ptr<Head> head = find(name);
  if (!head) return refusal(404, "There is no such head.");
  if (request.method != "GET") return other_method("GET, HEAD, PUT, POST, PATCH, DELETE");
  return reply(200, {{"name", name},
                     {"settings", settings_json(head->settings())},
                     {"figures", head_json(head->figures())}});
}

// PUT gives all settings, and PATCH those that change; POST makes a head.
ServerReply HeadServer::put(const std::string& name, const std::string& method,
                            const std::string& body) {
  const bool blank = body.find_first_not_of(" \t\r\n") == std::string::npos;
  const Result<Json> json = blank ? Json::object() : Json::parse(body);
  if (!json) return refusal(400, "The body is no JSON.");
  const std::shared_ptr<Head> known = find(name);
  if (!known && method == "PATCH") return refusal(404, "There is no such head.");
  const Result<HeadSettings> settings =
      read_settings(*json, method == "PATCH" ? known->settings() : options()->defaults);
  if (!settings) return refusal(settings.error());
  if (!known) return make_for_request(name, *settings);
  if (method == "POST" && settings_json(known->settings()) != settings_json(*settings)) {
    return refusal(409, "There is a head " + name + " with other settings; PUT changes it.");
  }
  if (auto done = update(name, *settings); !done) {
    if (done.error().code == Code::not_found && !find(name)) {
      return refusal(404, "There is no such head.");
    }
    return refusal(done.error());
  }
  return reply(200, {{"name", name}, {"path", std::string(kHeads) + name + "/"}});
}

ServerReply HeadServer::make_for_request(const std::string& name, const HeadSettings& settings) {
  if (draining()) return later(503, "The server is about to end.", 1);
  {
    const std::lock_guard lock(mutex_);
    if (late_) return later(503, "Planes are late already; more heads do not fit.", 10);
  }
  const auto made = make(name, settings);
  if (!made && made.error().code == Code::out_of_range) {
    return later(429, made.error().describe(), 60);
  }
  if (!made) return refusal(made.error());
  return reply(201, {{"name", name}, {"path", std::string(kHeads) + name + "/"}});
}

ServerReply HeadServer::ticket(const std::string& name, const std::string& body) const {
  double seconds = 3600;
  if (body.find_first_not_of(" \t\r\n") != std::string::npos) {
    const Result<Json> json = Json::parse(body);
    const Json* given = json && json->is_object() ? json->find("seconds") : nullptr;
    if (given == nullptr || json->size() != 1 || !given->is_number()) {
      return refusal(400, "The body is empty or {\"seconds\": 3600}.");
    }
    seconds = given->get<double>();
  }
  if (!(seconds >= 1 && seconds <= kMostTicketSeconds)) {
    return refusal(400, "A ticket is valid for 1 to 2592000 seconds.");
  }
  const std::string token = options()->token;
  if (token.empty()) return refusal(400, "Tickets are made with a token; there is none.");
  if (!find(name)) return refusal(404, "There is no such head.");
  const std::int64_t expires = std::int64_t(std::time(nullptr)) + std::int64_t(seconds);
  const std::string made = Tickets(token).make(name, expires);
  return reply(200, {{"ticket", made},
                     {"expires", expires},
                     {"path", std::string(kHeads) + name + "/?ticket=" + made}});
}

ServerReply HeadServer::say(const std::string& name, const std::string& body) {
  Result<std::vector<std::string>> read = lines_of(body);
  if (!read) return refusal(read.error());
  std::vector<std::string> lines = std::move(*read);
  const bool speech = std::any_of(lines.begin(), lines.end(), speaks);
  if (speech && draining()) return later(503, "The server is about to end.", 1);
  std::shared_ptr<Head> head = find(name);
  const auto options = this->options();
  if (!head && options->make_on_say) {
    const auto made = make(name, options->defaults);
    if (!made && made.error().code == Code::out_of_range) {
      return later(429, made.error().describe(), 60);
    }
    if (!made) return refusal(made.error());
    head = *made;
  }
  if (!head) return refusal(404, "There is no such head.");
  std::size_t bytes = body.size();
  for (const auto& [other, each] : all()) bytes += each->bytes_waiting();
  if (speech && bytes > options->most_bytes) {
    return later(429, "All heads together have too much to say; send more later.", 5);
  }
  const std::size_t count = lines.size();
  const auto ids = head->say(std::move(lines));
  if (!ids) {
    if (ids.error().code != Code::out_of_range) return refusal(ids.error());
    return later(429, ids.error().describe(), head->seconds_waiting() / 2);
  }
  return reply(202, {{"lines", count},
                     {"ids", *ids},
                     {"waiting", head->lines_waiting()},
                     {"seconds_waiting", std::round(head->seconds_waiting() * 10) / 10}});
}

}  // namespace animeme::serve
