#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "dam/script/script.h"
#include "fap/fill.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"
#include "tools/commands/common.h"
#include "tools/commands/curve_plot.h"
#include "tools/commands/fap_names.h"
#include "tools/commands/voice_input.h"

namespace animeme::tools {

namespace {

struct PlotOptions {
  std::string a;
  std::string b;
  std::string output;
  std::string script;
  std::vector<std::string> faps = {"3", "4", "5", "6"};
  bool difference = false;
  double from = 0;
  double to = -1;
};

// A filled clip, and when its frame 0 is shown.
struct PlottedClip {
  fap::Sequence clip;
  double start = 0;

  double end() const { return start + clip.duration(); }
};

PlotPoints points_of(int fap, const PlottedClip& shown) {
  PlotPoints points;
  for (const fap::Frame& frame : shown.clip.frames) {
    points.emplace_back(shown.start + shown.clip.rate.seconds(double(frame.number)),
                        frame.value[std::size_t(fap)]);
  }
  return points;
}

std::string unit_of(int fap) {
  const fap::Unit unit = fap::info(fap).unit;
  if (unit == fap::Unit::angle) return "0.00001 rad";
  return "1/1024 " + std::string(fap::unit_name(unit));
}

PlotRow row_of(int fap, const std::vector<PlottedClip>& clips) {
  PlotRow row{"FAP " + std::to_string(fap), std::string(fap::info(fap).name), unit_of(fap), {}};
  for (const PlottedClip& clip : clips) row.curves.push_back(points_of(fap, clip));
  return row;
}

// b less a at the times of a; what b shows at a time is its last frame so far.
PlotRow difference_of(int fap, const PlottedClip& a, const PlottedClip& b) {
  PlotRow row{"FAP " + std::to_string(fap), "difference", unit_of(fap), {{}}, 2};
  const PlotPoints shown = points_of(fap, b);
  std::size_t at = 0;
  for (const auto& [time, value] : points_of(fap, a)) {
    while (at + 1 < shown.size() && shown[at + 1].first <= time + 1e-6) ++at;
    if (!shown.empty()) row.curves[0].emplace_back(time, shown[at].second - value);
  }
  return row;
}

Result<int> run(const PlotOptions& options) {
  const Result<std::vector<int>> faps = fap_numbers(options.faps);
  if (!faps) return usage_error("--faps: " + faps.error().message);
  if (!is_drawing(options.output)) {
    return usage_error("--output must end in .svg or .png, not " + options.output);
  }
  if (options.to > 0 && options.to <= options.from) {
    return usage_error("--to has to lie behind --from");
  }
  if (options.difference && options.b.empty()) {
    return usage_error("--difference needs two clips");
  }
  std::vector<PlottedClip> clips;
  std::vector<std::string> names;
  for (const std::string& path : {options.a, options.b}) {
    if (path.empty()) continue;
    Result<FaceInput> input = read_face(path);
    if (!input) return input.error();
    Result<fap::Sequence> filled = fap::fill(input->clip);
    if (!filled) return filled.error().in_file(path);
    // FAP 1 and 2 as the built-in head shows them.
    for (fap::Frame& frame : filled->frames) frame = head::low_level(frame);
    clips.push_back({std::move(*filled), input->start});
    names.push_back(std::filesystem::path(path).filename().string());
  }
  PlotPanel panel;
  for (const PlottedClip& clip : clips) panel.seconds = std::max(panel.seconds, clip.end());
  if (options.from >= panel.seconds) {
    return usage_error("--from lies behind the end of the clip");
  }
  panel.begin = options.from;
  if (options.to > 0) panel.seconds = std::min(panel.seconds, options.to);
  if (panel.seconds - panel.begin > kLongestPlot) {
    return make_error(
               Code::out_of_range,
               "more than ten minutes are too wide to plot; choose a part by --from and --to")
        .in_file(options.a);
  }
  dam::Script script;
  if (!options.script.empty()) {
    Result<dam::Script> read = read_script(options.script);
    if (!read) return read.error();
    script = std::move(*read);
    panel.script = &script;
  }
  for (const int fap : *faps) {
    panel.rows.push_back(row_of(fap, clips));
    if (options.difference) panel.rows.push_back(difference_of(fap, clips[0], clips[1]));
  }
  if (options.difference) names.emplace_back("difference: second less first");
  if (auto written = write_drawing(options.output, curves_svg({panel}, names)); !written) {
    return written.error();
  }
  return kOk;
}

Action add_plot(CLI::App& app) {
  auto options = std::make_shared<PlotOptions>();
  app.add_option("a", options->a, "FAP text, FBA stream or container (blue line)")->required();
  app.add_option("b", options->b, "A second one to compare with (orange, dashed)");
  app.add_option("-o,--output", options->output,
                 "Picture to write: .svg or .png; - is SVG on standard output")
      ->required();
  app.add_option("--script", options->script, "Phoneme script to show behind the curves");
  app.add_option("--faps", options->faps, "FAPs by number, name or range (3-13), one row each")
      ->delimiter(',')
      ->capture_default_str();
  app.add_flag("--difference", options->difference,
               "A row with the second less the first for each");
  app.add_option("--from", options->from, "Seconds at which the picture begins")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--to", options->to, "Seconds at which it ends")->check(CLI::PositiveNumber);
  return [options] { return run(*options); };
}

}  // namespace

const Command kPlot{"plot", "Curves of one clip or two as a picture",
                    "  animeme plot talk.fap -o curves.svg\n"
                    "  animeme plot measured.fap talk.fap --script talk.TextGrid --faps 3,4,5,51 "
                    "-o curves.svg\n"
                    "  animeme plot talk.fap talk.fba --difference --faps open_jaw,raise_b_midlip "
                    "-o loss.png",
                    add_plot};

}  // namespace animeme::tools
