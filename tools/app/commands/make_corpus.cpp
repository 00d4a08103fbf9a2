// From videos and transcripts to a corpus that `animeme train` reads.
#include <iostream>

#include "tools/app/commands/capture_options.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/script_options.h"
#include "tools/characters/capture/build_corpus.h"
#include "tools/characters/capture/corpus_report.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

struct MakeCorpusOptions {
  CorpusPlan plan;
  CaptureOptions capture;
  bool json = false;
};

Result<int> run(const MakeCorpusOptions& options) {
  CorpusPlan plan = options.plan;
  const Result<CaptureSettings> settings = capture_settings(options.capture);
  if (!settings) return usage_error(settings.error().describe());
  plan.capture = *settings;
  if (!plan.capture.landmarks.neutral.empty() && plan.neutral.from.empty()) {
    return usage_error("--neutral is a part of one recording; name it with --neutral-from");
  }
  const Interrupt interrupt;
  ProgressLine line("corpus");
  Log log;
  log.info = [&](const std::string& text) {
    line.clear();
    say(text);
  };
  log.warn = [&](const std::string& text) {
    if (Interrupt::requested()) return;  // of what was left unfinished
    line.clear();
    warn(text);
  };
  Progress progress;
  progress.at = [&](double share) { line.update(share); };
  progress.stop = [] { return Interrupt::requested(); };
  const Result<CorpusReport> report = build_corpus(plan, log, progress);
  line.clear();
  if (!report) {
    if (Interrupt::requested()) {
      say(report.error().message);
      return kInterrupted;
    }
    return report.error();
  }
  if (options.json) {
    std::cout << report_json(*report).dump(1) << "\n";
  } else {
    std::cout << report_text(*report);
  }
  return report->left_out.empty() ? kOk : kCheckFailed;
}

void add_options(OptionTable& cli, MakeCorpusOptions& options) {
  CorpusPlan& plan = options.plan;
  cli.add("videos", plan.places.captures,
          "Folder of videos of one person, or of tables that a tracker wrote (.csv, .tsv, "
          ".json), or one such file. Tables take precedence over videos of the same name")
      ->required();
  cli.add("transcripts", plan.places.transcripts,
          "Texts: a folder of NAME.txt or .lab, or of timed scripts (NAME.TextGrid and "
          "others), or a table of names and texts (tabs, | or commas); for a single video "
          "its .txt, .srt, .vtt or .TextGrid")
      ->required();
  cli.add("-o,--output", plan.output, "Folder of the corpus; an existing corpus is continued")
      ->output("", OutputKind::folder)
      ->required();
  cli.add("--audio", plan.places.audio,
          "Folder of the sounds; default: those beside the captures, or in the videos");
  cli.add("--lang", plan.language, "Language of the transcripts")->show_default();
  add_script_options(cli, plan.script_reading);
  cli.add("--folds", plan.folds,
          "Number of folds for cross-validation; fold 1 is `test` in the column split")
      ->between(2, 100)
      ->show_default();
  cli.add("--cut", plan.longest,
          "Split recordings that are longer than so many seconds into sentences, at their "
          "pauses; 0: never")
      ->between(0.0, 600.0)
      ->show_default();
  cli.add("--strict", plan.strict, "Leave out doubtful sentences");
  cli.add("--track-again", plan.track_again, "Track all videos again");
  add_capture_options(cli, options.capture);
  add_neutral_options(cli, plan.neutral);
  cli.add("--json", options.json, "Print a machine-readable report");
}

}  // namespace

const Command kCorpus{
    "corpus", "Make a training corpus from videos and their transcripts",
    "  animeme corpus videos/ texts/ -o me --tracker \"track {in} {out}\"\n"
    "  animeme corpus videos/ lines.tsv -o me        (ANIMEME_TRACKER names the tracker)\n"
    "  animeme corpus ten_minutes.mp4 ten_minutes.txt -o me --tracker \"track {in} {out}\"\n"
    "  animeme corpus tables/ textgrids/ -o me --audio wavs/\n"
    "  animeme corpus more/ texts/ -o me2 --face-file me/neutral.face\n"
    "  animeme train me --split train -o me.dam",
    set_up<MakeCorpusOptions>};

}  // namespace animeme::tools
