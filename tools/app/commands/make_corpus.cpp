// From videos and transcripts to a corpus that `animeme train` reads.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "tools/app/commands/bounds.h"
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
    return usage_error("--neutral is a part of one recording; --neutral-from says of which");
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

void add_options(CLI::App& app, MakeCorpusOptions& options) {
  CorpusPlan& plan = options.plan;
  app.add_option("videos", plan.places.captures,
                 "Folder of videos of one person, or of tables that a tracker wrote (.csv, .tsv, "
                 ".json), or one of them. A table counts before a video of the same name")
      ->required();
  app.add_option(
         "transcripts", plan.places.transcripts,
         "What is said: a folder of NAME.txt or .lab, or of scripts that are timed already "
         "(NAME.TextGrid and others), or a table of names and texts (tabs, | or commas); of "
         "one video its .txt, .srt, .vtt or .TextGrid")
      ->required();
  add_output(app.add_option("-o,--output", plan.output,
                            "Folder of the corpus; an earlier one is gone on with"),
             {}, OutputKind::folder)
      ->required();
  app.add_option("--audio", plan.places.audio,
                 "Folder of the sounds; without it those beside the captures, or in the videos");
  app.add_option("--lang", plan.language, "Language of the transcripts")->capture_default_str();
  add_script_options(app, plan.script_reading);
  app.add_option("--folds", plan.folds, "Parts to test on; part 1 is `test` in the column split")
      ->check(between(2, 100))
      ->capture_default_str();
  app.add_option("--cut", plan.longest,
                 "Recordings of more seconds than this become sentences, cut at their pauses; 0: "
                 "no cutting")
      ->check(between(0.0, 600.0))
      ->capture_default_str();
  app.add_flag("--strict", plan.strict, "Leave doubtful sentences out");
  app.add_flag("--track-again", plan.track_again, "Track videos that were tracked before, too");
  add_capture_options(app, options.capture);
  add_neutral_options(app, plan.neutral);
  app.add_flag("--json", options.json, "Machine-readable report on standard output");
}

}  // namespace

const Command kCorpus{
    "corpus", "Make a corpus to train on from videos and what is said in them",
    "  animeme corpus videos/ texts/ -o me --tracker \"track {in} {out}\"\n"
    "  animeme corpus videos/ lines.tsv -o me        (ANIMEME_TRACKER names the tracker)\n"
    "  animeme corpus ten_minutes.mp4 ten_minutes.txt -o me --tracker \"track {in} {out}\"\n"
    "  animeme corpus tables/ textgrids/ -o me --audio wavs/\n"
    "  animeme corpus more/ texts/ -o me2 --face-file me/neutral.face\n"
    "  animeme train me --split train -o me.dam",
    set_up<MakeCorpusOptions>};

}  // namespace animeme::tools
