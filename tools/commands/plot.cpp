#include <algorithm>
#include <memory>

#include "dam/script.h"
#include "fap/fill.h"
#include "fap/tables.h"
#include "tools/commands/common.h"
#include "tools/commands/curve_plot.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string a;
  std::string b;
  std::string output;
  std::string script;
  std::vector<int> faps = {3, 4, 5, 6};
};

PlotRow row_of(int fap, const std::vector<fap::Sequence>& clips) {
  PlotRow row{"FAP " + std::to_string(fap), std::string(fap::info(fap).name), {}};
  for (const fap::Sequence& clip : clips) {
    PlotPoints points;
    for (const fap::Frame& frame : clip.frames) {
      points.emplace_back(clip.rate.seconds(double(frame.number)), frame.value[std::size_t(fap)]);
    }
    row.curves.push_back(std::move(points));
  }
  return row;
}

Result<int> run(const Options& options) {
  std::vector<fap::Sequence> clips;
  std::vector<std::string> names;
  for (const std::string& path : {options.a, options.b}) {
    if (path.empty()) continue;
    Result<FaceInput> input = read_face(path);
    if (!input) return input.error();
    Result<fap::Sequence> filled = fap::fill(input->clip);
    if (!filled) return filled.error().in_file(path);
    clips.push_back(std::move(*filled));
    names.push_back(std::filesystem::path(path).filename().string());
  }
  PlotPanel panel;
  for (const fap::Sequence& clip : clips) panel.seconds = std::max(panel.seconds, clip.duration());
  if (panel.seconds > kLongestPlot) {
    return make_error(Code::out_of_range, "the clip is longer than ten minutes, too wide to plot")
        .in_file(options.a);
  }
  dam::Script script;
  if (!options.script.empty()) {
    Result<std::string> text = read_text_file(options.script);
    if (!text) return text.error();
    Result<dam::Script> read = dam::read_script(*text);
    if (!read) return read.error().in_file(options.script);
    script = std::move(*read);
    panel.script = &script;
  }
  for (const int fap : options.faps) panel.rows.push_back(row_of(fap, clips));
  if (auto written = write_file(options.output, curves_svg({panel}, names)); !written) {
    return written.error();
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("a", options->a, "FAP text, FBA stream or container (blue)")->required();
  app.add_option("b", options->b, "A second one to compare with (red)");
  app.add_option("-o,--output", options->output, "SVG file to write, - for standard output")
      ->required();
  app.add_option("--script", options->script, "Phoneme script to show behind the curves");
  app.add_option("--faps", options->faps, "FAP numbers, one curve each")
      ->delimiter(',')
      ->check(CLI::Range(3, fap::kFapCount))
      ->capture_default_str();
  return [options] { return run(*options); };
}

}  // namespace

const Command kPlot{"plot", "Curves of one clip or two as SVG",
                    "  animeme plot talk.fap -o curves.svg\n"
                    "  animeme plot measured.fap talk.fap --script talk.TextGrid --faps 3,4,5,51 "
                    "-o curves.svg",
                    add};

}  // namespace animeme::tools
