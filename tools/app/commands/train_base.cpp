#include "tools/app/commands/train_base.h"

#include <cstdio>
#include <filesystem>

#include "dam/training/adapt.h"
#include "tools/formats/inspect/adaptation.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

namespace {

// A corpus as a base may have other controls than the own one: FAPs, where those are shapes.
Result<dam::Model> base_of_corpus(const std::string& folder, const CorpusSettings& like,
                                  const dam::TrainOptions& train) {
  CorpusSettings settings;
  settings.folder = folder;
  settings.skip_missing = like.skip_missing;
  std::error_code none;
  if (std::filesystem::is_directory(std::filesystem::path(folder) / like.controls_folder, none)) {
    settings.controls_folder = like.controls_folder;
    settings.controls = like.controls;
  }
  const Result<dam::Corpus> corpus = read_corpus(settings);
  if (!corpus) return corpus.error();
  ProgressLine line("training the base");
  const auto progress = [&line](const dam::Progress& now) {
    line.update(now.done, now.stage);
    return true;
  };
  dam::TrainOptions options = train;
  options.attribution.clear();
  options.provenance = "method dam, " + std::to_string(corpus->utterances.size()) + " utterances";
  Result<dam::Model> model = dam::train(corpus->utterances, options, nullptr, progress);
  if (!model) return std::move(model).error().in_file(folder);
  return model;
}

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const dam::Method method : dam::methods()) names.emplace_back(dam::method_name(method));
  return names;
}

Result<dam::Model> load_base(const std::string& base, const CorpusSettings& like,
                             const dam::TrainOptions& train) {
  std::error_code none;
  if (std::filesystem::is_directory(base, none)) return base_of_corpus(base, like, train);
  return speech::read_model(base);
}

Result<int> train_on_base(const std::string& base, const CorpusSettings& corpus,
                          const std::string& output, const dam::TrainOptions& train, bool json) {
  const Result<dam::Corpus> own = read_corpus(corpus);
  if (!own) return own.error();
  const Result<dam::Model> model_of_base = load_base(base, corpus, train);
  if (!model_of_base) return model_of_base.error();
  dam::TrainOptions options = train;
  options.provenance = "animeme " ANIMEME_VERSION ", adapted, " +
                       std::to_string(own->utterances.size()) + " utterances";
  dam::AdaptReport report;
  ProgressLine line("adapting");
  const auto progress = [&line](const dam::Progress& now) {
    line.update(now.done);
    return true;
  };
  Result<dam::Model> model =
      dam::adapt(*model_of_base, own->utterances, options, &report, progress);
  line.clear();
  if (!model) return model.error().in_file(corpus.folder);
  if (auto done = set_limits(corpus, *model); !done) return done.error();
  if (auto done = write_file(output, dam::write_model(*model)); !done) return done.error();
  for (const std::string& text : report.warnings) warn(text);
  if (json) {
    std::printf("%s\n",
                inspect::adaptation_json(output, base, *model, report, own->left_out).c_str());
  } else {
    say(inspect::adaptation_text(output, base, *model, report));
  }
  return kOk;
}

}  // namespace animeme::tools
