#include "tools/speech/talking/line_command.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "tools/speech/talking/json_line_internal.h"

namespace animeme::speech {

namespace {

using tools::Json;
using Do = LineCommand::Do;
using When = LineCommand::When;

constexpr std::pair<std::string_view, Do> kDos[] = {
    {"say", Do::say},      {"stop", Do::stop}, {"drop", Do::drop}, {"mark", Do::mark},
    {"end", Do::end},      {"mood", Do::mood}, {"look", Do::look}, {"listen", Do::listen},
    {"think", Do::think},  {"idle", Do::idle}, {"hear", Do::hear}, {"pause", Do::pause},
    {"resume", Do::resume}};
constexpr std::pair<std::string_view, When> kWhens[] = {
    {"now", When::now}, {"next", When::next}, {"last", When::last}};

// Whether something that is no JSON has a member of this name: the name and a colon.
bool has_member(std::string_view line, std::string_view quoted) {
  for (std::size_t at = line.find(quoted); at != std::string_view::npos;
       at = line.find(quoted, at)) {
    at += quoted.size();
    const std::size_t next = line.find_first_not_of(" \t", at);
    if (next != std::string_view::npos && line[next] == ':') return true;
  }
  return false;
}

Result<std::string> text_of(const Json& object, const char* name) {
  const Json* found = object.find(name);
  if (found == nullptr || found->is_null()) return std::string();
  if (found->is_string()) return found->get<std::string>();
  if (found->is_number()) return found->dump();  // an id may be a number
  return make_error(Code::syntax, "\"" + std::string(name) + "\" has to be a text");
}

// The value of a name; an error that lists all names.
template <class Value, std::size_t kCount>
Result<Value> value_of(const std::string& member, const std::string& name,
                       const std::pair<std::string_view, Value> (&known)[kCount]) {
  std::string list;
  for (const auto& [text, value] : known) {
    if (text == name) return value;
    list += (list.empty() ? "" : ", ") + std::string(text);
  }
  return make_error(Code::not_found, "\"" + member + "\" cannot be \"" + name.substr(0, 40) +
                                         "\"; it is one of " + list);
}

// Of a member "mood", with an "intensity" in it or beside it.
Result<std::optional<dam::Mood>> read_line_mood(const Json& object) {
  const Json* found = object.find("mood");
  if (found == nullptr || found->is_null()) return std::optional<dam::Mood>();
  const bool inside = found->is_object();
  const Json* name = inside ? found->find("name") : found;
  const Json* intensity = inside ? found->find("intensity") : object.find("intensity");
  if (name == nullptr || !name->is_string()) {
    return make_error(Code::syntax,
                      "\"mood\" has to be a text or {\"name\": ..., \"intensity\": ...}");
  }
  const bool numbered = intensity != nullptr && !intensity->is_null();
  if (numbered && !intensity->is_number()) {
    return make_error(Code::syntax, "\"intensity\" has to be a number");
  }
  auto mood = numbered ? dam::make_mood(name->get<std::string>(), intensity->get<double>())
                       : dam::read_mood(name->get<std::string>());
  if (!mood) return mood.error();
  return std::optional(std::move(*mood));
}

// A text, or numbers: [20, -5].
Result<dam::Look> read_target(const Json& object) {
  const Json* found = object.find("target");
  if (found == nullptr || !(found->is_string() || found->is_array())) {
    return make_error(Code::invalid_argument,
                      "there is nothing to look at; put camera, away, YAW,PITCH or X,Y,Z into "
                      "\"target\"");
  }
  if (found->is_string()) return dam::parse_look(found->get<std::string>());
  std::string text;
  for (const Json& number : *found) text += (text.empty() ? "" : ",") + number.dump();
  return dam::parse_look(text);
}

// Names of a command's members besides "do". A typing error must not be ignored.
Result<void> check_members(const Json& object, Do what) {
  std::vector<std::string_view> known = {"do", "id"};
  switch (what) {
    case Do::say:
      known.insert(known.end(), {"text", "when", "lang", "language", "mood", "intensity"});
      break;
    case Do::mood:
      known.insert(known.end(), {"mood", "intensity"});
      break;
    case Do::look:
      known.insert(known.end(), {"target"});
      break;
    case Do::hear:
      known.insert(known.end(), {"voice"});
      break;
    default:
      break;
  }
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string_view name : known)
      list += (list.empty() ? "" : ", ") + std::string(name);
    return make_error(Code::invalid_argument,
                      "there is no member \"" + key.substr(0, 40) + "\"; there are " + list);
  }
  return {};
}

LineCommand said(std::string line) {
  LineCommand command;
  command.text = line;
  command.payload = std::move(line);
  return command;
}

// Without "do": say.
Result<LineCommand> command_of(const Json& object, std::string line, bool json) {
  const Result<std::string> what = text_of(object, "do");
  const Result<std::string> when = text_of(object, "when");
  Result<std::string> id = text_of(object, "id"), text = text_of(object, "text");
  for (const auto* one : {&what, &when}) {
    if (!*one) return one->error();
  }
  if (!id) return id.error();
  if (!text) return text.error();
  LineCommand command;
  if (object.contains("do")) {
    const Result<Do> wanted = value_of("do", *what, kDos);
    if (!wanted) return wanted.error();
    command.what = *wanted;
  }
  if (!json || command.what != Do::say) {
    if (auto ok = check_members(object, command.what); !ok) return ok.error();
  }
  if (!when->empty()) {
    const Result<When> place = value_of("when", *when, kWhens);
    if (!place) return place.error();
    command.when = *place;
  }
  command.id = std::move(*id);
  if (command.what == Do::say || command.what == Do::mood) {
    auto mood = read_line_mood(object);
    if (!mood) return mood.error();
    command.mood = std::move(*mood);
  }
  if (command.what == Do::look) {
    Result<dam::Look> target = read_target(object);
    if (!target) return target.error();
    command.target = *target;
  }
  if (command.what == Do::hear) {
    const Json* voice = object.find("voice");
    if (voice == nullptr || !voice->is_boolean()) {
      return make_error(Code::invalid_argument,
                        "put into \"voice\" whether the other party speaks: true or false");
    }
    command.voice = voice->get<bool>();
  }
  if (command.what == Do::mood && !command.mood) {
    return make_error(Code::invalid_argument,
                      "there is no mood; put its name into \"mood\": joy, neutral ...");
  }
  if (command.what != Do::say) return command;
  if (!json) {
    const char* const name = object.contains("lang") ? "lang" : "language";
    Result<std::string> language = text_of(object, name);
    if (!language) return language.error();
    command.language = std::move(*language);
  }
  command.text = std::move(*text);
  command.payload = json ? std::move(line) : command.text;
  if (command.payload.find_first_not_of(" \t\r\n") == std::string::npos) {
    return make_error(Code::invalid_argument, "there is nothing to say; put it into \"text\"");
  }
  return command;
}

}  // namespace

Result<LineCommand> read_line(std::string line, bool json) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // before the first line of some files
  if (line.starts_with(kMark)) line.erase(0, kMark.size());
  if (!line.starts_with('{')) return said(std::move(line));
  const Result<Json> object = parse_object(line);
  if (!object) {
    const bool meant = has_member(line, R"("do")") || has_member(line, R"("text")");
    if (!json && meant) return object.error();
    return said(std::move(line));  // who makes pieces of lines says what is wrong with this one
  }
  const bool command = object->contains("do") || (!json && object->contains("text"));
  if (command) return command_of(*object, std::move(line), json);
  if (!json) return said(std::move(line));
  LineCommand piece;
  if (const auto id = text_of(*object, "id")) piece.id = *id;
  if (const auto text = text_of(*object, "text")) piece.text = *text;
  auto mood = read_line_mood(*object);
  if (!mood) return mood.error();
  piece.mood = std::move(*mood);
  piece.payload = std::move(line);
  return piece;
}

}  // namespace animeme::speech
