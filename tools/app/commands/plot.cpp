#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "dam/script/script.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/fap_names.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/common/text.h"
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
  std::string title;
  std::string size;
  double width = 0;  // millimetres
  std::string scales = "unit";
  bool spectrum = false;
};

constexpr double kPixels = 96 / 25.4, kPrintDots = 300 / 25.4;  // in a millimetre
constexpr double kHighestHertz = 15;                            // of a spectrum
constexpr int kLeastSide = 120, kLargestSide = 8192;            // pixels

struct PlotSize {
  int width = 0, height = 0;
};

std::optional<PlotSize> parse_plot_size(const std::string& text) {
  PlotSize size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%4dx%4d%c", &size.width, &size.height, &rest) != 2) {
    return std::nullopt;
  }
  const auto fits = [](int side) { return side >= kLeastSide && side <= kLargestSide; };
  if (!fits(size.width) || !fits(size.height)) return std::nullopt;
  return size;
}

std::string problem_of_size(const std::string& text) {
  if (parse_plot_size(text)) return {};
  return "give WIDTHxHEIGHT in pixels, each from 120 to 8192";
}

// What --width and --size ask for.
plot::Layout layout_of(const PlotOptions& options) {
  plot::Layout layout;
  layout.title = options.title;
  layout.own_scales = options.scales == "row";
  if (!options.size.empty()) {
    const PlotSize size = parse_plot_size(options.size).value_or(PlotSize{});
    layout.width = size.width;
    layout.height = size.height;
  } else if (options.width > 0) {
    layout.width = options.width * kPixels;
    layout.shown_width = extension_of(options.output) == ".png"
                             ? format("%.0f", options.width * kPrintDots)
                             : format("%gmm", options.width);
  }
  return layout;
}

plot::Panel spectrum_panel(const std::vector<int>& faps,
                           const std::vector<plot::TimedClip>& clips) {
  plot::Panel panel;
  panel.axis = "Frequency (Hz)";
  double highest = 0;
  for (const plot::TimedClip& clip : clips)
    highest = std::max(highest, clip.clip.rate.frames_per_second() / 2);
  panel.seconds = std::min(highest, kHighestHertz);
  for (const int fap : faps) panel.rows.push_back(plot::spectrum_row(fap, clips, panel.seconds));
  return panel;
}

// The frames that a panel of time shows.
std::vector<plot::TimedClip> parts_of(const std::vector<plot::TimedClip>& clips,
                                      const plot::Panel& shown) {
  std::vector<plot::TimedClip> parts = clips;
  for (plot::TimedClip& part : parts) {
    std::erase_if(part.clip.frames, [&](const fap::Frame& frame) {
      const double time = part.start + part.clip.rate.seconds(double(frame.number));
      return time < shown.begin - 1e-9 || time > shown.seconds + 1e-9;
    });
  }
  return parts;
}

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
  std::vector<plot::Panel> panels = {std::move(panel)};
  if (options.spectrum) panels.push_back(spectrum_panel(*faps, parts_of(clips, panels[0])));
  const plot::Layout layout = layout_of(options);
  if (const double least = plot::least_height(panels, names, layout);
      layout.height > 0 && layout.height < least) {
    return usage_error(
        format("--size is too low for these rows; they need a height of %.0f", std::ceil(least)));
  }
  const auto drawing = plot::drawing_bytes(options.output, plot::curves_svg(panels, names, layout));
  if (!drawing) return drawing.error();
  if (auto written = write_file(options.output, *drawing); !written) return written.error();
  std::size_t rows = 0;
  for (const plot::Panel& one : panels) rows += one.rows.size();
  report_output(options.output, std::to_string(rows) + " rows of curves",
                {{"rows", rows}, {"bytes", drawing->size()}});
  return kOk;
}

void add_options(OptionTable& cli, PlotOptions& options) {
  cli.add("a", options.a, "FAP text, FBA stream or container (blue line)")->required();
  cli.add("b", options.b, "A second clip to compare with (orange, dashed)");
  cli.add("-o,--output", options.output,
          "Picture to write: .svg, .pdf or .png; - is SVG on standard output")
      ->output(".svg .pdf .png", OutputKind::file_or_dash)
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
  cli.add("--title", options.title, "Title above the curves")->type("TEXT");
  cli.add("--width", options.width,
          "Width in print in millimetres: 85 is a column of a paper, 178 a page; letters of 8 "
          "points, .png with 300 dots an inch")
      ->type("MM")
      ->between(40.0, 600.0)
      ->excludes("--size");
  cli.add("--size", options.size, "Width and height in pixels, for slides and pages")
      ->type("WIDTHxHEIGHT")
      ->check(problem_of_size);
  cli.add("--scales", options.scales,
          "unit: rows of a unit share a scale, to be compared; row: each row has its own")
      ->one_of("unit row")
      ->show_default();
  cli.add("--spectrum", options.spectrum,
          "Add the spectrum of each FAP's motion, in decibels over the frequency");
  add_track_option(cli, options.track);
}

}  // namespace

const Command kPlot{"plot", "Plot the curves of one or two clips",
                    "  animeme plot talk.fap -o curves.svg\n"
                    "  animeme plot measured.fap talk.fap --script talk.TextGrid --faps 3,4,5,51 "
                    "-o curves.svg\n"
                    "  animeme plot talk.fap talk.fba --difference --faps open_jaw,raise_b_midlip "
                    "-o loss.png\n"
                    "  animeme plot measured.fap talk.fap --width 85 --title \"Jaw and lips\" "
                    "-o figure.pdf",
                    set_up<PlotOptions>};

}  // namespace animeme::tools
