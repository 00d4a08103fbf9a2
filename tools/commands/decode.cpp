#include <CLI/CLI.hpp>

#include "codec/decode/fill.h"
#include "fap/fill.h"
#include "fap/text.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct DecodeOptions {
  std::string input;
  std::string output;
  std::string bap;
  bool fill = false;
};

Result<std::string> face_text(MotionInput& input, const DecodeOptions& options) {
  if (input.face.frames.empty() && !input.body.frames.empty()) {
    const char* remedy = options.bap.empty() ? "write the body with --bap in place of -o"
                                             : "leave out -o, --bap alone writes the body";
    return make_error(Code::not_found,
                      std::string("the stream codes a body but no face: ") + remedy)
        .in_file(options.input);
  }
  if (auto ok = require_face(input, options.input); !ok) return ok.error();
  if (options.fill) {
    // A stream says what becomes of FAPs that it does not code, a text does not.
    Result<fap::Sequence> filled =
        input.stream.empty() ? fap::fill(input.face) : fba::fill(input.decoded, {.complete = true});
    if (!filled) return filled.error().in_file(options.input);
    filled->name = input.face.name;
    input.face = std::move(*filled);
  }
  return fap::write_text(input.face);
}

Result<std::string> body_text(const MotionInput& input, const DecodeOptions& options) {
  if (input.body.frames.empty()) {
    return make_error(Code::not_found, "there is no body in this: leave out --bap")
        .in_file(options.input);
  }
  return fba::write_bap_text(input.body);
}

Result<int> run(const DecodeOptions& options) {
  if (options.output.empty() && options.bap.empty()) {
    return usage_error("nothing to write: name a FAP text with -o, a BAP text with --bap, or both");
  }
  if (options.output == options.bap) return usage_error("-o and --bap name the same file");
  if (options.fill && options.output.empty()) {
    return usage_error("--fill is for the face: name a FAP text with -o");
  }
  Result<MotionInput> input = read_motion(options.input);
  if (!input) return input.error();
  std::vector<OutputText> files;
  Result<std::string> body = std::string();
  if (!options.bap.empty()) {
    body = body_text(*input, options);
    if (!body) return body.error();
    files.push_back({options.bap, *body});
  }
  Result<std::string> face = std::string();
  if (!options.output.empty()) {
    face = face_text(*input, options);
    if (!face) return face.error();
    files.push_back({options.output, *face});
  }
  if (auto written = write_files(files); !written) return written.error();
  const auto told = [](const std::string& path, std::size_t frames, const char* what) {
    if (path.empty()) return;
    say(name_of_output(path) + ": " + std::to_string(frames) + " " + what + "frames");
  };
  const std::size_t bodies = input->body.frames.size();
  told(options.output, input->face.frames.size(), "");
  told(options.bap, bodies, "body ");
  if (options.bap.empty() && bodies > 0) {
    say(options.input + ": there are " + std::to_string(bodies) +
        " body frames too, --bap writes them");
  }
  return kOk;
}

void add_options(CLI::App& app, DecodeOptions& options) {
  app.add_option("input", options.input, "FBA stream, or an mp4, mkv or ts file with one")
      ->required();
  app.add_option("-o,--output", options.output, "FAP text to write, - for standard output");
  app.add_option("--bap", options.bap, "BAP text with the body to write, - for standard output");
  app.add_flag("--fill", options.fill,
               "Resolve held, mirrored and skipped values, for players that want every FAP; those "
               "that a stream never codes are at rest, 0");
}

}  // namespace

const Command kDecode{"decode",
                      "Decode an FBA stream to FAP and BAP text: the coded values exactly",
                      "  animeme decode talk.mp4 -o talk.fap\n"
                      "  animeme decode dance.fba -o face.fap --bap body.bap\n"
                      "  animeme decode talk.fba --fill -o - | head -4",
                      set_up<DecodeOptions>};

}  // namespace animeme::tools
