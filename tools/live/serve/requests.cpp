// What is answered to requests that are no viewers'.
#include <sstream>
#include <string_view>

#include "tools/formats/media/detail/tracks/words_internal.h"
#include "tools/live/serve/figures.h"
#include "tools/live/serve/server.h"

namespace animeme::serve {
namespace {

using tools::Json;
using web::ServerReply;

constexpr std::string_view kHeads = "/heads/", kSay = "/say";

ServerReply reply(unsigned status, const Json& json) { return {status, json.dump() + "\n"}; }

ServerReply refusal(unsigned status, const std::string& sentence) {
  return reply(status, {{"error", sentence}});
}

ServerReply refusal(const Error& error) {
  const bool busy = error.code == Code::out_of_range;
  const bool ours = error.code == Code::io || error.code == Code::internal;
  return refusal(ours ? 500 : busy ? 429 : 400, error.describe());
}

// In a time that does not tell how much of it is right.
bool same(std::string_view one, std::string_view other) {
  unsigned different = one.size() == other.size() ? 0 : 1;
  for (std::size_t i = 0; i < one.size() && !other.empty(); ++i) {
    different |= unsigned(one[i] ^ other[i % other.size()]);
  }
  return different == 0;
}

std::vector<std::string> lines_of(const std::string& body) {
  std::vector<std::string> lines;
  std::istringstream stream(body);
  for (std::string line; std::getline(stream, line);) lines.emplace_back(media::trim(line));
  return lines;
}

}  // namespace

bool HeadServer::allowed(const web::ServerRequest& request) const {
  constexpr std::string_view kBearer = "Bearer ";
  if (options_.token.empty()) return true;
  const std::string_view given = request.authorization;
  return given.starts_with(kBearer) && same(given.substr(kBearer.size()), options_.token);
}

ServerReply HeadServer::answer(const web::ServerRequest& request) {
  if (request.path == "/health" && request.method == "GET") {
    const std::lock_guard lock(mutex_);
    return reply(200, {{"status", "ok"}, {"heads", heads_.size()}});
  }
  const bool viewer = request.method == "GET" && request.path.starts_with(kHeads) &&
                      request.path.find('/', kHeads.size()) != std::string::npos;
  if (viewer) return refusal(404, "There is no such head, or it has nothing there.");
  if (!allowed(request)) {
    return refusal(401,
                   "This needs the header \"Authorization: Bearer TOKEN\" with the token of "
                   "the server.");
  }
  if (request.path.starts_with(kHeads)) {
    return answer_head(request, request.path.substr(kHeads.size()));
  }
  if (request.method != "GET") return refusal(405, "There is GET.");
  if (request.path == "/heads") return reply(200, figures());
  if (request.path == "/metrics") return {200, metrics(), "text/plain; version=0.0.4"};
  return refusal(404, "There are /heads, /heads/NAME, /heads/NAME/say, /health and /metrics.");
}

ServerReply HeadServer::answer_head(const web::ServerRequest& request, const std::string& name) {
  const bool made = request.method == "PUT" || request.method == "POST";
  if (name.ends_with(kSay)) {
    if (request.method != "POST") return refusal(405, "There is POST.");
    return say(name.substr(0, name.size() - kSay.size()), request.body);
  }
  if (made) return put(name, request.body);
  if (request.method == "DELETE") {
    if (!remove(name)) return refusal(404, "There is no such head.");
    return reply(200, {{"ended", name}});
  }
  const std::shared_ptr<Head> head = find(name);
  if (!head) return refusal(404, "There is no such head.");
  return reply(200, {{"name", name},
                     {"settings", settings_json(head->settings())},
                     {"figures", head_json(head->figures())}});
}

ServerReply HeadServer::put(const std::string& name, const std::string& body) {
  const bool blank = body.find_first_not_of(" \t\r\n") == std::string::npos;
  const Result<Json> json = blank ? Json::object() : Json::parse(body);
  if (!json) return refusal(400, "The body is no JSON.");
  const Result<HeadSettings> settings = read_settings(*json, options_.defaults);
  if (!settings) return refusal(settings.error());
  const bool known = find(name) != nullptr;
  const auto made = make(name, *settings);
  if (!made) return known ? refusal(409, made.error().message) : refusal(made.error());
  return reply(known ? 200 : 201, {{"name", name}, {"path", std::string(kHeads) + name + "/"}});
}

ServerReply HeadServer::say(const std::string& name, const std::string& body) {
  std::vector<std::string> lines = lines_of(body);
  std::shared_ptr<Head> head = find(name);
  if (!head && options_.make_on_say) {
    const auto made = make(name, options_.defaults);
    if (!made) return refusal(made.error());
    head = *made;
  }
  if (!head) return refusal(404, "There is no such head.");
  const std::size_t count = lines.size();
  if (auto ok = head->say(std::move(lines)); !ok) return refusal(ok.error());
  return reply(202, {{"lines", count}, {"waiting", head->figures().lines}});
}

}  // namespace animeme::serve
