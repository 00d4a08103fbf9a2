#include "tools/app/commands/face_stream.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/report.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/cost.h"
#include "tools/live/sessions/clip.h"

namespace animeme::tools {

void add_coding_options(OptionTable& cli, StreamSettings& settings) {
  cli.add("--quant", settings.quant,
          "Quantiser (fap_quant); the error of 1 is not visible (a head turns in steps of 0.097 "
          "degrees, which our players ease), 0 is lossless up to +-1860")
      ->between(0, 31)
      ->show_default();
  add_limit_options(cli, settings, "--quant");
}

void add_limit_options(OptionTable& cli, StreamSettings& settings, const std::string& others) {
  cli.add("--rms", settings.rms,
          "Smallest size with at most this error, FAP units RMS; 2 is not visible")
      ->between(1e-3, 1e6)
      ->excludes(others.c_str());
  cli.add("--kbps", settings.kbps, "Target bit rate of the face, kbit/s")
      ->between(1e-3, 1e6)
      ->excludes(others.c_str());
  cli.add("--small", settings.small,
          "Smallest size without a visible error: --rms 2, and planes in which nothing moves are "
          "not sent")
      ->excludes((others + " --rms --kbps").c_str());
}

void add_default_ranges_option(OptionTable& cli, bool& default_ranges) {
  cli.add(
      "--default-ranges", default_ranges,
      "Send no intra ranges: players use their default ranges, which differ between the printed "
      "standard and the reference decoder (these are the latter's). Only for players that were "
      "tested with it");
}

void warn_of_default_ranges(bool done) {
  warn(done ? "--default-ranges: players with other tables of default ranges than the reference "
              "decoder read wrong values; give this stream to players that were tested with it only"
            : "--default-ranges has no effect: some values lie outside the default ranges");
}

void add_stream_options(OptionTable& cli, StreamSettings& settings) {
  add_coding_options(cli, settings);
  add_default_ranges_option(cli, settings.default_ranges);
  cli.add("--intra-seconds", settings.intra_seconds,
          "Containers: seconds between random access points; 0: the first plane only")
      ->value("SECONDS=5")
      ->at_least_zero()
      ->show_default();
}

fba::EncodeOptions encode_options(const StreamSettings& settings) {
  fba::EncodeOptions options;
  const bool searched = settings.rms > 0 || settings.kbps > 0 || settings.small;
  if (searched || settings.default_ranges) options = fba::file_options();
  options.default_ranges = settings.default_ranges;
  options.fap_quant = settings.quant;
  options.max_rms = settings.small ? kSmallRms : settings.rms;
  options.skip_still = settings.small;
  options.max_bits_per_second = settings.kbps * 1000;
  return options;
}

void give_limits(const StreamSettings& settings, live::Coding& coding) {
  const fba::EncodeOptions limits = encode_options(settings);
  coding.max_rms = limits.max_rms;
  coding.max_bits_per_second = limits.max_bits_per_second;
  coding.skip_still = limits.skip_still;
  coding.default_ranges = coding.default_ranges || limits.default_ranges;
}

std::string seconds_text(double seconds) { return format("%.2f s", seconds); }

fba::EncodeOptions unit_options(const StreamSettings& settings, fap::Rate rate) {
  fba::EncodeOptions options = encode_options(settings);
  options.max_bits_per_second = live::bit_rate_of_planes(options.max_bits_per_second, rate);
  options.intra_seconds = settings.intra_seconds;
  return options;
}

Result<std::vector<std::uint8_t>> encode_face(const fap::Sequence& face,
                                              const fba::EncodeOptions& options,
                                              std::span<const fba::BodyFrame> body) {
  fba::EncodeReport report;
  auto stream = fba::encode(face, options, body, &report);
  if (stream && options.default_ranges) warn_of_default_ranges(report.default_ranges);
  return stream;
}

Result<fba::AccessUnits> access_units(const FaceInput& face, const StreamSettings& settings) {
  if (!face.stream.empty()) return fba::split_access_units(face.stream);
  const fba::EncodeOptions options = unit_options(settings, face.clip.rate);
  AtStep step(Step::coding);
  Result<std::vector<std::uint8_t>> stream = encode_face(face.clip, options);
  if (!stream) return stream.error();
  step.made(stream->size());
  return fba::split_access_units(*stream);
}

Result<fba::UnitReader> open_units(const std::string& path) {
  const auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  return fba::UnitReader::open(
      [file](std::uint64_t offset, std::span<std::uint8_t> to) -> Result<std::size_t> {
        file->clear();
        file->seekg(std::streamoff(offset));
        file->read(reinterpret_cast<char*>(to.data()), std::streamsize(to.size()));
        if (file->bad()) return make_error(Code::io, "cannot read");
        return std::size_t(file->gcount());
      });
}

void add_sound_options(OptionTable& cli, SoundSettings& settings, bool copy) {
  cli.add("--audio-codec", settings.codec,
          copy ? "Codec of the sound: aac, opus, or copy for sound in one of them; default: aac if "
                 "the file supports it"
               : "Codec of the sound: aac or opus; default: aac if the file supports it")
      ->value("CODEC")
      ->one_of(copy ? "aac opus copy" : "aac opus");
  cli.add("--audio-bitrate", settings.bit_rate,
          "Bits per second of the sound; default, for each channel: 64000 for aac, 40000 for opus")
      ->value("6000..320000")
      ->between(6000, 320000);
}

void add_subtitles_option(OptionTable& cli, bool& subtitles) {
  cli.add(
      "--subtitles", subtitles,
      "mp4: add captions, a subtitle track that players list, as in .mkv and .m3u8; ffmpeg then "
      "copies the file to .mkv with -c:s srt only");
}

bool shows_captions(const std::string& output, bool subtitles) {
  return subtitles || extension_of(output) != ".mp4";
}

media::AudioSettings audio_settings(const SoundSettings& settings, const std::string& path) {
  media::AudioSettings audio{media::usual_codec(path), settings.bit_rate};
  if (settings.codec == "aac") audio.codec = media::AudioCodec::aac;
  if (settings.codec == "opus") audio.codec = media::AudioCodec::opus;
  return audio;
}

namespace {

struct FaceFacts {
  std::size_t planes = 0;
  std::size_t bytes = 0;  // of the raw stream
  double seconds = 0;
};

FaceFacts facts_of(const media::MuxInput& input) {
  if (input.face_units != nullptr) {
    const fba::UnitSummary& units = input.face_units->summary();
    return {units.units, units.bytes + fba::end_code().size(), double(units.end) / units.timescale};
  }
  const fba::AccessUnits& face = *input.face;
  const fba::AccessUnit& last = face.units.back();
  return {face.units.size(), fba::join_access_units(face).size(),
          double(last.time + last.duration) / face.timescale};
}

// "face 100 planes, 4.00 s, 2.52 kbit/s, sound aac".
std::string summary(const media::MuxInput& input, const media::MuxOptions& options,
                    double sound_seconds, bool copied) {
  std::string text;
  if (input.has_face()) {
    const FaceFacts face = facts_of(input);
    const double seconds = face.seconds;
    if (sound_seconds > 0 && std::abs(sound_seconds - seconds) > 1.0) {
      warn("the face lasts " + seconds_text(seconds) + ", the sound " +
           seconds_text(sound_seconds));
    }
    text += format("face %zu planes, %.2f s, %.2f kbit/s", face.planes, seconds,
                   kbit_per_s(face.bytes, seconds));
  }
  if (sound_seconds > 0) {
    text += ", sound " + seconds_text(sound_seconds);
    const media::AudioFormat* coded = input.coded_format();
    text += coded == nullptr || !copied ? std::string(" as ") + name_of(options.audio.codec)
                                        : std::string(" copied (") + name_of(coded->codec) + ")";
  }
  return text;
}

}  // namespace

Result<int> write_media(const std::string& path, const media::MuxInput& input,
                        media::MuxOptions options, SoundState sound) {
  AtStep step(Step::muxing);
  const Interrupt interrupt;
  ProgressLine progress("writing " + path);
  options.progress = [&progress](double done) { progress.update(done); };
  options.stop = [] { return Interrupt::requested(); };
  std::vector<std::string> odd;
  options.warnings = &odd;
  Result<media::MuxResult> written = media::write_container(path, input, options);
  progress.clear();
  for (const std::string& text : odd) {
    if (sound == SoundState::reported) continue;
    warn((input.audio_file != nullptr ? *input.audio_file : path) + ": " + text);
  }
  if (!written) return written.error().in_file(path);
  if (written->stopped) {
    say(path + ": stopped; the file holds the first " + seconds_text(written->seconds));
    return kInterrupted;
  }
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  if (!unknown) step.made(bytes);
  Json facts = Json::object();
  if (input.has_face()) facts["planes"] = facts_of(input).planes;
  facts["sound_seconds"] = written->sound_seconds;
  if (!unknown) facts["bytes"] = bytes;
  report_output(path,
                summary(input, options, written->sound_seconds, sound != SoundState::made_again),
                facts);
  return kOk;
}

}  // namespace animeme::tools
