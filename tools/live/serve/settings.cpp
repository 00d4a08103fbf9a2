#include "tools/live/serve/settings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "dam/performance/kept_shares.h"
#include "fap/rate_text.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/files.h"

namespace animeme::serve {
namespace {

using tools::Json;

Error bad_setting(std::string sentence) {
  return make_error(Code::invalid_argument, std::move(sentence));
}

/// Reads members of an object one by one; keeps the first fault.
class Members {
 public:
  explicit Members(const Json& json) : json_(json) {}

  template <class Number>
  void number(const char* name, double low, double high, Number& value) {
    const Json* found = find(name);
    if (found == nullptr) return;
    const bool whole = !std::is_integral_v<Number> || found->is_number_integer();
    const double read = found->is_number() && whole ? found->get<double>() : NAN;
    if (!(read >= low && read <= high)) {
      return fault(tools::format("\"%s\" is %s from %g to %g", name,
                                 std::is_integral_v<Number> ? "a whole number" : "a number", low,
                                 high));
    }
    value = Number(read);
  }
  /// As settings_json() writes what is not set.
  bool is_null(const char* name) {
    const Json* found = find(name);
    return found != nullptr && found->is_null();
  }
  void flag(const char* name, bool& value) {
    const Json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_boolean()) return fault(tools::format("\"%s\" is true or false", name));
    value = found->get<bool>();
  }
  /// True: it is there.
  bool text(const char* name, std::string& value) {
    const Json* found = find(name);
    if (found == nullptr) return false;
    if (!found->is_string() || found->text().size() > 200) {
      fault(tools::format("\"%s\" is a text of up to 200 bytes", name));
      return false;
    }
    value = found->get<std::string>();
    return true;
  }
  /// A text that `reader` makes a value of.
  template <class Value>
  void read(const char* name, Result<Value> (*reader)(std::string_view), Value& value) {
    std::string written;
    if (!text(name, written)) return;
    const Result<Value> made = reader(written);
    if (!made) return fault("\"" + std::string(name) + "\": " + made.error().message);
    value = *made;
  }
  void fault(std::string sentence) {
    if (fault_.empty()) fault_ = std::move(sentence);
  }
  /// What was wrong, or that there is a member that was not asked for.
  Result<void> done() const {
    if (!fault_.empty()) return bad_setting(fault_);
    for (const auto& [name, value] : json_.items()) {
      if (known_.contains(name)) continue;
      std::string all;
      for (const std::string& one : known_) all += (all.empty() ? "" : ", ") + one;
      return bad_setting("a head has no \"" + name.substr(0, 60) + "\"; there are " + all);
    }
    return {};
  }

 private:
  const Json* find(const char* name) {
    known_.insert(name);
    return json_.find(name);
  }
  const Json& json_;
  std::set<std::string, std::less<>> known_;
  std::string fault_;
};

}  // namespace

HeadSettings::HeadSettings() {
  voice.lead_silence = 0.1;  // time to open the mouth, as for `stream --say`
  voice.tail_silence = 0.3;
  motion.articulation = std::nullopt;
  motion.tongue = motion.symmetric_rest = true;
  audio = {media::AudioCodec::opus, 48000, 5};
  audio.expected_loss = media::AudioSettings::kLossByReports;
}

Result<HeadSettings> read_settings(const Json& json, HeadSettings settings) {
  if (!json.is_object()) return bad_setting("settings of a head are a JSON object, {...}");
  Members members(json);
  members.text("model", settings.model);
  members.text("lang", settings.voice.language);
  members.number("speed", 80, 450, settings.voice.words_per_minute);
  members.number("pitch", 0, 100, settings.voice.pitch);
  members.text("tts", settings.tts);
  int voice_rate = 0;
  if (!members.is_null("voice_rate")) {
    members.number("voice_rate", 8000, 48000, voice_rate);
    if (voice_rate > 0) settings.voice_rate = voice_rate;
  } else {
    settings.voice_rate = 0;
  }
  members.text("head", settings.head);
  std::string rate;
  double hertz = settings.motion.rate.frames_per_second();
  if (json.contains("rate") && json["rate"].is_string()) {
    members.text("rate", rate);
  } else {
    members.number("rate", 1, 100, hertz);
    if (json.contains("rate")) rate = tools::format("%g", hertz);
  }
  if (!rate.empty()) {
    const Result<fap::Rate> read = fap::parse_rate(rate);
    if (!read) {
      members.fault("\"rate\": " + read.error().message);
    } else if (!(read->frames_per_second() >= 1 && read->frames_per_second() <= 100)) {
      members.fault("\"rate\" is from 1 to 100");
    } else {
      settings.motion.rate = *read;
    }
  }
  members.number("style", 0, dam::kMostStyle, settings.motion.style);
  members.number("sharpness", 0, dam::kMostSharpness, settings.motion.sharpness);
  double articulation = -1;  // that of the model
  if (!members.is_null("articulate"))
    members.number("articulate", 0, dam::kMostArticulation, articulation);
  if (articulation >= 0) settings.motion.articulation = articulation;
  members.flag("symmetric", settings.motion.symmetric_rest);
  members.flag("idle_motion", settings.idle_motion);
  members.flag("tongue", settings.motion.tongue);
  members.text("over", settings.over);
  if (members.text("keep", settings.keep)) {
    const auto shares = dam::parse_kept_shares(settings.keep);
    if (!shares) members.fault("\"keep\": " + shares.error().message);
  }
  members.read("mood", dam::read_mood, settings.mood);
  members.number("seed", 0, 1e9, settings.idle.seed);
  members.number("liveliness", 0, dam::kMostLiveliness, settings.idle.liveliness);
  members.read("still", dam::parse_still, settings.idle.still);
  members.read("look", dam::parse_look, settings.idle.look);
  members.number("intra_seconds", 0.04, 60, settings.intra_seconds);
  members.number("encoder_delay", 0, 10, settings.encoder_delay);
  members.number("quant", 0, 31, settings.quant);
  members.flag("sound", settings.sound);
  std::string codec;
  if (members.text("audio_codec", codec)) {
    if (codec != "opus" && codec != "aac") members.fault("\"audio_codec\" is \"opus\" or \"aac\"");
    settings.audio.codec = codec == "aac" ? media::AudioCodec::aac : media::AudioCodec::opus;
  }
  members.number("audio_bitrate", 8000, 256000, settings.audio.bit_rate);
  members.number("audio_effort", 0, 10, settings.audio.effort);
  if (json.contains("audio_fec") && json["audio_fec"].is_string()) {
    std::string percent;
    members.text("audio_fec", percent);
    if (percent != "auto") members.fault("\"audio_fec\" is \"auto\" or a number from 0 to 50");
    settings.audio.expected_loss = media::AudioSettings::kLossByReports;
  } else {
    members.number("audio_fec", 0, 50, settings.audio.expected_loss);
  }
  if (auto ok = members.done(); !ok) return ok.error();
  return settings;
}

HeadSettings with_live_parts(HeadSettings from, const HeadSettings& to) {
  from.voice = to.voice;
  from.tts = to.tts;
  from.mood = to.mood;
  from.idle.look = to.idle.look;
  return from;
}

Json settings_json(const HeadSettings& settings) {
  return {{"model", settings.model},
          {"lang", settings.voice.language},
          {"speed", settings.voice.words_per_minute},
          {"pitch", settings.voice.pitch},
          {"tts", settings.tts},
          {"voice_rate", settings.voice_rate > 0 ? Json(settings.voice_rate) : Json(nullptr)},
          {"head", settings.head},
          {"rate", fap::format_rate(settings.motion.rate)},
          {"style", settings.motion.style},
          {"sharpness", settings.motion.sharpness},
          {"articulate",
           settings.motion.articulation ? Json(*settings.motion.articulation) : Json(nullptr)},
          {"symmetric", settings.motion.symmetric_rest},
          {"idle_motion", settings.idle_motion},
          {"tongue", settings.motion.tongue},
          {"over", settings.over},
          {"keep", settings.keep},
          {"mood", dam::mood_text(settings.mood)},
          {"seed", settings.idle.seed},
          {"liveliness", settings.idle.liveliness},
          {"still", dam::format_still(settings.idle.still)},
          {"look", dam::format_look(settings.idle.look)},
          {"intra_seconds", settings.intra_seconds},
          {"encoder_delay", settings.encoder_delay},
          {"quant", settings.quant},
          {"sound", settings.sound},
          {"audio_codec", media::name_of(settings.audio.codec)},
          {"audio_bitrate", settings.audio.bit_rate},
          {"audio_effort", settings.audio.effort},
          {"audio_fec",
           settings.audio.expected_loss < 0 ? Json("auto") : Json(settings.audio.expected_loss)}};
}

bool is_head_name(std::string_view name) {
  constexpr std::size_t kMostName = 64;
  if (name.empty() || name.size() > kMostName || name.front() == '.') return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return letter || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  });
}

Result<HeadList> read_head_list(const std::string& path, const HeadSettings& defaults) {
  Result<std::vector<std::uint8_t>> bytes = tools::read_file(path);
  if (!bytes) return bytes.error();
  Result<Json> read_json =
      Json::parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  const Json json = read_json ? std::move(*read_json) : Json();
  if (!json["heads"].is_array()) {
    return make_error(Code::syntax,
                      "no list of heads; write {\"heads\": [{\"name\": \"anna\"}, ...]}")
        .in_file(path);
  }
  HeadList list{defaults, {}};
  if (json.contains("defaults")) {
    Result<HeadSettings> read = read_settings(json["defaults"], defaults);
    if (!read) return read.error().in_file(path);
    list.defaults = *read;
  }
  std::set<std::string> names;
  for (Json head : json["heads"]) {
    const bool named = head.is_object() && head.contains("name") && head["name"].is_string();
    const std::string name = named ? head["name"].get<std::string>() : std::string();
    if (!is_head_name(name)) {
      return bad_setting("each head has a \"name\" of letters, digits, -, _ and .").in_file(path);
    }
    if (!names.insert(name).second)
      return bad_setting("two heads are called " + name).in_file(path);
    head.erase("name");
    Result<HeadSettings> read = read_settings(head, list.defaults);
    if (!read) return bad_setting(name + ": " + read.error().message).in_file(path);
    list.heads.emplace_back(name, *read);
  }
  return list;
}

}  // namespace animeme::serve
