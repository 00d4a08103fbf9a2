#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tools/commands/bounds.h"
#include "tools/commands/common.h"
#include "tools/commands/plane_file.h"
#include "tools/inspect/sizes.h"
#include "tools/inspect/statistics.h"

namespace animeme::tools {

namespace {

struct StatsOptions {
  std::vector<std::string> inputs;
  bool json = false;
  bool sizes = false;
  int quant = 1;
  double rms = 2;
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
    Result<inspect::ClipSizes> clip =
        inspect::measure_sizes(name, input->clip, options.quant, options.rms);
    if (!clip) return clip.error().in_file(file);
    print(inspect::sizes_row(*clip));
    clips.push_back(std::move(*clip));
  }
  print(inspect::sizes_means(clips, options.quant, options.rms));
  if (options.json)
    std::printf("%s\n", inspect::sizes_json(clips, options.quant, options.rms).c_str());
  const bool same = std::all_of(clips.begin(), clips.end(),
                                [](const inspect::ClipSizes& clip) { return clip.same_values; });
  return same ? kOk : kCheckFailed;
}

Result<inspect::Statistics> measure_stream(const PlaneFile& file, const char* kind,
                                           const std::string& path, bool tell = true) {
  PlaneReader reader(file);
  inspect::Measurement measurement;
  for (;;) {
    const Result<const fba::Plane*> plane = reader.next();
    if (!plane) return Error(plane.error()).in_file(path);
    if (*plane == nullptr) break;
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
  if (options.sizes) return print_sizes(options);
  if (options.inputs.size() != 1)
    return usage_error("several files can be given with --sizes only");
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

void add_options(CLI::App& app, StatsOptions& options) {
  app.add_option("file", options.inputs, "FBA stream, container, FAP or BAP text, curves")
      ->required();
  CLI::Option* sizes = app.add_flag("--sizes", options.sizes,
                                    "How small each clip gets with encode --preset file and live, "
                                    "beside the form common in the wild");
  app.add_option("--quant", options.quant, "With --sizes: quantiser of file and live")
      ->check(between(0, 31))
      ->capture_default_str()
      ->needs(sizes);
  app.add_option("--rms", options.rms, "With --sizes: limit of the error of the last column")
      ->check(between(1e-3, 1e6))
      ->capture_default_str()
      ->needs(sizes);
  app.add_flag("--json", options.json, "Machine-readable result");
}

}  // namespace

const Command kStats{"stats", "Bit rate of a stream, activity of each FAP and BAP",
                     "  animeme stats talk.fba\n"
                     "  animeme stats talk.fap --json\n"
                     "  animeme stats --sizes clips/*.fap\n"
                     "  animeme stats --sizes capture.fap --quant 4",
                     set_up<StatsOptions>};

}  // namespace animeme::tools
