#include "tools/media/detail/mux_parts.h"

#include <string>
#include <utility>

#include "tools/media/detail/face_header.h"
#include "tools/media/detail/systems_scene.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kSimpleFace = 0x61;

unsigned audio_profile(const AudioFormat* sound) {
  if (sound == nullptr) return kNoneRequired;
  const bool level2 =
      sound->codec == AudioCodec::aac && sound->sample_rate <= 48000 && sound->channels <= 2;
  return level2 ? kAacLevel2 : kUnspecified;
}

}  // namespace

int visual_profile(const MuxInput& input) {
  if (input.visual_profile != 0) return input.visual_profile;
  if (input.face == nullptr) return int(kNoneRequired);
  const std::uint8_t profile = read_visual_headers(input.face->config).profile;
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

void set_fragment_options(const char* cut, double seconds, av::Options& header) {
  // Source: tools/media/containers.md, section 2.2. Without delay_moov the edit list is missing.
  header.set("movflags", std::string(cut) + "+delay_moov+default_base_moof+skip_trailer");
  if (seconds > 0) header.set("frag_duration", std::int64_t(seconds * 1e6));
}

Result<std::optional<SoundSource>> open_sound(const MuxInput& input, const MuxOptions& options) {
  std::optional<SoundSource> sound;
  if (input.encoded != nullptr) sound.emplace(SoundSource::copying(*input.encoded));
  if (input.audio != nullptr) {
    Result<SoundSource> opened = SoundSource::coding(*input.audio, options.audio);
    if (!opened) return opened.error();
    sound.emplace(std::move(*opened));
  }
  return sound;
}

double seconds_of_sound(const MuxInput& input) {
  if (input.audio != nullptr) return input.audio->duration();
  const EncodedAudio& audio = *input.encoded;
  return double(audio.packets.back().time) / audio.format.sample_rate;
}

}  // namespace animeme::media
