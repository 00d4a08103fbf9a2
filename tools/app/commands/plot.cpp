#include <algorithm>
#include <filesystem>

#include "dam/script/script.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/fap_names.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/track_option.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/view/plot/clips.h"

namespace animeme::tools {

namespace {

struct PlotOptions {
  std::string track;  // of several languages or people
  std::string a;
  std::string b;
  std::string output;
  std::string script;
  speech::ScriptInput reading;
  std::vector<std::string> faps = {"3", "4", "5", "6"};
  bool difference = false;
  LengthLimit length;
  double from = 0;
  double to = -1;
};

Result<int> run(const PlotOptions& options) {
  const media::TrackScope tracks(wanted_track_of(options.track));
  const Result<std::vector<int>> faps = fap_numbers(options.faps);
  if (!faps) return faps.error();
  if (options.to > 0 && options.to <= options.from) {
    return usage_error("--to must be after --from");
  }
  if (options.difference && options.b.empty()) {
    return usage_error("--difference needs two clips");
  }
  std::vector<plot::TimedClip> clips;
  std::vector<std::string> names;
  for (const std::string& path : {options.a, options.b}) {
    if (path.empty()) continue;
    Result<FaceInput> input = read_face(path);
    if (!input) return input.error();
    Result<fap::Sequence> filled = shown_face(*input, path, {}, options.length);
    if (!filled) return filled.error();
    clips.push_back({std::move(*filled), input->start});
    names.push_back(std::filesystem::path(path).filename().string());
  }
  plot::Panel panel;
  for (const plot::TimedClip& clip : clips) panel.seconds = std::max(panel.seconds, clip.end());
  if (options.from >= panel.seconds) {
    return usage_error("--from is after the end of the clip");
  }
  panel.begin = options.from;
  if (options.to > 0) panel.seconds = std::min(panel.seconds, options.to);
  if (panel.seconds - panel.begin > plot::kLongest) {
    return make_error(
               Code::out_of_range,
               "more than ten minutes are too wide to plot; choose a part with --from and --to")
        .in_file(options.a);
  }
  const Result<dam::Script> script =
      script_for(options.script, {options.a, options.b}, options.reading);
  if (!script) return script.error();
  if (!script->phones.empty()) panel.script = &*script;
  for (const int fap : *faps) {
    panel.rows.push_back(plot::fap_row(fap, clips));
    if (options.difference) panel.rows.push_back(plot::difference_row(fap, clips[0], clips[1]));
  }
  if (options.difference) names.emplace_back("difference: second minus first");
  const auto drawing = plot::drawing_bytes(options.output, plot::curves_svg({panel}, names));
  if (!drawing) return drawing.error();
  if (auto written = write_file(options.output, *drawing); !written) return written.error();
  report_output(options.output, std::to_string(panel.rows.size()) + " rows of curves",
                {{"rows", panel.rows.size()}, {"bytes", drawing->size()}});
  return kOk;
}

void add_options(OptionTable& cli, PlotOptions& options) {
  cli.add("a", options.a, "FAP text, FBA stream or container (blue line)")->required();
  cli.add("b", options.b, "A second clip to compare with (orange, dashed)");
  cli.add("-o,--output", options.output,
          "Picture to write: .svg or .png; - is SVG on standard output")
      ->output(".svg .png", OutputKind::file_or_dash)
      ->required();
  cli.add("--script", options.script,
          "Phoneme script to show behind the curves; default: that in a container");
  add_script_options(cli, options.reading.reading, options.reading.language);
  cli.add("--faps", options.faps, "FAPs by number, name or range (3-13), a row each")
      ->at_commas()
      ->type("FAPS")
      ->check(problem_of<faps_of>)
      ->show_default();
  cli.add("--difference", options.difference, "Add rows with the second minus the first clip");
  add_length_option(cli, options.length);
  cli.add("--from", options.from, "Start of the picture in seconds")->at_least_zero();
  cli.add("--to", options.to, "End of the picture in seconds")->above_zero();
  add_track_option(cli, options.track);
}

}  // namespace

const Command kPlot{"plot", "Plot the curves of one or two clips",
                    "  animeme plot talk.fap -o curves.svg\n"
                    "  animeme plot measured.fap talk.fap --script talk.TextGrid --faps 3,4,5,51 "
                    "-o curves.svg\n"
                    "  animeme plot talk.fap talk.fba --difference --faps open_jaw,raise_b_midlip "
                    "-o loss.png",
                    set_up<PlotOptions>};

}  // namespace animeme::tools
