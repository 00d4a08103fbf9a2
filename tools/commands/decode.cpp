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
  bool coded = false;
  bool fill = false;
};

// A stream says what becomes of FAPs that it does not code (held, mirrored), and which frames it
// skips; a text has no place for that, and players would show one side alone. What a text leaves
// open is open.
Result<fap::Sequence> shown(const MotionInput& input, const DecodeOptions& options) {
  const bool stream = !input.stream.empty();
  if (options.fill) {
    return stream ? fba::fill(input.decoded, {.complete = true}) : fap::fill(input.face);
  }
  if (!stream || options.coded) return input.face;
  return fba::fill(input.decoded, {.keep_high_level = true});
}

Result<std::string> face_text(MotionInput& input, const DecodeOptions& options) {
  if (input.face.frames.empty() && !input.body.frames.empty()) {
    return make_error(Code::not_found,
                      "the stream codes a body but no face: write it with --bap in place of -o")
        .in_file(options.input);
  }
  if (auto ok = require_face(input, options.input); !ok) return ok.error();
  Result<fap::Sequence> face = shown(input, options);
  if (!face) return face.error().in_file(options.input);
  face->name = input.face.name;
  input.face = std::move(*face);
  return fap::write_text(input.face);
}

// With -o and --bap what there is is written, so that batches run over files with and without
// bodies.
void leave_out_what_is_missing(const MotionInput& input, DecodeOptions& options) {
  if (options.output.empty() || options.bap.empty()) return;
  const auto leave_out = [&](std::string& path, const char* what) {
    warn(options.input + " has no " + what + ": " + name_of_output(path) + " is not written");
    path.clear();
  };
  if (input.body.frames.empty()) {
    leave_out(options.bap, "body");
  } else if (input.face.frames.empty()) {
    leave_out(options.output, "face");
  }
}

Result<std::string> body_text(const MotionInput& input, const DecodeOptions& options) {
  if (input.body.frames.empty()) {
    return make_error(Code::not_found, "there is no body in this: name a FAP text with -o")
        .in_file(options.input);
  }
  return fba::write_bap_text(input.body);
}

Result<int> run(DecodeOptions options) {
  if (options.output.empty() && options.bap.empty()) {
    return usage_error("nothing to write: name a FAP text with -o, a BAP text with --bap, or both");
  }
  if (options.output == options.bap) return usage_error("-o and --bap name the same file");
  if ((options.fill || options.coded) && options.output.empty()) {
    return usage_error("--fill and --coded are for the face: name a FAP text with -o");
  }
  Result<MotionInput> input = read_motion(options.input);
  if (!input) return input.error();
  leave_out_what_is_missing(*input, options);
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
  CLI::Option* coded = app.add_flag("--coded", options.coded,
                                    "The values as they are coded: sides that a stream leaves to "
                                    "be mirrored are missing, skipped frames too");
  app.add_flag("--fill", options.fill,
               "Every FAP: those that the stream never codes are at rest, 0")
      ->excludes(coded);
}

}  // namespace

const Command kDecode{"decode", "Decode an FBA stream to FAP and BAP text, as a player shows it",
                      "  animeme decode talk.mp4 -o talk.fap\n"
                      "  animeme decode dance.fba -o face.fap --bap body.bap\n"
                      "  animeme decode talk.fba --coded -o - | head -4    # for tests of decoders",
                      set_up<DecodeOptions>};

}  // namespace animeme::tools
