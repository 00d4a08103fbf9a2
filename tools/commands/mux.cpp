#include "tools/media/mux.h"

#include <memory>

#include "codec/encoder.h"
#include "tools/commands/common.h"
#include "tools/commands/face_stream.h"
#include "tools/media/audio.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string face;
  std::string audio;
  std::string output;
  StreamSettings stream;
  media::MuxOptions mux;
};

Result<int> run(const Options& options) {
  Result<FaceInput> face = read_face(options.face);
  if (!face) return face.error();
  std::vector<std::string> warnings;
  media::ReadAudioOptions read;
  read.warnings = &warnings;
  Result<media::Pcm> audio = media::read_audio(options.audio, read);
  if (!audio) return audio.error().in_file(options.audio);
  for (const std::string& text : warnings) warn(options.audio + ": " + text);
  Result<fba::AccessUnits> units = access_units(*face, options.stream);
  if (!units) return units.error().in_file(options.face);
  if (std::abs(audio->duration() - face->clip.duration()) > 1.0) {
    warn("the face lasts " + seconds_text(face->clip.duration()) + ", the sound " +
         seconds_text(audio->duration()));
  }
  return write_media(options.output, *units, &*audio, options.mux);
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("face", options->face, "FAP text or FBA stream")->required();
  app.add_option("audio", options->audio, "Sound in any format that FFmpeg reads")->required();
  app.add_option("-o,--output", options->output, "File to write: .mp4, .mkv or .ts")->required();
  add_stream_options(app, options->stream);
  app.add_option("--audio-bitrate", options->mux.audio_bit_rate, "Bits a second of the AAC track")
      ->check(CLI::Range(8000, 320000))
      ->capture_default_str();
  app.add_flag("--systems", options->mux.systems,
               "mp4: add the scene and object streams of a complete MPEG-4 Systems presentation");
  return [options] { return run(*options); };
}

}  // namespace

const Command kMux{"mux", "Put a face and a voice into one file",
                   "  animeme mux talk.fba voice.wav -o talk.mp4\n"
                   "  animeme mux talk.fap voice.flac --quant 2 -o talk.mkv\n"
                   "  animeme mux talk.fba voice.wav --systems -o scene.mp4",
                   add};

}  // namespace animeme::tools
