#include <memory>

#include "fap/fill.h"
#include "fap/text.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string output;
  bool fill = false;
};

Result<int> run(const Options& options) {
  Result<FaceInput> input = read_face(options.input);
  if (!input) return input.error();
  fap::Sequence clip = std::move(input->clip);
  if (clip.frames.empty()) {
    return make_error(Code::not_found, "the stream codes a body but no face")
        .in_file(options.input);
  }
  if (options.fill) {
    Result<fap::Sequence> filled = fap::fill(clip);
    if (!filled) return filled.error().in_file(options.input);
    clip = std::move(*filled);
  }
  if (auto written = write_file(options.output, fap::write_text(clip)); !written) {
    return written.error();
  }
  say(name_of_output(options.output) + ": " + std::to_string(clip.frames.size()) + " frames");
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "FBA stream, or an mp4, mkv or ts file with one")
      ->required();
  app.add_option("-o,--output", options->output, "FAP text to write, - for standard output")
      ->required();
  app.add_flag("--fill", options->fill,
               "Resolve held, mirrored and skipped values, for players that want every FAP");
  return [options] { return run(*options); };
}

}  // namespace

const Command kDecode{"decode", "Decode an FBA stream to FAP text: the coded values exactly",
                      "  animeme decode talk.mp4 -o talk.fap\n"
                      "  animeme decode talk.fba --fill -o - | head -4",
                      add};

}  // namespace animeme::tools
