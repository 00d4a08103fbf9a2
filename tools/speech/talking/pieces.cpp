#include "tools/speech/talking/pieces.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <utility>

#include "tools/formats/common/json.h"
#include "tools/formats/files/base64.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/talking/json_line_internal.h"
#include "tools/speech/talking/written_text.h"

namespace animeme::speech {

namespace {

using tools::Json;

constexpr int kPieceRate = 48000;  // Hz of the sound that is sent

// "audioContent" and "audio_content" are one name.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c != '_') out += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

Error bad(std::string message) { return make_error(Code::syntax, std::move(message)); }

// Takes the first member of one of these names out of `piece`; null: there is none.
Json take(Json& piece, std::initializer_list<std::string_view> names) {
  for (const Json::Member& member : piece.items()) {
    const std::string key = plain(member.key);
    if (std::find(names.begin(), names.end(), key) == names.end()) continue;
    return piece.erase(member.key);
  }
  return nullptr;
}

Result<std::string> take_text(Json& piece, std::initializer_list<std::string_view> names) {
  Json value = take(piece, names);
  if (value.is_null()) return std::string();
  if (!value.is_string()) return bad("\"" + std::string(*names.begin()) + "\" has to be a text");
  return std::move(value.text());
}

enum class Encoding : std::uint8_t { file, s16, f32 };

// Samples if a rate is given, else a sound file.
Encoding encoding_of(const std::string& name, bool with_rate) {
  const std::string wanted = plain(name);
  for (const std::string_view known : {"s16le", "pcms16le", "linear16", "pcm16", "pcm"}) {
    if (wanted == known) return Encoding::s16;
  }
  for (const std::string_view known : {"f32le", "pcmf32le", "float32"}) {
    if (wanted == known) return Encoding::f32;
  }
  if (!name.empty()) return Encoding::file;
  return with_rate ? Encoding::s16 : Encoding::file;
}

bool is_wav(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0;
}

float sample_at(std::span<const std::uint8_t> bytes, std::size_t at, Encoding encoding) {
  if (encoding == Encoding::s16) {
    return float(std::int16_t(std::uint16_t(bytes[at] | bytes[at + 1] << 8))) / 32768.0F;
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t(bytes[at + i]) << (8 * i);
  const float value = std::bit_cast<float>(bits);
  return value >= -1 && value <= 1 ? value : value > 1 ? 1.0F : value < -1 ? -1.0F : 0.0F;
}

Result<media::Pcm> decode(std::span<const std::uint8_t> bytes, Encoding encoding, double rate) {
  if (encoding == Encoding::file || is_wav(bytes)) {
    return media::read_audio(bytes, {.max_seconds = kMostPieceSeconds});
  }
  if (!(rate >= 1000 && rate <= 384000)) {
    return make_error(Code::invalid_argument,
                      "samples need \"sample_rate\", from 1000 to 384000 a second");
  }
  media::Pcm pcm;
  pcm.sample_rate = int(rate);
  const std::size_t size = encoding == Encoding::s16 ? 2 : 4;
  for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
    pcm.samples.push_back(sample_at(bytes, at, encoding));
  }
  return pcm;
}

Result<media::Pcm> sound_of(Json& piece) {
  Result<std::string> coded = take_text(piece, {"audio", "audiobase64", "audiocontent", "data"});
  if (!coded) return coded.error();
  Result<std::string> file = take_text(piece, {"file", "audiofile"});
  if (!file) return file.error();
  Result<std::string> encoding = take_text(piece, {"encoding", "format", "audioformat"});
  if (!encoding) return encoding.error();
  const Json rate = take(piece, {"samplerate", "sampleratehertz"});
  if (!rate.is_null() && !rate.is_number()) return bad("\"sample_rate\" has to be a number");
  if (coded->empty() && file->empty()) return media::Pcm{kPieceRate, {}};
  if (!coded->empty() && !file->empty()) return bad("\"audio\" and \"file\" are both there");
  if (!file->empty()) {
    Result<media::Pcm> pcm = media::read_audio(*file, {.max_seconds = kMostPieceSeconds});
    if (!pcm) return pcm.error().in_file(*file);
    return pcm;
  }
  const auto bytes = tools::decode_base64(*coded);
  if (!bytes) return bad("\"audio\" is no base64");
  return decode(*bytes, encoding_of(*encoding, !rate.is_null()),
                rate.is_null() ? 0 : rate.get<double>());
}

// Whether what is left of a piece may hold times: a list or an object, but not its own small talk.
bool may_hold_times(const Json& piece) {
  for (const auto& [key, value] : piece.items()) {
    if (value.is_structured() && !value.empty()) return true;
  }
  return false;
}

}  // namespace

Result<Json> parse_object(std::string_view text) {
  constexpr std::size_t kMostDeep = 64;
  Result<Json> json = Json::parse(text, {.deepest = kMostDeep});
  if (json && !json->is_object()) return bad("a piece is a JSON object, {...}");
  return json;
}

Result<SpokenLine> read_piece(std::string_view json, const voice::VoiceOptions& voice,
                              const ScriptInput& input) {
  Result<Json> piece = parse_object(json);
  if (!piece) return piece.error();
  Result<media::Pcm> audio = sound_of(*piece);
  if (!audio) return audio.error();
  (void)take(*piece, {"mood"});       // of line_command.h
  (void)take(*piece, {"intensity"});  // of it
  Json script = take(*piece, {"script"});
  Result<std::string> language = take_text(*piece, {"language", "lang"});
  if (!language) return language.error();
  ScriptInput reading = input;
  reading.most_seconds = kMostPieceSeconds;
  if (!language->empty()) reading.language = *language;

  TimedSound sound;
  sound.from = "the piece";
  const bool found = script.is_null() && may_hold_times(*piece);
  if (script.is_string()) {
    sound.labels = std::move(script.text());
  } else if (!script.is_null()) {
    sound.labels = script.dump();
  } else if (found) {
    sound.labels = piece->dump();
  }
  Result<std::string> text = take_text(*piece, {"text", "transcript"});
  if (!text) return text.error();
  SpokenLine line;
  line.joins = true;
  line.text = *text;
  tools::Log log;
  log.warn = [&line](const std::string& warning) {
    line.doubt += (line.doubt.empty() ? "" : "; ") + warning;
  };
  *text = text_to_say(*text, input.reading.speak_marks, log);
  if (found && !text->empty()) {
    if (const auto timings = scripts::read_labels(sound.labels); !timings) {
      log.warn("its members are not timings (" + timings.error().message + ")");
      sound.labels.clear();
    }
  }
  if (sound.labels.empty() && audio->samples.empty()) {
    voice::VoiceOptions settings = voice;
    settings.language = reading.language;
    Result<voice::Speech> speech = voice::speak_text(*text, settings);
    if (!speech) return speech.error();
    line.speech = std::move(*speech);
    return line;
  }
  sound.text = std::move(*text);
  sound.audio = std::move(*audio);
  Result<TimedSpeech> timed = time_sound(std::move(sound), reading, log);
  if (!timed) {
    Error error = timed.error();
    error.where = {};  // positions are inside a part of the line
    return error;
  }
  line.speech = std::move(timed->speech);
  return line;
}

LineMaker piece_lines(const voice::VoiceOptions& voice, const ScriptInput& input) {
  LineMaker maker;
  maker.sample_rate = kPieceRate;
  maker.most_bytes = kMostPiece;
  maker.cut = false;
  maker.json = true;
  maker.make = [voice, input](const std::string& line, const Wanted&) {
    return read_piece(line, voice, input);
  };
  return maker;
}

}  // namespace animeme::speech
