#include "codec/encode.h"

#include <map>
#include <memory>

#include "codec/epf.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string output;
  std::string epf;
  int quant = 1;
  int intra_period = 0;
  fba::PlaneStartCodes start_codes = fba::PlaneStartCodes::none;
  bool old_codes = false;
};

Result<int> run(const Options& options) {
  Result<FaceInput> input = read_face(options.input);
  if (!input) return input.error();
  const fba::StreamOptions stream{options.start_codes, options.old_codes};
  Result<std::vector<std::uint8_t>> bytes = std::vector<std::uint8_t>();
  if (options.epf.empty()) {
    fba::EncodeOptions settings;
    settings.fap_quant = options.quant;
    settings.intra_period = options.intra_period;
    settings.stream = stream;
    bytes = fba::encode(input->clip, settings);
  } else {
    Result<std::string> text = read_text_file(options.epf);
    if (!text) return text.error();
    Result<std::vector<fba::EpfPlane>> planes = fba::read_epf(*text);
    if (!planes) return planes.error().in_file(options.epf);
    bytes = fba::encode_epf(input->clip, {}, *planes, stream);
  }
  if (!bytes) return bytes.error().in_file(options.input);
  if (auto written = write_file(options.output, *bytes); !written) return written.error();
  const double seconds = input->clip.duration();
  char rate[64];
  std::snprintf(rate, sizeof rate, "%.2f", double(bytes->size()) * 8e-3 / seconds);
  say(name_of_output(options.output) + ": " + std::to_string(input->clip.frames.size()) +
      " planes, " + std::to_string(bytes->size()) + " bytes, " + rate + " kbit/s");
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "FAP text (also .fba or a container, to code it anew)")
      ->required();
  app.add_option("-o,--output", options->output, "FBA stream to write, - for standard output")
      ->required();
  app.add_option("--epf", options->epf,
                 "Encoder parameter file: every decision comes from it, the bytes are determined");
  app.add_option("--quant", options->quant,
                 "Quantiser fap_quant; 1 is not visible, 0 lossless up to +-1860")
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
    "encode", "Code FAP text as an FBA stream",
    "  animeme encode talk.fap -o talk.fba\n"
    "  animeme encode talk.fap --quant 4 --intra-period 50 --plane-start-codes intra -o talk.fba\n"
    "  animeme encode talk.fap --epf talk.epf -o talk.fba",
    add};

}  // namespace animeme::tools
