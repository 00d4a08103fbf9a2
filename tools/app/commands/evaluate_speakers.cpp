#include "tools/app/commands/evaluate_speakers.h"

#include <cstdio>

#include "tools/formats/common/text.h"
#include "tools/formats/inspect/speakers.h"
#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

namespace {

Result<std::vector<std::size_t>> sizes_of(const std::vector<std::string>& texts) {
  std::vector<std::size_t> sizes;
  for (const std::string& text : texts) {
    const bool digits = !text.empty() && text.size() <= 6 &&
                        text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || std::stoul(text) == 0) {
      return make_error(
          Code::invalid_argument,
          "--sentences takes numbers of sentences, such as 5,10,20; not '" + text + "'");
    }
    sizes.push_back(std::stoul(text));
  }
  return sizes;
}

Result<dam::Corpus> read_part(CorpusSettings settings, const std::string& folder,
                              const dam::Model& model) {
  settings.folder = folder;
  for (const dam::Control& control : model.controls) settings.controls.push_back(control.name);
  return read_corpus(settings);
}

}  // namespace

Result<int> run_speakers(const EvaluateOptions& options) {
  inspect::SpeakersOptions compare;
  const auto sizes = sizes_of(options.sizes);
  if (!sizes) return usage_error(sizes.error().message);
  const Result<dam::Model> model = speech::read_model(options.system);
  if (!model) return model.error();
  const Result<dam::Corpus> corpus = read_part(options.corpus, options.speakers, *model);
  if (!corpus) return corpus.error();
  dam::Corpus others;
  if (!options.corpus.folder.empty()) {
    CorpusSettings settings = options.corpus;
    settings.split.clear();
    Result<dam::Corpus> read = read_part(settings, options.corpus.folder, *model);
    if (!read) return read.error();
    others = std::move(*read);
  }
  ProgressLine line("comparing");
  compare.base = &*model;
  compare.sizes = *sizes;
  compare.speakers = std::size_t(options.copies);
  compare.base_sentences = std::size_t(options.base_sentences);
  compare.evaluate = options.evaluate;
  compare.evaluate.synthesis.closure = !options.no_closure;
  compare.draws = options.draws;
  compare.others = others.utterances;
  compare.progress = [&](double done) {
    line.update(done);
    return true;
  };
  const auto report = inspect::compare_speakers(corpus->utterances, compare);
  line.clear();
  if (!report) return Error(report.error()).in_file(options.speakers);
  std::fputs(options.json ? (inspect::speakers_json(*report) + "\n").c_str()
                          : inspect::speakers_text(*report).c_str(),
             stdout);
  return kOk;
}

}  // namespace animeme::tools
