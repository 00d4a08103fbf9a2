#include "tools/media/mux.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "tools/media/audio.h"
#include "tools/media/detail/audio_parameters.h"
#include "tools/media/detail/face_header.h"
#include "tools/media/detail/mp4_fix.h"
#include "tools/media/detail/muxer.h"
#include "tools/media/detail/output_file.h"
#include "tools/media/detail/sound_source.h"
#include "tools/media/detail/systems_movie.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kLongestTime = std::int64_t(1) << 47;  // room for rescaling
constexpr std::size_t kLargestUnit = std::size_t(1) << 24;
constexpr int kAacLevel2 = 0x29;  // up to 48 kHz, two channels
constexpr int kAudioUnspecified = 0xFE;
constexpr int kNoneRequired = 0xFF;

Error invalid(std::string message) {
  return make_error(Code::invalid_argument, std::move(message));
}

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

Result<void> check(const MuxInput& input, const MuxOptions& options) {
  if (input.face == nullptr && input.audio == nullptr) {
    return invalid("nothing to write: neither a face nor sound was given");
  }
  if (input.face != nullptr) {
    const fba::AccessUnits& face = *input.face;
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
  }
  if (options.systems && input.face == nullptr) {
    return make_error(Code::unsupported, "a Systems presentation needs a face");
  }
  if (input.audio != nullptr) {
    if (input.audio->samples.empty()) return invalid("the sound is empty");
    if (options.audio_bit_rate < 8000 || options.audio_bit_rate > 320000) {
      return invalid("the audio bit rate must be 8000 to 320000 bits a second");
    }
  }
  return {};
}

int visual_profile(const MuxInput& input) {
  if (input.visual_profile != 0) return input.visual_profile;
  if (input.face == nullptr) return kNoneRequired;
  const std::uint8_t profile = read_visual_headers(input.face->config).profile;
  return profile != 0 ? profile : 0x61;
}

void set_mp4_options(const MuxInput& input, int sample_rate, const MuxOptions& options,
                     av::Options& header) {
  const int level = sample_rate <= 48000 ? kAacLevel2 : kAudioUnspecified;
  header.set("brand", std::string("mp42"));
  header.set("skip_iods", 0);
  header.set("iods_video_profile", visual_profile(input));
  header.set("iods_audio_profile", input.audio != nullptr ? level : kNoneRequired);
  if (options.faststart) header.set("movflags", std::string("+faststart"));
  // The unit of track durations; the default of 1 ms would round them.
  header.set("movie_timescale",
             input.audio != nullptr ? sample_rate : std::int64_t(input.face->timescale));
}

AudioSettings settings_of(const MuxOptions& options) {
  return {AudioCodec::aac, options.audio_bit_rate};
}

// Hands units and packets to the muxer in time order.
class Interleaver {
 public:
  /// `sound` may be nullptr: none; `seconds` of it.
  Interleaver(Muxer& muxer, const fba::AccessUnits* face, SoundSource* sound, double seconds,
              const MuxOptions& options)
      : muxer_(muxer), face_(face), sound_(sound), seconds_(seconds), options_(options) {}

  Result<void> run() {
    Result<void> step = fetch_audio();
    while (step && (has_face() || packet_ != nullptr)) {
      const bool face_first = has_face() && (packet_ == nullptr || face_is_earlier());
      step = face_first ? muxer_.write_unit(face_->units[next_unit_++]) : write_audio();
      report();
    }
    return step;
  }

 private:
  bool has_face() const { return face_ != nullptr && next_unit_ < face_->units.size(); }

  bool face_is_earlier() const {
    return av_compare_ts(face_->units[next_unit_].time, {1, int(face_->timescale)}, packet_->time,
                         {1, sound_->format().sample_rate}) <= 0;
  }

  Result<void> fetch_audio() {
    if (sound_ == nullptr) return {};
    Result<const AudioPacket*> packet = sound_->next();
    if (!packet) return packet.error();
    packet_ = *packet;
    return {};
  }

  Result<void> write_audio() {
    audio_end_ = packet_->time + packet_->duration;
    Result<void> written = muxer_.write_sound(*packet_);
    return written ? fetch_audio() : written;
  }

  void report() {
    if (!options_.progress || ++steps_ % 64 != 0) return;
    double done = 1;
    if (face_ != nullptr) done = double(next_unit_) / double(face_->units.size());
    if (sound_ != nullptr) {
      done = std::min(done, double(audio_end_) / (seconds_ * sound_->format().sample_rate));
    }
    options_.progress(std::clamp(done, 0.0, 0.999));
  }

  Muxer& muxer_;
  const fba::AccessUnits* face_;
  SoundSource* sound_;
  double seconds_;
  const MuxOptions& options_;
  const AudioPacket* packet_ = nullptr;  // next of the sound
  std::size_t next_unit_ = 0;
  std::int64_t audio_end_ = 0;
  std::int64_t steps_ = 0;
};

Result<void> write_streams(const std::string& path, MuxFormat format, const MuxInput& input,
                           const MuxOptions& options) {
  std::optional<SoundSource> sound;
  if (input.audio != nullptr) {
    Result<SoundSource> opened = SoundSource::coding(*input.audio, settings_of(options));
    if (!opened) return opened.error();
    sound.emplace(std::move(*opened));
  }
  Result<std::unique_ptr<Muxer>> opened = Muxer::open(path, format);
  if (!opened) return opened.error();
  Muxer& muxer = **opened;
  if (input.face != nullptr) {
    Result<void> added = muxer.add_face(*input.face);
    if (!added) return added;
  }
  if (sound) {
    Result<void> added = muxer.add_sound(sound->format(), sound->bit_rate());
    if (!added) return added;
  }
  av::Options header;
  if (format == MuxFormat::mp4) {
    set_mp4_options(input, sound ? sound->format().sample_rate : 0, options, header);
  }
  Result<void> started = muxer.write_header(header);
  if (!started) return started;
  Interleaver interleaver(muxer, input.face, sound ? &*sound : nullptr,
                          sound ? input.audio->duration() : 0, options);
  Result<void> done = interleaver.run();
  return done ? muxer.finish() : done;
}

Result<void> write_systems(const std::string& path, const MuxInput& input,
                           const MuxOptions& options) {
  std::optional<EncodedAudio> coded;
  if (input.audio != nullptr) {
    Result<EncodedAudio> made = encode_audio(*input.audio, settings_of(options));
    if (!made) return made.error();
    coded.emplace(std::move(*made));
  }
  const EncodedAudio* sound = coded ? &*coded : nullptr;
  Result<std::vector<std::uint8_t>> bytes =
      write_movie(systems_movie(*input.face, sound, visual_profile(input)));
  if (!bytes) return bytes.error();
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes->data()), std::streamsize(bytes->size()));
  out.close();
  if (!out) return make_error(Code::io, "cannot write the file; check the free space");
  return {};
}

Result<void> write_file(const std::string& path, MuxFormat format, const MuxInput& input,
                        const MuxOptions& options) {
  Result<void> legal = check(input, options);
  if (!legal) return legal;
  const av::LogCapture log;
  Result<OutputFile> out = OutputFile::create(path);
  if (!out) return out.error();
  Result<void> written = options.systems ? write_systems(out->temporary(), input, options)
                                         : write_streams(out->temporary(), format, input, options);
  if (written && format == MuxFormat::mp4 && !options.systems) {
    written = clear_es_ids(out->temporary());
  }
  if (written) written = out->commit();
  if (written && options.progress) options.progress(1.0);
  return written;
}

Result<void> guarded_write(const std::string& path, MuxFormat format, const MuxInput& input,
                           const MuxOptions& options) {
  return av::guarded([&]() -> Result<void> {
    Result<void> written = write_file(path, format, input, options);
    if (!written) return std::move(written.error()).in_file(path);
    return written;
  });
}

}  // namespace

Result<void> write_mp4(const std::string& path, const MuxInput& input, const MuxOptions& options) {
  return guarded_write(path, MuxFormat::mp4, input, options);
}

Result<void> write_container(const std::string& path, const MuxInput& input,
                             const MuxOptions& options) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  }
  if (options.systems && extension != ".mp4") {
    return make_error(Code::unsupported, "a Systems presentation is an .mp4 file").in_file(path);
  }
  const bool sound_only = extension == ".m4a" || extension == ".mka";
  if (sound_only && input.face != nullptr) {
    return make_error(Code::unsupported, "a " + extension +
                                             " file holds sound only; use .mp4, .mkv or .ts for a "
                                             "face")
        .in_file(path);
  }
  if (extension == ".mp4" || extension == ".m4a") {
    return guarded_write(path, MuxFormat::mp4, input, options);
  }
  if (extension == ".mkv" || extension == ".mka") {
    return guarded_write(path, MuxFormat::matroska, input, options);
  }
  if (extension == ".ts") return guarded_write(path, MuxFormat::mpegts, input, options);
  return make_error(Code::unsupported,
                    "cannot write a \"" + extension + "\" file; use .mp4, .mkv or .ts")
      .in_file(path);
}

}  // namespace animeme::media
