#include <cstdio>
#include <memory>

#include "codec/fill.h"
#include "dam/script.h"
#include "fap/fill.h"
#include "fap/head/rig.h"
#include "tools/commands/common.h"
#include "tools/commands/head_file.h"
#include "tools/commands/view_sound.h"
#include "tools/media/container.h"
#include "tools/viewer/viewer.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string first;
  std::string second;
  std::string output;
  std::string audio;
  std::string script;
  HeadChoice head;
};

struct Shown {
  viewer::Clip clip;
  bool container = false;
};

Result<Shown> read_shown(const std::string& path) {
  Result<std::vector<std::uint8_t>> bytes = read_file(path);
  if (!bytes) return bytes.error();
  Shown shown;
  shown.clip.name = std::filesystem::path(path).filename().string();
  if (kind_of(*bytes) == FileKind::media) {
    // The stream alone does not tell when its face begins against the sound.
    const Result<media::Container> container =
        media::read_container(std::span<const std::uint8_t>(*bytes));
    if (!container) return container.error().in_file(path);
    const fba::AccessUnits& face = container->face;
    if (!face.units.empty()) {
      shown.clip.start = double(face.units.front().time) / face.timescale;
    }
    shown.container = true;
  }
  Result<MotionInput> input = parse_motion(std::move(*bytes), path);
  if (!input) return input.error();
  if (auto ok = require_face(*input, path); !ok) return ok.error();
  Result<fap::Sequence> filled = input->stream.empty()
                                     ? fap::fill(input->face)
                                     : fba::fill(input->decoded, {.complete = true});
  if (!filled) return filled.error().in_file(path);
  shown.clip.motion = std::move(*filled);
  return shown;
}

Result<std::optional<viewer::Sound>> read_sound(const Options& options, bool container) {
  if (options.audio.empty() && !container) return std::optional<viewer::Sound>();
  const std::string& path = options.audio.empty() ? options.first : options.audio;
  Result<viewer::Sound> sound = page_sound(path);
  if (sound) return std::optional(std::move(*sound));
  const bool silent = options.audio.empty() && sound.error().code == Code::not_found;
  if (silent) return std::optional<viewer::Sound>();
  return sound.error().in_file(path);
}

Result<dam::Script> read_script(const std::string& path) {
  if (path.empty()) return dam::Script();
  const Result<std::string> text = read_text_file(path);
  if (!text) return text.error();
  Result<dam::Script> script = dam::read_script(*text);
  if (!script) return script.error().in_file(path);
  return script;
}

Result<int> run(const Options& options) {
  if (const std::string problem = problem_of(options.head); !problem.empty()) {
    return usage_error(problem);
  }
  const Result<head::Head> head = load_head_and_tell(options.head);
  if (!head) return head.error();
  viewer::Page page;
  bool container = false;
  for (const std::string& path : {options.first, options.second}) {
    if (path.empty()) continue;
    Result<Shown> shown = read_shown(path);
    if (!shown) return shown.error();
    if (page.clips.empty()) container = shown->container;
    page.clips.push_back(std::move(shown->clip));
  }
  Result<std::optional<viewer::Sound>> sound = read_sound(options, container);
  if (!sound) return sound.error();
  page.sound = std::move(*sound);
  Result<dam::Script> script = read_script(options.script);
  if (!script) return script.error();
  page.script = std::move(*script);
  const head::Rig rig = head::make_rig(*head);
  page.head = &*head;
  page.rig = &rig;
  const Result<std::string> html = viewer::make_page(page);
  if (!html) return html.error();
  if (auto written = write_file(options.output, *html); !written) return written.error();
  char size[32];
  std::snprintf(size, sizeof size, "%.2f MB", double(html->size()) / 1e6);
  say(name_of_output(options.output) + ": " + size + (page.sound ? ", with sound" : ", silent") +
      "; open it in a browser");
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->first,
                 "FAP text, FBA stream, a container with a face, or a table of curves")
      ->required();
  app.add_option("second", options->second, "Another one to compare it with");
  app.add_option("-o,--output", options->output, "HTML file to write, - for standard output")
      ->required();
  app.add_option("--audio", options->audio,
                 "Sound in any format that FFmpeg reads; by default that of the container");
  app.add_option("--script", options->script,
                 "Phoneme script (table or TextGrid) to show with the curves");
  add_head_options(app, options->head);
  return [options] { return run(*options); };
}

}  // namespace

const Command kView{"view", "A page that shows the talking head: one HTML file for any browser",
                    "  animeme view talk.mp4 -o talk.html\n"
                    "  animeme view talk.fap --audio voice.wav --script voice.TextGrid --head man "
                    "-o talk.html\n"
                    "  animeme view original.fap coded.fba --audio voice.wav -o loss.html\n"
                    "The page needs no network; ? shows its keys.",
                    add};

}  // namespace animeme::tools
