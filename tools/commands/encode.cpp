#include "codec/body_encode.h"
#include "codec/encoder.h"

#include <cstdio>
#include <map>
#include <memory>

#include "codec/epf.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string bap;
  std::string output;
  std::string epf;
  int quant = 1;
  int intra_period = 0;
  fba::PlaneStartCodes start_codes = fba::PlaneStartCodes::none;
  bool old_codes = false;

  fba::StreamOptions stream() const { return {start_codes, old_codes}; }
};

using Bytes = std::vector<std::uint8_t>;

// What there is to code. Frames keep their numbers: an EPF names them in FFR and BFR, and those of
// face and body belong together.
struct Material {
  fap::Sequence face;
  fba::BodySequence body;
};

Result<Material> read_material(const Options& options) {
  Material material;
  if (!options.input.empty()) {
    Result<MotionInput> input = read_motion(options.input, FrameNumbers::keep);
    if (!input) return input.error();
    if (input->kind == FileKind::bap_text) {
      return make_error(Code::not_found, "this is BAP text and holds no face: give it after --bap")
          .in_file(options.input);
    }
    if (input->body.frames.empty() && options.bap.empty()) {
      if (auto ok = require_face(*input, options.input); !ok) return ok.error();
    }
    material.face = std::move(input->face);
    material.body = std::move(input->body);
  }
  if (!options.bap.empty()) {
    Result<MotionInput> input = read_motion(options.bap, FrameNumbers::keep);
    if (!input) return input.error();
    if (input->body.frames.empty()) {
      return make_error(Code::not_found,
                        "this holds no body: --bap wants BAP text (version 3.1 or 3.2), or a "
                        "stream with a body")
          .in_file(options.bap);
    }
    material.body = std::move(input->body);
  }
  return material;
}

Result<void> check_material(const Material& material, const std::vector<fba::EpfPlane>& planes) {
  for (const fba::EpfPlane& plane : planes) {
    if (fba::has_face(plane.object_mask) && material.face.frames.empty()) {
      return make_error(Code::not_found, "the EPF codes a face: name a FAP text to take it from");
    }
    if (fba::has_body(plane.object_mask) && material.body.frames.empty()) {
      return make_error(Code::not_found, "the EPF codes a body: name a BAP text with --bap");
    }
  }
  return {};
}

Result<Bytes> encode_by_epf(const Options& options) {
  Result<std::string> text = read_text_file(options.epf);
  if (!text) return text.error();
  Result<std::vector<fba::EpfPlane>> planes = fba::read_epf(*text);
  if (!planes) return planes.error().in_file(options.epf);
  Result<Material> material = read_material(options);
  if (!material) return material.error();
  if (auto ok = check_material(*material, *planes); !ok) return ok.error().in_file(options.epf);
  Result<Bytes> bytes =
      fba::encode_epf(material->face, material->body.frames, *planes, options.stream());
  if (!bytes) return bytes.error().in_file(options.epf);
  return bytes;
}

Result<Bytes> encode_freely(const Options& options) {
  Result<Material> material = read_material(options);
  if (!material) return material.error();
  fba::EncodeOptions settings;
  settings.fap_quant = options.quant;
  settings.intra_period = options.intra_period;
  settings.stream = options.stream();
  Result<Bytes> bytes = material->body.frames.empty()
                            ? fba::encode(material->face, settings)
                            : fba::encode_with_body(material->face, material->body, settings);
  if (!bytes) return bytes.error().in_file(options.input.empty() ? options.bap : options.input);
  return bytes;
}

// Counts what was written as a receiver does.
void say_result(const std::string& output, const Bytes& bytes) {
  const Result<fba::DecodedStream> decoded = fba::decode(bytes);
  if (!decoded) return;
  const double seconds = decoded->rate.seconds(double(decoded->planes.back().number + 1));
  char text[96];
  std::snprintf(text, sizeof text, ": %zu planes, %zu bytes, %.2f kbit/s", decoded->planes.size(),
                bytes.size(), double(bytes.size()) * 8e-3 / seconds);
  say(name_of_output(output) + text);
}

Result<int> run(const Options& options) {
  if (options.input.empty() && options.bap.empty()) {
    return usage_error("nothing to code: name a FAP text, or a BAP text with --bap");
  }
  Result<Bytes> bytes = options.epf.empty() ? encode_freely(options) : encode_by_epf(options);
  if (!bytes) return bytes.error();
  if (auto written = write_file(options.output, *bytes); !written) return written.error();
  say_result(options.output, *bytes);
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "FAP text (also .fba or a container, to code it anew)");
  app.add_option("--bap", options->bap, "BAP text (or a stream) with the body");
  app.add_option("-o,--output", options->output, "FBA stream to write, - for standard output")
      ->required();
  app.add_option("--epf", options->epf,
                 "Encoder parameter file: every decision comes from it, the bytes are determined");
  app.add_option("--quant", options->quant,
                 "Quantiser of face and body; 1 is not visible, 0 lossless up to +-1860")
      ->check(CLI::Range(0, 31))
      ->capture_default_str()
      ->excludes("--epf");
  app.add_option("--intra-period", options->intra_period,
                 "Intra plane every N planes for random access; 0: only where needed")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->excludes("--epf");
  const std::map<std::string, fba::PlaneStartCodes> names = {{"none", fba::PlaneStartCodes::none},
                                                             {"intra", fba::PlaneStartCodes::intra},
                                                             {"all", fba::PlaneStartCodes::all}};
  app.add_option("--plane-start-codes", options->start_codes,
                 "Planes that get a start code: none, intra or all")
      ->transform(CLI::CheckedTransformer(names).description(""));
  app.add_flag("--old-codes", options->old_codes, "Write plane start codes of the 1999 edition");
  return [options] { return run(*options); };
}

}  // namespace

const Command kEncode{
    "encode", "Code FAP and BAP text as an FBA stream",
    "  animeme encode talk.fap -o talk.fba\n"
    "  animeme encode talk.fap --quant 4 --intra-period 50 --plane-start-codes intra -o talk.fba\n"
    "  animeme encode talk.fap --epf talk.epf -o talk.fba\n"
    "  animeme encode face.fap --bap body.bap -o both.fba",
    add};

}  // namespace animeme::tools
