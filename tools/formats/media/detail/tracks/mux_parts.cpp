#include "tools/formats/media/detail/tracks/mux_parts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <utility>

#include "tools/formats/media/detail/ffmpeg/invalid.h"
#include "tools/formats/media/detail/mp4/systems_scene.h"
#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"
#include "tools/formats/media/detail/ts/ts_sections.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kSimpleFace = 0x61;
constexpr double kShortestFragment = 0.02;
constexpr double kLongestFragment = 600;
constexpr double kLongestShared = 2;
constexpr double kLatestText = 1e9;   // seconds
constexpr double kTablePeriod = 0.5;  // standards that build on 13818-1 ask for no less

Result<void> check_unit(const fba::AccessUnits& face, std::size_t index) {
  const fba::AccessUnit& unit = face.units[index];
  const std::string name = "access unit " + std::to_string(index);
  if (unit.bytes.empty()) return invalid(name + " is empty");
  if (unit.bytes.size() > kLargestUnit) return invalid(name + " is larger than 16 MB");
  if (unit.duration <= 0 || unit.duration > kLongestTime) {
    return invalid(name + " needs a positive duration");
  }
  const std::int64_t earliest = index == 0 ? 0 : face.units[index - 1].time + 1;
  if (unit.time < earliest || unit.time > kLongestTime) {
    return invalid(name + " has the time " + std::to_string(unit.time) +
                   "; times begin at 0 and ascend");
  }
  return {};
}

Result<void> check_face(const fba::AccessUnits& face) {
  if (face.units.empty()) return invalid("the face has no access units");
  if (face.timescale == 0 || face.timescale > INT32_MAX) {
    return invalid("the face's time scale must be 1 to 2147483647 ticks a second");
  }
  if (read_visual_headers(face.config).kind != VisualKind::face) {
    return invalid("the face's decoder configuration is missing or not that of a face");
  }
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    Result<void> legal = check_unit(face, i);
    if (!legal) return legal;
  }
  return {};
}

Result<void> check_text(const TextTrack& track) {
  const bool code =
      track.language.size() == 3 && std::all_of(track.language.begin(), track.language.end(),
                                                [](char c) { return c >= 'a' && c <= 'z'; });
  if (!code) return invalid("the language of a text must be three small letters");
  double before = 0;
  for (const TextCue& cue : track.cues) {
    if (!(cue.start >= before && cue.end > cue.start && cue.end <= kLatestText)) {
      return invalid(
          "the cues of a text must ascend from 0 on without overlap, each with a length");
    }
    before = cue.end;
  }
  return {};
}

Result<void> check_labels(const TrackLabels& labels) {
  const bool code =
      labels.code.empty() ||
      (labels.code.size() == 3 && std::all_of(labels.code.begin(), labels.code.end(),
                                              [](char c) { return c >= 'a' && c <= 'z'; }));
  if (!code) return invalid("the code of a language must be three small letters");
  if (!labels.language.empty() && !is_language_tag(labels.language)) {
    return invalid("'" + labels.language + "' is no language tag");
  }
  constexpr std::size_t kLongestSpeakerName = 60;
  if (labels.speaker.size() > kLongestSpeakerName || clean_text(labels.speaker) != labels.speaker) {
    return invalid("the name of a speaker must be one line of at most 60 bytes");
  }
  return {};
}

Result<void> check_further(const MuxInput& input, const MuxOptions& options) {
  if (input.video != nullptr || !input.more.empty()) {
    return invalid("further languages have neither pictures nor languages of their own");
  }
  return check_input(input, options);
}

}  // namespace

Result<void> check_input(const MuxInput& input, const MuxOptions& options) {
  const int sounds = input.sounds();
  const bool text = input.texts != nullptr && !input.texts->empty() && !input.labels.empty();
  if (!input.has_face() && sounds == 0 && input.video == nullptr && !text) {
    return invalid("nothing to write: neither a face nor sound nor pictures were given");
  }
  if (sounds > 1) {
    return invalid("the sound was given more than once, as samples, coded, or as a file");
  }
  if (input.face != nullptr) {
    if (auto legal = check_face(*input.face); !legal) return legal;
  }
  if (input.face != nullptr && input.face_units != nullptr) {
    return invalid("the face was given twice, as a list and as a reader of units");
  }
  if (input.face_units != nullptr && input.face_units->summary().largest > kLargestUnit) {
    return invalid("an access unit is larger than 16 MB");
  }
  if (input.video != nullptr && input.video->packets.empty()) {
    return invalid("there are no pictures");
  }
  if (options.systems && input.video != nullptr) {
    return make_error(Code::unsupported, "a Systems presentation has no pictures");
  }
  if (options.systems && !input.has_face()) {
    return make_error(Code::unsupported, "a Systems presentation needs a face");
  }
  if (options.systems && options.fragmented) {
    return make_error(Code::unsupported, "a Systems presentation cannot be fragmented");
  }
  for (const TextTrack& track : input.texts != nullptr ? *input.texts : std::vector<TextTrack>()) {
    if (auto legal = check_text(track); !legal) return legal;
  }
  const double seconds = options.fragment_seconds;
  if (!(seconds >= kShortestFragment && seconds <= kLongestFragment)) {
    return invalid("fragments must last 0.02 to 600 seconds");
  }
  if (!(options.shared_seconds >= 0 && options.shared_seconds <= kLongestShared)) {
    return invalid("planes can share a packet for 0 to 2 seconds");
  }
  if (auto legal = check_labels(input.labels); !legal) return legal;
  for (const MuxInput& further : input.more) {
    if (auto legal = check_further(further, options); !legal) return legal;
  }
  if (input.audio != nullptr && input.audio->samples.empty()) return invalid("the sound is empty");
  if (input.encoded != nullptr) return check_audio(*input.encoded);
  return {};
}

int visual_profile(const MuxInput& input) {
  if (input.visual_profile != 0) return input.visual_profile;
  if (!input.has_face()) return int(kNoneRequired);
  const auto& config =
      input.face != nullptr ? input.face->config : input.face_units->summary().config;
  const std::uint8_t profile = read_visual_headers(config).profile;
  return profile != 0 ? profile : kSimpleFace;
}

void set_mp4_options(const Mp4Contents& contents, av::Options& header) {
  header.set("brand", std::string("mp42"));
  header.set("skip_iods", 0);
  // Of the pictures beside a face; theirs is in their own headers.
  header.set("iods_video_profile",
             contents.video != nullptr ? int(kUnspecified) : contents.visual_profile);
  header.set("iods_audio_profile", audio_profile(contents.sound));
  // The unit of track durations; the default of 1 ms would round them.
  header.set("movie_timescale", contents.sound != nullptr ? contents.sound->sample_rate
                                : contents.face != nullptr
                                    ? std::int64_t(contents.face->timescale)
                                    : std::int64_t(contents.video->rate.num) * 1000);
}

void set_ts_options(double shared_seconds, av::Options& header) {
  // Frames of sound share a packet for half of this. The clock of the stream is twice as much
  // ahead of the times, so that all of a packet is there when it is due.
  constexpr double kDelay = 0.7;  // seconds, as the ffmpeg program has it
  header.set("max_delay", std::int64_t(std::max(kDelay, 2 * shared_seconds) * 1e6));
  header.set("omit_video_pes_length", std::int64_t(0));  // the end of a unit is known at once
  // Tables come with the first packet that is due behind this period.
  if (shared_seconds > 0) {
    header.set("pat_period", std::to_string(std::max(kTablePeriod - shared_seconds, 0.1)));
  }
}

void set_chunk_options(av::Options& header) {
  // Packets that lie side by side share a chunk, an entry in two tables.
  constexpr std::int64_t kChunk = 1000000;  // microseconds
  header.set("chunk_duration", kChunk);
}

void set_fragment_options(const char* cut, double seconds, av::Options& header) {
  // Source: tools/formats/media/containers.md, section 2.2. Without delay_moov the edit list is
  // missing.
  header.set("movflags", std::string(cut) + "+delay_moov+default_base_moof+skip_trailer");
  if (seconds > 0) header.set("frag_duration", std::int64_t(seconds * 1e6));
}

Result<std::optional<SoundSource>> open_sound(const MuxInput& input, const MuxOptions& options) {
  std::optional<SoundSource> sound;
  if (input.encoded != nullptr) sound.emplace(SoundSource::copying(*input.encoded));
  if (input.stored != nullptr) {
    Result<SoundSource> opened = SoundSource::copying(*input.stored);
    if (!opened) return opened.error();
    sound.emplace(std::move(*opened));
  }
  if (input.audio != nullptr) {
    Result<SoundSource> opened = SoundSource::coding(*input.audio, options.audio);
    if (!opened) return opened.error();
    sound.emplace(std::move(*opened));
  }
  if (input.audio_file != nullptr) {
    Result<SoundSource> opened =
        SoundSource::decoding(*input.audio_file, options.audio, options.warnings);
    if (!opened) return opened.error();
    sound.emplace(std::move(*opened));
  }
  return sound;
}

Result<void> fill_up_ts(const std::string& path) {
  constexpr std::size_t kFewest = 16;
  std::error_code status;
  const auto size = std::size_t(std::filesystem::file_size(path, status));
  if (status || size >= kFewest * kTsPacket) return {};
  std::vector<char> packet(kTsPacket, char(0xFF));
  const std::array<std::uint8_t, 4> header = {kTsSync, kTsNoPid >> 8, kTsNoPid & 0xFF, 0x10};
  std::copy(header.begin(), header.end(), packet.begin());
  std::ofstream out(path, std::ios::binary | std::ios::app);
  for (std::size_t i = size / kTsPacket; i < kFewest; ++i) {
    out.write(packet.data(), std::streamsize(packet.size()));
  }
  out.close();
  return out ? Result<void>() : make_error(Code::io, "cannot write the file; check the free space");
}

}  // namespace animeme::media
