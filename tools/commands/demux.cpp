#include <memory>

#include "codec/access_unit.h"
#include "tools/commands/common.h"
#include "tools/media/container.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string face;
  std::string audio;
  bool headers = false;
};

Result<int> run(const Options& options) {
  if (options.face.empty() && options.audio.empty()) {
    return usage_error("nothing to do: give --face, --audio or both");
  }
  if (!options.face.empty()) {
    Result<media::Container> container = media::read_container(options.input);
    if (!container) return container.error().in_file(options.input);
    for (const std::string& text : container->warnings) warn(options.input + ": " + text);
    const auto stream = fba::join_access_units(container->face, options.headers);
    if (auto written = write_file(options.face, stream); !written) return written.error();
    say(options.face + ": " + std::to_string(container->face.units.size()) + " planes");
  }
  if (!options.audio.empty()) {
    if (auto written = media::extract_audio(options.input, options.audio); !written) {
      return written.error().in_file(options.input);
    }
    say(options.audio + ": sound of " + options.input);
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "mp4, mkv, ts, m3u8 or mpd file with a face")->required();
  app.add_option("--face", options->face, "Raw FBA stream to write, - for standard output");
  app.add_option("--audio", options->audio, "Sound to write: .wav, or .m4a and others as it is");
  app.add_flag("--es-headers", options->headers,
               "Begin the stream with its visual object headers (old decoders want none)");
  return [options] { return run(*options); };
}

}  // namespace

const Command kDemux{"demux", "Take face and voice out of a file",
                     "  animeme demux talk.mp4 --face talk.fba --audio voice.m4a\n"
                     "  animeme demux talk.mp4 --audio voice.wav",
                     add};

}  // namespace animeme::tools
