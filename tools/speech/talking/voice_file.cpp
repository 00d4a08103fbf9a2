#include "tools/speech/talking/voice_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "dam/script/captions.h"
#include "dam/script/script_finish_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/textgrid.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/word_phones.h"

namespace animeme::speech {

namespace {

// From labels to phones.
Result<dam::Script> script_of(Result<dam::Timings> timings, const std::string& path,
                              const ScriptInput& input, const tools::Log& log, bool* from_words) {
  if (!timings) return timings.error().in_file(path);
  for (const dam::ScriptNote& note : timings->notes) log.warn(path + ": " + note.describe());
  if (from_words != nullptr) *from_words = dam::has_words(*timings);
  if (dam::has_words(*timings)) {
    std::vector<std::string> warnings;
    voice::AlignOptions settings;
    settings.language = input.language;
    timings = voice::words_to_phones(*timings, settings, warnings);
    if (!timings) return timings.error().in_file(path);
    for (const std::string& warning : warnings) log.warn(path + ": " + warning);
    log.info(path + ": words with times; their phones are estimated from pronunciations");
  }
  Result<dam::Script> script = dam::make_script(*timings);
  if (!script) return script.error().in_file(path);
  if (script->duration() > input.most_seconds) {
    return make_error(Code::out_of_range,
                      "the script lasts " + std::to_string(std::llround(script->duration())) +
                          " s, the limit is " + std::to_string(std::llround(input.most_seconds)) +
                          " s; correct its times or raise the limit (--max-seconds)")
        .in_file(path);
  }
  return script;
}

constexpr std::string_view kCarriedNames[] = {"words", "phones"};

bool is_ours(const media::TextTrack& track) {
  return !track.cues.empty() && std::find(std::begin(kCarriedNames), std::end(kCarriedNames),
                                          dam::lower_case(track.name)) != std::end(kCarriedNames);
}

// Tracks of a file are tiers by another name.
Result<dam::Timings> labels_of(const std::vector<media::TextTrack>& tracks,
                               const dam::ScriptOptions& reading) {
  dam::TextGrid grid;
  for (const media::TextTrack& track : tracks) {
    dam::TextGridTier& tier = grid.tiers.emplace_back();
    tier.name = track.name;
    for (const media::TextCue& cue : track.cues) {
      tier.items.push_back({cue.start, cue.end, cue.text, 0, 0});
    }
  }
  auto timings = dam::labels_of_tier(grid, reading);
  if (!timings) return timings.error();
  const auto done = dam::finish_labels(*timings, reading, dam::TimeUnit::known);
  if (!done) return done.error();
  return timings;
}

// By the first bytes of a file that can be read again.
bool carries_text(const std::string& path) {
  std::error_code status;
  if (path == "-" || !std::filesystem::is_regular_file(path, status)) return false;
  std::array<char, 12> begin{};
  std::ifstream in(path, std::ios::binary);
  in.read(begin.data(), begin.size());
  return media::may_hold_text(
      {reinterpret_cast<const std::uint8_t*>(begin.data()), std::size_t(in.gcount())});
}

}  // namespace

std::vector<media::TextTrack> carried_texts(const dam::Script& script, std::string_view language) {
  std::vector<media::TextTrack> tracks;
  for (const dam::TextGridTier& tier : dam::textgrid_of(script).tiers) {
    // "zxx" keeps players from choosing the phones by language.
    media::TextTrack track{
        tier.name, tier.name == "words" ? text::language_code(language) : "zxx", {}};
    for (const dam::TextGridItem& item : tier.items) {
      if (!item.text.empty()) track.cues.push_back({item.start, item.end, item.text, {}});
    }
    if (!track.cues.empty()) tracks.push_back(std::move(track));
  }
  return tracks;
}

void add_captions(std::vector<media::TextTrack>& tracks) {
  const auto words = std::find_if(tracks.begin(), tracks.end(), [](const auto& track) {
    return dam::lower_case(track.name) == "words" && !track.cues.empty();
  });
  if (words == tracks.end()) return;
  std::vector<dam::ScriptWord> spoken;
  for (const media::TextCue& cue : words->cues) spoken.push_back({cue.start, cue.end, cue.text});
  media::TextTrack captions{std::string(media::kCaptionTrack), words->language, {}};
  for (const dam::Caption& caption : dam::captions_of(spoken, spoken.back().end)) {
    captions.cues.push_back(
        {caption.start, caption.end, dam::caption_text(caption), dam::caption_webvtt(caption)});
  }
  tracks.insert(tracks.begin(), std::move(captions));
}

std::vector<media::TextTrack> carried_tracks(const std::string& path, const tools::Log& log) {
  if (!carries_text(path)) return {};
  Result<std::vector<media::TextTrack>> tracks = media::read_text_tracks(path);
  if (!tracks) {
    // Other errors of the file are reported when its face is read.
    if (tracks.error().code == Code::out_of_range) log.warn(tracks.error().describe());
    return {};
  }
  std::erase_if(*tracks, [](const media::TextTrack& track) { return !is_ours(track); });
  return std::move(*tracks);
}

std::optional<dam::Script> carried_script(const std::string& path, const ScriptInput& input,
                                          const tools::Log& log) {
  const std::vector<media::TextTrack> tracks = carried_tracks(path, log);
  if (tracks.empty()) return std::nullopt;
  Result<dam::Script> script =
      script_of(labels_of(tracks, input.reading), path, input, log, nullptr);
  if (script) return std::move(*script);
  log.warn("its words are ignored: " + script.error().describe());
  return std::nullopt;
}

Result<dam::Script> read_script(const std::string& path, const ScriptInput& input,
                                const tools::Log& log, bool* from_words) {
  if (carries_text(path)) {
    const Result<std::vector<media::TextTrack>> tracks = media::read_text_tracks(path);
    if (!tracks) return tracks.error();
    if (tracks->empty()) {
      return make_error(Code::not_found, "the file contains neither words nor phones")
          .in_file(path);
    }
    return script_of(labels_of(*tracks, input.reading), path, input, log, from_words);
  }
  const Result<std::string> text = tools::read_text_file(path, tools::kMostWritten);
  if (!text) return text.error();
  return parse_script(*text, path, input, log, from_words);
}

Result<dam::Script> parse_script(const std::string& text, const std::string& path,
                                 const ScriptInput& input, const tools::Log& log,
                                 bool* from_words) {
  return script_of(scripts::read_labels(text, input.reading), path, input, log, from_words);
}

Result<media::Pcm> read_voice(const std::string& path, const tools::Log& log, int sample_rate) {
  std::vector<std::string> warnings;
  media::ReadAudioOptions options;
  options.sample_rate = sample_rate;
  options.warnings = &warnings;
  Result<media::Pcm> audio = media::read_audio(path, options);
  if (!audio) return audio.error().in_file(path);
  for (const std::string& text : warnings) log.warn(path + ": " + text);
  return audio;
}

double SoundInput::seconds() const {
  if (samples) return samples->duration();
  if (coded->length > 0) return double(coded->length) / coded->format.sample_rate;
  const media::AudioPacket& last = coded->packets.back();
  return double(last.time + last.duration) / coded->format.sample_rate;
}

void SoundInput::give_to(media::MuxInput& input) const {
  if (samples) input.audio = &*samples;
  if (coded) input.encoded = &*coded;
}

Result<SoundInput> read_sound(const std::string& path, const KeepCodec& keep,
                              const tools::Log& log) {
  SoundInput sound;
  Result<media::EncodedAudio> coded = media::read_encoded_audio(path);
  if (coded && keep(coded->format.codec)) {
    sound.coded = std::move(*coded);
    return sound;
  }
  if (!coded && coded.error().code != Code::unsupported) return coded.error().in_file(path);
  Result<media::Pcm> samples = read_voice(path, log);
  if (!samples) return samples.error();
  sound.samples = std::move(*samples);
  return sound;
}

Result<media::EncodedAudio> read_coded_sound(const std::string& path, const KeepCodec& keep,
                                             const media::AudioSettings& settings,
                                             const tools::Log& log) {
  Result<SoundInput> sound = read_sound(path, keep, log);
  if (!sound) return sound.error();
  if (sound->coded) return std::move(*sound->coded);
  return media::encode_audio(*sound->samples, settings);
}

}  // namespace animeme::speech
