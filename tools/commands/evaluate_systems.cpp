#include <algorithm>
#include <cmath>

#include "dam/speaking/synthesise.h"
#include "tools/commands/evaluate_report.h"

namespace animeme::tools {

namespace {

constexpr double kLongestMismatch = 0.5;  // seconds

// As many frames as the recording has.
Result<dam::Signal> fit_length(dam::Signal made, const dam::Utterance& recorded) {
  const std::size_t frames = recorded.signal.frames();
  const double gap = std::abs(double(made.frames()) - double(frames));
  if (made.frames() == 0 || made.rate.seconds(gap) > kLongestMismatch) {
    return make_error(Code::out_of_range, "the track of sentence '" + recorded.id + "' has " +
                                              std::to_string(made.frames()) +
                                              " frames, its recording " + std::to_string(frames) +
                                              "; make it as long as the recording");
  }
  const std::vector<double> last(made.values.end() - std::ptrdiff_t(made.names.size()),
                                 made.values.end());
  while (made.frames() < frames) {
    made.values.insert(made.values.end(), last.begin(), last.end());
  }
  made.values.resize(frames * made.names.size());
  return made;
}

Result<std::vector<dam::SentencePair>> track_pairs(const System& system,
                                                   const CorpusSettings& corpus,
                                                   const std::vector<dam::Utterance>& recorded) {
  CorpusSettings settings = corpus;
  settings.controls.clear();
  settings.controls_folder = std::filesystem::absolute(system.path).string();
  Result<dam::Corpus> tracks = read_corpus(settings);
  if (!tracks) return tracks.error();
  std::vector<dam::SentencePair> pairs;
  for (const dam::Utterance& sentence : recorded) {
    const auto track =
        std::find_if(tracks->utterances.begin(), tracks->utterances.end(),
                     [&](const dam::Utterance& other) { return other.id == sentence.id; });
    if (track == tracks->utterances.end()) {
      if (corpus.skip_missing) continue;
      return make_error(Code::not_found, "there is no track of sentence '" + sentence.id + "'")
          .in_file(system.path);
    }
    Result<dam::Signal> made = fit_length(std::move(track->signal), sentence);
    if (!made) return made.error().in_file(system.path);
    pairs.push_back({sentence, std::move(*made)});
  }
  return pairs;
}

}  // namespace

Result<System> open_system(const std::string& path, bool tracks) {
  std::error_code ignored;
  if (tracks || std::filesystem::is_directory(path, ignored)) return System{path, std::nullopt};
  Result<dam::Model> model = read_model_or_builtin(path);
  if (!model) return model.error();
  return System{path, std::move(*model)};
}

Result<std::vector<dam::SentencePair>> pairs_of(const System& system, const CorpusSettings& corpus,
                                                const std::vector<dam::Utterance>& recorded,
                                                const dam::EvaluateOptions& options) {
  if (!system.model) return track_pairs(system, corpus, recorded);
  return dam::synthesise_pairs(*system.model, recorded, options);
}

Result<std::vector<dam::Control>> scale_of(const System& system,
                                           const std::vector<dam::SentencePair>& pairs) {
  if (system.model) return system.model->controls;
  std::vector<const dam::Utterance*> recordings;
  for (const dam::SentencePair& pair : pairs) recordings.push_back(&pair.recorded);
  std::vector<dam::Control> scale = dam::recording_scale(recordings);
  std::erase_if(scale, [&](const dam::Control& control) {
    const auto& names = pairs[0].made.names;
    return std::find(names.begin(), names.end(), control.name) == names.end();
  });
  if (scale.empty()) {
    return make_error(Code::not_found,
                      "the tracks have no control that the recordings have; "
                      "call FAP columns fapN_name, like fap3_open_jaw")
        .in_file(system.path);
  }
  return scale;
}

}  // namespace animeme::tools
