#include <filesystem>
#include <memory>

#include "fap/rate_text.h"
#include "fap/text.h"
#include "tools/commands/arkit_csv.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string output;
  std::string rate;
  bool degrees = false;
};

Result<int> run(const Options& options) {
  ArkitCsvOptions settings;
  settings.degrees = options.degrees;
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate || !rate->valid()) {
      return usage_error("--rate: '" + options.rate + "' is no frame rate; write 30 or 29.97");
    }
    settings.rate = *rate;
  }
  const Result<std::string> text = read_text_file(options.input);
  if (!text) return text.error();
  if (text->starts_with("\x1f\x8b")) {
    return make_error(Code::unsupported, "this is a packed file; unpack it with gunzip first")
        .in_file(options.input);
  }
  std::vector<std::string> warnings;
  Result<fap::Sequence> clip = read_arkit_csv(*text, settings, warnings);
  if (!clip) return clip.error().in_file(options.input);
  for (const std::string& warning : warnings) warn(options.input + ": " + warning);
  if (options.input != "-") clip->name = std::filesystem::path(options.input).stem().string();
  if (auto written = write_file(options.output, fap::write_text(*clip)); !written) {
    return written.error();
  }
  const std::int64_t skipped = clip->frames.back().number + 1 - std::int64_t(clip->frames.size());
  say(name_of_output(options.output) + ": " + std::to_string(clip->frames.size()) + " frames, " +
      std::to_string(clip->frames.front().mask.count()) + " FAPs, " + fap::format_rate(clip->rate) +
      " frames a second" + (skipped > 0 ? ", " + std::to_string(skipped) + " frames skipped" : ""));
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input,
                 "Table of ARKit blend shapes: a CSV file of Live Link Face, or time_s and one "
                 "column a shape; - for standard input")
      ->required();
  app.add_option("-o,--output", options->output, "FAP text to write, - for standard output")
      ->required();
  app.add_option("--rate", options->rate,
                 "Frames a second of the clip, like 30 or 29.97; without it the times tell");
  app.add_flag("--degrees", options->degrees, "Angles of head and eyes are degrees, not radians");
  return [options] { return run(*options); };
}

}  // namespace

const Command kImport{"import", "Turn a face captured by a phone (ARKit curves) into FAPs",
                      "  animeme import take.csv -o take.fap\n"
                      "  animeme import take.csv --rate 29.97 -o take.fap\n"
                      "  animeme import take.csv -o - | animeme encode - -o take.fba",
                      add};

}  // namespace animeme::tools
