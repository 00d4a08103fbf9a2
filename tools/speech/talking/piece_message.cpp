#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "tools/formats/files/base64.h"
#include "tools/speech/talking/json_line_internal.h"
#include "tools/speech/talking/piece_message_internal.h"

namespace animeme::speech {

namespace {

using tools::Json;
using Names = std::initializer_list<std::string_view>;

constexpr int kMostPieceChannels = 16;

// "audioContent" and "audio_content" are one name.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c != '_') out += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

Error bad(std::string message) { return make_error(Code::syntax, std::move(message)); }

const Json* find(const Json& piece, Names names) {
  for (const Json::Member& member : piece.items()) {
    const std::string key = plain(member.key);
    if (std::find(names.begin(), names.end(), key) != names.end()) return &member.value;
  }
  return nullptr;
}

// Takes the first member of one of these names out of `piece`; null: there is none.
Json take(Json& piece, Names names) {
  for (const Json::Member& member : piece.items()) {
    const std::string key = plain(member.key);
    if (std::find(names.begin(), names.end(), key) == names.end()) continue;
    return piece.erase(member.key);
  }
  return nullptr;
}

Result<std::string> take_text(Json& piece, Names names) {
  Json value = take(piece, names);
  if (value.is_null()) return std::string();
  if (!value.is_string()) return bad("\"" + std::string(*names.begin()) + "\" has to be a text");
  return std::move(value.text());
}

// A name may be a number.
std::string take_name(Json& piece, Names names) {
  const Json value = take(piece, names);
  if (value.is_string()) return value.text();
  return value.is_number() ? value.dump() : std::string();
}

Result<double> take_number(Json& piece, Names names) {
  const Json value = take(piece, names);
  if (value.is_null()) return 0.0;
  if (!value.is_number()) return bad("\"" + std::string(*names.begin()) + "\" has to be a number");
  return value.get<double>();
}

bool is_true(const Json& piece, Names names) {
  const Json* found = find(piece, names);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

// Whether what is left of a piece may hold times: a list or an object, but not its own small talk.
bool may_hold_times(const Json& piece) {
  for (const auto& [key, value] : piece.items()) {
    if (value.is_structured() && !value.empty()) return true;
  }
  return false;
}

// One event of Azure Speech or Amazon Polly, whose "text" is a word.
bool is_event(const Json& piece) {
  if (find(piece, {"visemeid", "boundarytype"}) != nullptr) return true;
  if (find(piece, {"audiooffset"}) != nullptr) return true;
  return find(piece, {"time"}) != nullptr && find(piece, {"value"}) != nullptr &&
         find(piece, {"type"}) != nullptr;
}

// Services wrap their messages.
void unwrap(Json& piece) {
  for (const std::string_view name : {"result", "audiochunk"}) {
    const Json* inner = find(piece, {name});
    if (inner == nullptr || !inner->is_object()) continue;
    if (find(*inner, {"audiocontent", "audiochunk", "timestampinfo"}) == nullptr) continue;
    const Json unwrapped = take(piece, {name});
    piece.update(unwrapped);
  }
}

// OpenAI: "delta" is sound or text, as the type says.
Result<void> take_delta(Json& piece, const std::string& type, std::string& sound,
                        PieceMessage& message) {
  if (type.find("delta") == std::string::npos) return {};
  Result<std::string> delta = take_text(piece, {"delta"});
  if (!delta) return delta.error();
  if (delta->empty()) return {};
  if (type.find("transcript") != std::string::npos || type.find("text") != std::string::npos) {
    message.text = std::move(*delta);
    message.text_goes_on = true;
  } else if (type.find("audio") != std::string::npos) {
    sound = std::move(*delta);
  }
  return {};
}

Result<void> take_sound(Json& piece, const std::string& type, PieceMessage& message) {
  Result<std::string> coded = take_text(piece, {"audio", "audiobase64", "audiocontent", "data"});
  if (!coded) return coded.error();
  if (auto ok = take_delta(piece, type, *coded, message); !ok) return ok;
  Result<std::string> file = take_text(piece, {"file", "audiofile"});
  if (!file) return file.error();
  Result<std::string> coding =
      take_text(piece, {"encoding", "format", "audioformat", "outputformat", "audioencoding"});
  if (!coding) return coding.error();
  const Result<double> rate =
      take_number(piece, {"samplerate", "sampleratehertz", "rate", "samplingrate"});
  if (!rate) return rate.error();
  const Result<double> channels = take_number(piece, {"channels", "channelcount"});
  if (!channels) return channels.error();
  if (!coded->empty() && !file->empty()) return bad("\"audio\" and \"file\" are both there");
  if (*rate != 0 && !(*rate >= 1000 && *rate <= 384000)) {
    return make_error(Code::invalid_argument, "\"sample_rate\" has to be from 1000 to 384000");
  }
  const bool whole = *channels == std::floor(*channels);
  if (*channels != 0 && !(*channels >= 1 && *channels <= kMostPieceChannels && whole)) {
    return make_error(Code::invalid_argument, "\"channels\" has to be from 1 to 16");
  }
  auto bytes = tools::decode_base64(*coded);
  if (!bytes) return bad("\"audio\" is no base64");
  message.bytes = std::move(*bytes);
  message.file = std::move(*file);
  message.coding = std::move(*coding);
  message.sample_rate = *rate;
  message.channels = int(*channels);
  return {};
}

Result<void> take_labels(Json& piece, PieceMessage& message) {
  const Result<std::string> from = take_text(piece, {"timesfrom"});
  if (!from) return from.error();
  if (*from == "piece") {
    message.times_from = PieceMessage::From::piece;
  } else if (*from == "utterance") {
    message.times_from = PieceMessage::From::utterance;
  } else if (!from->empty()) {
    return make_error(
        Code::invalid_argument,
        "\"times_from\" is \"piece\" or \"utterance\", not \"" + from->substr(0, 40) + "\"");
  }
  Json script = take(piece, {"script"});
  // ElevenLabs tells the times of its text twice.
  const Json* alignment = find(piece, {"alignment"});
  if (alignment != nullptr && !alignment->is_null()) (void)take(piece, {"normalizedalignment"});
  message.labels_given = !script.is_null();
  if (script.is_string()) {
    message.labels = std::move(script.text());
  } else if (!script.is_null()) {
    message.labels = script.dump();
  } else if (is_event(piece)) {
    message.labels = piece.dump();
    message.labels_are_events = true;
  } else if (may_hold_times(piece)) {
    message.labels = piece.dump();
  }
  return {};
}

}  // namespace

Result<Json> parse_object(std::string_view text) {
  constexpr std::size_t kMostDeep = 64;
  Result<Json> json = Json::parse(text, {.deepest = kMostDeep});
  if (json && !json->is_object()) return bad("a piece is a JSON object, {...}");
  return json;
}

Result<PieceMessage> read_message(std::string_view json) {
  Result<Json> parsed = parse_object(json);
  if (!parsed) return parsed.error();
  Json& piece = *parsed;
  unwrap(piece);
  PieceMessage message;
  const Json* type_member = find(piece, {"type", "event"});
  const std::string type =
      type_member != nullptr && type_member->is_string() ? type_member->text() : std::string();
  for (const std::string_view own : {"do", "when", "id", "mood", "intensity"}) {
    (void)take(piece, {own});  // of line_command.h
  }
  if (auto ok = take_sound(piece, type, message); !ok) return ok.error();
  message.utterance =
      take_name(piece, {"utterance", "utteranceid", "contextid", "responseid", "itemid"});
  Result<std::string> language = take_text(piece, {"language", "lang"});
  if (!language) return language.error();
  message.language = std::move(*language);
  message.last = is_true(piece, {"done", "isfinal", "final", "last"}) || type == "done" ||
                 type.ends_with("audio.done");
  message.small_talk = message.last || !type.empty() || find(piece, {"isfinal", "done"}) != nullptr;
  if (const Json* wrong = find(piece, {"error"}); wrong != nullptr && !wrong->is_null()) {
    message.error = wrong->dump().substr(0, 200);
  } else if (type == "error") {
    message.error = piece.dump().substr(0, 200);
  }
  if (auto ok = take_labels(piece, message); !ok) return ok.error();
  if (message.labels_are_events || message.text_goes_on) return message;
  Result<std::string> text = take_text(piece, {"text", "transcript"});
  if (!text) return text.error();
  message.text = std::move(*text);
  return message;
}

}  // namespace animeme::speech
