#include "tools/commands/face_stream.h"

#include <cmath>
#include <cstdio>

#include "codec/encode.h"
#include "tools/media/mux.h"

namespace animeme::tools {

void add_coding_options(CLI::App& app, StreamSettings& settings) {
  CLI::Option* quant =
      app.add_option("--quant", settings.quant,
                     "Quantiser fap_quant; 1 is not visible, 0 lossless up to +-1860")
          ->check(CLI::Range(0, 31))
          ->capture_default_str();
  app.add_option("--rms", settings.rms,
                 "Fewest bits with at most this error, FAP units RMS; 2 is not visible")
      ->check(CLI::Range(1e-3, 1e6))
      ->excludes(quant);
  app.add_option("--kbps", settings.kbps, "Smallest error at this rate of the face, kbit/s")
      ->check(CLI::Range(1e-3, 1e6))
      ->excludes(quant);
}

void add_stream_options(CLI::App& app, StreamSettings& settings) {
  add_coding_options(app, settings);
  app.add_option("--intra-seconds", settings.intra_seconds,
                 "Seconds between points where playing can begin, in containers; 0: one point")
      ->check(CLI::NonNegativeNumber)
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

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", seconds);
  return text;
}

Result<fba::AccessUnits> access_units(const FaceInput& face, const StreamSettings& settings) {
  if (!face.stream.empty()) return fba::split_access_units(face.stream);
  fba::EncodeOptions options = encode_options(settings);
  // A unit takes a start code and about four bits of stuffing besides its plane.
  constexpr double kUnitBits = 36;
  const double unit_rate = kUnitBits * face.clip.rate.frames_per_second();
  options.max_bits_per_second =
      std::max(options.max_bits_per_second - unit_rate, options.max_bits_per_second * 0.1);
  const double planes = settings.intra_seconds * face.clip.rate.frames_per_second();
  options.intra_period = int(std::lround(std::min(planes, 1e9)));
  Result<std::vector<std::uint8_t>> stream = fba::encode(face.clip, options);
  if (!stream) return stream.error();
  return fba::split_access_units(*stream);
}

Result<int> write_media(const std::string& path, const fba::AccessUnits& units,
                        const media::Pcm* audio, media::MuxOptions options) {
  media::MuxInput input;
  input.face = &units;
  input.audio = audio;
  ProgressLine progress("writing " + path);
  options.progress = [&progress](double done) { progress.update(done); };
  if (auto written = media::write_container(path, input, options); !written) {
    return written.error().in_file(path);
  }
  std::size_t bytes = 0;
  for (const fba::AccessUnit& unit : units.units) bytes += unit.bytes.size();
  const fba::AccessUnit& last = units.units.back();
  const double seconds = double(last.time + last.duration) / units.timescale;
  char text[160];
  std::snprintf(text, sizeof text, ": face %zu planes, %.2f s, %.2f kbit/s%s", units.units.size(),
                seconds, double(bytes) * 8e-3 / seconds,
                audio != nullptr ? (", sound " + seconds_text(audio->duration())).c_str() : "");
  say(path + text);
  return kOk;
}

}  // namespace animeme::tools
