#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "dam/script.h"
#include "fap/fill.h"
#include "fap/tables.h"
#include "tools/commands/common.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string a;
  std::string b;
  std::string output;
  std::string script;
  std::vector<int> faps = {3, 4, 5, 6};
};

constexpr double kLeft = 150;
constexpr double kRight = 20;
constexpr double kRow = 110;
constexpr double kBand = 26;
constexpr double kPixelsPerSecond = 260;
constexpr const char* kColours[] = {"#1f5fbf", "#d1495b"};

std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

class Plot {
 public:
  Plot(double seconds, std::size_t rows, bool band)
      : width_(kLeft + kRight + seconds * kPixelsPerSecond),
        top_(band ? kBand + 8 : 8),
        height_(top_ + double(rows) * kRow + 30) {
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width_) + "\" height=\"" +
           number(height_ + 20) + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    for (int tenth = 0; tenth <= int(seconds * 10); ++tenth) {
      if (tenth % 5 != 0) continue;
      const std::string at = number(x(tenth / 10.0));
      svg_ += "<line x1=\"" + at + "\" x2=\"" + at + "\" y1=\"" + number(top_) + "\" y2=\"" +
              number(height_ - 26) + "\" stroke=\"#dddddd\"/>\n<text x=\"" + at + "\" y=\"" +
              number(height_ - 10) + "\" text-anchor=\"middle\" fill=\"#555555\">" +
              number(tenth / 10.0) + " s</text>\n";
    }
  }

  // Phones as bands over the whole height, names on top; lip closures stand out.
  void phones(const dam::Script& script) {
    for (const dam::Phone& phone : script.phones) {
      if (phone.label == dam::kSilence) continue;
      const bool closure = phone.label == "P" || phone.label == "B" || phone.label == "M";
      const double width = phone.duration() * kPixelsPerSecond;
      svg_ +=
          "<rect x=\"" + number(x(phone.start)) + "\" y=\"4\" width=\"" + number(width) +
          "\" height=\"" + number(height_ - 30) + "\" fill=\"" + (closure ? "#ffd9b3" : "#eef3fa") +
          "\" stroke=\"#ffffff\"/>\n<text x=\"" + number(x(phone.start) + width / 2) +
          "\" y=\"20\" text-anchor=\"middle\" font-size=\"" +
          number(std::clamp(width * 0.6, 7.0, 12.0)) + "\">" + escape(phone.label) + "</text>\n";
    }
  }

  void row(std::size_t index, int fap, const std::vector<const fap::Sequence*>& clips) {
    const std::size_t n = std::size_t(fap);
    double low = 0;
    double high = 0;
    for (const fap::Sequence* clip : clips) {
      for (const fap::Frame& frame : clip->frames) {
        low = std::min<double>(low, frame.value[n]);
        high = std::max<double>(high, frame.value[n]);
      }
    }
    if (high - low < 1) high = low + 1;
    const double base = top_ + double(index) * kRow;
    const auto y = [&](double value) {
      return base + kRow - 12 - (value - low) / (high - low) * (kRow - 24);
    };
    svg_ += "<text x=\"8\" y=\"" + number(base + kRow / 2 - 4) + "\">FAP " + std::to_string(fap) +
            "</text>\n<text x=\"8\" y=\"" + number(base + kRow / 2 + 12) +
            "\" fill=\"#555555\" font-size=\"11\">" + escape(fap::info(fap).name) +
            "</text>\n<line x1=\"" + number(kLeft) + "\" x2=\"" + number(width_ - kRight) +
            "\" y1=\"" + number(y(0)) + "\" y2=\"" + number(y(0)) + "\" stroke=\"#888888\"/>\n";
    for (const double edge : {low, high}) {
      svg_ += "<text x=\"" + number(kLeft - 6) + "\" y=\"" + number(y(edge) + 4) +
              "\" text-anchor=\"end\" fill=\"#555555\" font-size=\"11\">" +
              std::to_string(std::lround(edge)) + "</text>\n";
    }
    for (std::size_t i = 0; i < clips.size(); ++i) {
      svg_ += std::string("<polyline fill=\"none\" stroke-width=\"2\" stroke=\"") + kColours[i] +
              "\" points=\"";
      for (const fap::Frame& frame : clips[i]->frames) {
        svg_ += number(x(clips[i]->rate.seconds(double(frame.number)))) + "," +
                number(y(frame.value[n])) + " ";
      }
      svg_ += "\"/>\n";
    }
  }

  // Which colour is which file.
  void legend(const std::vector<std::string>& names) {
    double at = 8;
    for (std::size_t i = 0; i < names.size(); ++i) {
      svg_ += "<text x=\"" + number(at) + "\" y=\"" + number(height_ + 8) + "\" fill=\"" +
              kColours[i] + "\">" + escape(names[i]) + "</text>\n";
      at += 30 + 7.0 * double(names[i].size());
    }
  }

  std::string finish() && { return std::move(svg_) + "</svg>\n"; }

 private:
  static double x(double seconds) { return kLeft + seconds * kPixelsPerSecond; }

  double width_;
  double top_;
  double height_;
  std::string svg_;
};

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
  double seconds = 0;
  std::vector<const fap::Sequence*> pointers;
  for (const fap::Sequence& clip : clips) {
    seconds = std::max(seconds, clip.duration());
    pointers.push_back(&clip);
  }
  if (seconds > 600) {
    return make_error(Code::out_of_range, "the clip is longer than ten minutes, too wide to plot")
        .in_file(options.a);
  }
  Plot plot(seconds, options.faps.size(), !options.script.empty());
  if (!options.script.empty()) {
    Result<std::string> text = read_text_file(options.script);
    if (!text) return text.error();
    Result<dam::Script> script = dam::read_script(*text);
    if (!script) return script.error().in_file(options.script);
    plot.phones(*script);
  }
  for (std::size_t i = 0; i < options.faps.size(); ++i) plot.row(i, options.faps[i], pointers);
  plot.legend(names);
  if (auto written = write_file(options.output, std::move(plot).finish()); !written) {
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
