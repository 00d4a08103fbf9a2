#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tools/app/commands/common.h"
#include "tools/app/commands/plane_file.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/inspect/carriers.h"
#include "tools/formats/inspect/sizes.h"
#include "tools/formats/inspect/statistics.h"

namespace animeme::tools {

namespace {

struct StatsOptions {
  std::vector<std::string> inputs;
  bool json = false;
  bool sizes = false;
  bool carriers = false;
  std::optional<int> quant;
  double rms = 2;
  inspect::CarrierOptions carrying;
};

const char* kind_name(FileKind kind) {
  return kind == FileKind::fap_text   ? "fap"
         : kind == FileKind::bap_text ? "bap"
         : kind == FileKind::curves   ? "curves"
         : kind == FileKind::media    ? "media"
                                      : "fba";
}

// Row by row: a clip takes its time.
Result<int> print_sizes(const StatsOptions& options) {
  const int quant = options.quant.value_or(1);
  std::vector<inspect::ClipSizes> clips;
  const auto print = [&](const std::string& text) {
    if (!options.json) std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  };
  print(inspect::sizes_heading());
  for (const std::string& file : options.inputs) {
    Result<FaceInput> input = read_face(file);
    if (!input) return input.error();
    const std::string name = std::filesystem::path(file).stem().string();
    Result<inspect::ClipSizes> clip = inspect::measure_sizes(name, input->clip, quant, options.rms);
    if (!clip) return clip.error().in_file(file);
    print(inspect::sizes_row(*clip));
    clips.push_back(std::move(*clip));
  }
  print(inspect::sizes_means(clips, quant, options.rms));
  if (options.json) std::printf("%s\n", inspect::sizes_json(clips, quant, options.rms).c_str());
  const bool same = std::all_of(clips.begin(), clips.end(),
                                [](const inspect::ClipSizes& clip) { return clip.same_values; });
  return same ? kOk : kCheckFailed;
}

// The weights of a capture by ARKit's shapes; none of any other file.
Result<std::vector<fap::ArkitFrame>> weights_of(const std::string& path) {
  const auto bytes = read_input(path);
  if (!bytes) return bytes.error();
  const std::string text(bytes->begin(), bytes->end());
  if (kind_of(*bytes) != FileKind::curves || !exchange::is_arkit_table(text)) {
    return std::vector<fap::ArkitFrame>();
  }
  auto curves = exchange::read_arkit_weights(text);
  if (!curves) return curves.error().in_file(path);
  return std::move(curves->frames);
}

Result<inspect::ClipCarriers> measure_carriers(const std::string& path,
                                               inspect::CarrierOptions options) {
  const Result<FaceInput> input = read_face(path);
  if (!input) return input.error();
  const auto clip = shown_face(*input, path, {.expand = true});
  if (!clip) return clip.error();
  const auto weights = is_on_disk(path) ? weights_of(path) : std::vector<fap::ArkitFrame>();
  if (!weights) return weights.error();
  ProgressLine progress(path);
  options.progress = [&](double done) { progress.update(done); };
  auto measured = inspect::measure_carriers(std::filesystem::path(path).filename().string(), *clip,
                                            *weights, options);
  progress.clear();
  if (!measured) return measured.error().in_file(path);
  return measured;
}

Result<int> print_carriers(const StatsOptions& options) {
  inspect::CarrierOptions carrying = options.carrying;
  carrying.quant = options.quant.value_or(1);
  std::vector<inspect::ClipCarriers> clips;
  const auto print = [&](const inspect::ClipCarriers& clip) {
    if (options.json) return;
    std::printf("%s%s", clips.empty() ? "" : "\n", carriers_text(clip, carrying).c_str());
    std::fflush(stdout);
  };
  for (const std::string& file : options.inputs) {
    auto clip = measure_carriers(file, carrying);
    if (!clip) return clip.error();
    print(*clip);
    clips.push_back(std::move(*clip));
  }
  if (clips.size() > 1) print(inspect::carriers_of_all(clips));
  if (options.json) std::printf("%s\n", inspect::carriers_json(clips, carrying).c_str());
  return kOk;
}

Result<inspect::Statistics> measure_stream(const PlaneFile& file, const char* kind,
                                           const std::string& path, bool tell = true) {
  PlaneReader reader(file);
  inspect::Measurement measurement;
  for (;;) {
    const Result<const fba::Plane*> plane = reader.next();
    const bool ends = plane && *plane == nullptr;
    if (!plane || (ends && !reader.warnings().empty())) {
      const auto repaired = file.repaired(path);
      if (repaired) return measure_stream(*repaired, kind, path, tell);
    }
    if (!plane) return Error(plane.error()).in_file(path);
    if (ends) break;
    measurement.add(**plane);
  }
  for (const std::string& text : reader.warnings()) {
    if (tell) warn(path + ": " + text);
  }
  return measurement.measured(kind, {}, {}, reader.bytes());
}

Result<inspect::Statistics> measure_motion(const std::string& path) {
  Result<MotionInput> input = read_motion(path);
  if (!input) return input.error();
  const char* kind = kind_name(input->kind);
  if (!input->stream.empty()) {
    return measure_stream(PlaneFile(std::move(input->stream)), kind, path, false);
  }
  inspect::Measurement measurement;
  for (const fap::Frame& frame : input->face.frames) measurement.add(frame);
  for (const fba::BodyFrame& frame : input->body.frames) measurement.add(frame);
  return measurement.measured(kind, input->face.rate, input->body.rate, 0);
}

Result<int> run(const StatsOptions& options) {
  if (options.quant && !options.sizes && !options.carriers)
    return usage_error("--quant needs --sizes or --carriers");
  if (options.sizes) return print_sizes(options);
  if (options.carriers) return print_carriers(options);
  if (options.inputs.size() != 1) return usage_error("several files need --sizes or --carriers");
  const std::string& path = options.inputs.front();
  Result<inspect::Statistics> statistics = PlaneFile::can_read(path)
                                               ? measure_stream(PlaneFile(path), "fba", path)
                                               : measure_motion(path);
  if (!statistics) return statistics.error();
  std::fputs(options.json ? (inspect::statistics_json(*statistics) + "\n").c_str()
                          : inspect::statistics_text(*statistics).c_str(),
             stdout);
  return kOk;
}

void add_options(OptionTable& cli, StatsOptions& options) {
  cli.add("file", options.inputs, "FBA stream, container, FAP or BAP text, curves")->required();
  cli.add("--sizes", options.sizes,
          "Print how small each clip gets with encode --preset file and live, compared to "
          "the format common in the wild");
  cli.add("--carriers", options.carriers,
          "Print the size of each clip as FBA and as ARKit weights, Live Link, VMC, ARF and "
          "JSON, with their errors")
      ->excludes("--sizes");
  cli.add("--quant", options.quant,
          "With --sizes: quantiser of file and live; with --carriers: of the first row; "
          "default: 1")
      ->between(0, 31);
  cli.add("--rms", options.rms, "With --sizes: error limit of the last column")
      ->between(1e-3, 1e6)
      ->show_default()
      ->needs("--sizes");
  cli.add("--error", options.carrying.error,
          "With --carriers: mm RMS error that rows marked * may have")
      ->between(1e-4, 10)
      ->show_default()
      ->needs("--carriers");
  cli.add("--json", options.json, "Print a machine-readable result");
}

}  // namespace

const Command kStats{"stats", "Print the bit rate of a stream and the activity of each FAP and BAP",
                     "  animeme stats talk.fba\n"
                     "  animeme stats talk.fap --json\n"
                     "  animeme stats --sizes clips/*.fap\n"
                     "  animeme stats --sizes capture.fap --quant 4\n"
                     "  animeme stats --carriers talk.fba LiveLinkFace.csv --error 0.1",
                     set_up<StatsOptions>};

}  // namespace animeme::tools
