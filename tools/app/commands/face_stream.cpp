#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/bounds.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>

#include "codec/encode/encode.h"
#include "tools/app/commands/interrupt.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/cost.h"
#include "tools/formats/media/mux.h"

namespace animeme::tools {

void add_coding_options(CLI::App& app, StreamSettings& settings) {
  CLI::Option* quant =
      app.add_option("--quant", settings.quant,
                     "Quantiser fap_quant; 1 is not visible, 0 lossless up to +-1860")
          ->check(between(0, 31))
          ->capture_default_str();
  app.add_option("--rms", settings.rms,
                 "Fewest bits with at most this error, FAP units RMS; 2 is not visible")
      ->check(between(1e-3, 1e6))
      ->excludes(quant);
  app.add_option("--kbps", settings.kbps, "Smallest error at this rate of the face, kbit/s")
      ->check(between(1e-3, 1e6))
      ->excludes(quant);
}

void add_stream_options(CLI::App& app, StreamSettings& settings) {
  add_coding_options(app, settings);
  app.add_option("--intra-seconds", settings.intra_seconds,
                 "Seconds between points where playing can begin, in containers; 0: one point")
      ->option_text("SECONDS=5")
      ->check(at_least_zero())
      ->capture_default_str();
}

fba::EncodeOptions encode_options(const StreamSettings& settings) {
  fba::EncodeOptions options;
  if (settings.rms > 0 || settings.kbps > 0) options = fba::file_options();
  options.fap_quant = settings.quant;
  options.max_rms = settings.rms;
  options.max_bits_per_second = settings.kbps * 1000;
  return options;
}

std::string seconds_text(double seconds) { return format("%.2f s", seconds); }

Result<fba::AccessUnits> access_units(const FaceInput& face, const StreamSettings& settings) {
  if (!face.stream.empty()) return fba::split_access_units(face.stream);
  fba::EncodeOptions options = encode_options(settings);
  // A unit takes a start code and about four bits of stuffing besides its plane.
  constexpr double kUnitBits = 36;
  const double unit_rate = kUnitBits * face.clip.rate.frames_per_second();
  options.max_bits_per_second =
      std::max(options.max_bits_per_second - unit_rate, options.max_bits_per_second * 0.1);
  options.intra_seconds = settings.intra_seconds;
  AtStep step(Step::coding);
  Result<std::vector<std::uint8_t>> stream = fba::encode(face.clip, options);
  if (!stream) return stream.error();
  step.made(stream->size());
  return fba::split_access_units(*stream);
}

void add_sound_options(CLI::App& app, SoundSettings& settings, bool copy) {
  app.add_option("--audio-codec", settings.codec,
                 copy ? "Coding of the sound: aac, opus, or copy for sound that is one of them; "
                        "default: aac, where the file takes it"
                      : "Coding of the sound: aac or opus; default: aac, where the file takes it")
      ->option_text("CODEC")
      ->check(copy ? CLI::IsMember({"aac", "opus", "copy"}) : CLI::IsMember({"aac", "opus"}));
  app.add_option("--audio-bitrate", settings.bit_rate,
                 "Bits a second of the sound; default: 64000 for aac, 40000 for opus")
      ->option_text("6000..320000")
      ->check(between(6000, 320000));
}

void add_subtitles_option(CLI::App& app, bool& subtitles) {
  app.add_flag("--subtitles", subtitles,
               "mp4: words and phones as subtitles that players list, as in .mkv and .m3u8; ffmpeg "
               "then copies the file to .mkv with -c:s srt only");
}

media::AudioSettings audio_settings(const SoundSettings& settings, const std::string& path) {
  media::AudioSettings audio{media::usual_codec(path), settings.bit_rate};
  if (settings.codec == "aac") audio.codec = media::AudioCodec::aac;
  if (settings.codec == "opus") audio.codec = media::AudioCodec::opus;
  return audio;
}

namespace {

// ": face 100 planes, 4.00 s, 2.52 kbit/s, sound aac".
std::string summary(const media::MuxInput& input, const media::MuxOptions& options,
                    double sound_seconds) {
  std::string text = ": ";
  if (input.face != nullptr) {
    const fba::AccessUnits& face = *input.face;
    const fba::AccessUnit& last = face.units.back();
    const double seconds = double(last.time + last.duration) / face.timescale;
    if (sound_seconds > 0 && std::abs(sound_seconds - seconds) > 1.0) {
      warn("the face lasts " + seconds_text(seconds) + ", the sound " +
           seconds_text(sound_seconds));
    }
    text += format("face %zu planes, %.2f s, %.2f kbit/s", face.units.size(), seconds,
                   kbit_per_s(fba::join_access_units(face).size(), seconds));
  }
  if (sound_seconds > 0) {
    text += ", sound " + seconds_text(sound_seconds);
    text += input.encoded == nullptr
                ? std::string(" as ") + name_of(options.audio.codec)
                : std::string(" copied (") + name_of(input.encoded->format.codec) + ")";
  }
  return text;
}

}  // namespace

Result<int> write_media(const std::string& path, const media::MuxInput& input,
                        media::MuxOptions options) {
  AtStep step(Step::muxing);
  const Interrupt interrupt;
  ProgressLine progress("writing " + path);
  options.progress = [&progress](double done) { progress.update(done); };
  options.stop = [] { return Interrupt::requested(); };
  std::vector<std::string> odd;
  options.warnings = &odd;
  Result<media::MuxResult> written = media::write_container(path, input, options);
  progress.clear();
  for (const std::string& text : odd) warn(*input.audio_file + ": " + text);
  if (!written) return written.error().in_file(path);
  if (written->stopped) {
    say(path + ": stopped; the file holds the first " + seconds_text(written->seconds));
    return kInterrupted;
  }
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  if (!unknown) step.made(bytes);
  say(path + summary(input, options, written->sound_seconds));
  return kOk;
}

}  // namespace animeme::tools
