#include <algorithm>
#include <cmath>

#include "tools/formats/inspect/evaluation.h"

namespace animeme::inspect {

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

}  // namespace

Result<std::vector<dam::SentencePair>> pair_up(std::vector<dam::Utterance> tracks,
                                               const std::vector<dam::Utterance>& recorded,
                                               bool skip_missing) {
  std::vector<dam::SentencePair> pairs;
  for (const dam::Utterance& sentence : recorded) {
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const dam::Utterance& other) {
      return other.id == sentence.id;
    });
    if (track == tracks.end()) {
      if (skip_missing) continue;
      return make_error(Code::not_found, "there is no track of sentence '" + sentence.id + "'");
    }
    Result<dam::Signal> made = fit_length(std::move(track->signal), sentence);
    if (!made) return made.error();
    pairs.push_back({sentence, std::move(*made)});
  }
  return pairs;
}

Result<std::vector<dam::Control>> scale_of(const std::vector<dam::SentencePair>& pairs) {
  std::vector<const dam::Utterance*> recordings;
  for (const dam::SentencePair& pair : pairs) recordings.push_back(&pair.recorded);
  std::vector<dam::Control> scale = dam::recording_scale(recordings);
  std::erase_if(scale, [&](const dam::Control& control) {
    const auto& names = pairs[0].synthesised.names;
    return std::find(names.begin(), names.end(), control.name) == names.end();
  });
  if (!scale.empty()) return scale;
  return make_error(Code::not_found,
                    "the tracks have no control that the recordings have; "
                    "call FAP columns fapN_name, like fap3_open_jaw");
}

std::vector<dam::Glitch> leave_out_glitches(std::vector<dam::SentencePair>& pairs) {
  std::vector<const dam::Utterance*> recorded;
  for (const dam::SentencePair& pair : pairs) recorded.push_back(&pair.recorded);
  dam::CleanedSentences mended = dam::remove_glitches(recorded, dam::ShortGlitches::omit);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (mended.sentences[i] != &pairs[i].recorded) pairs[i].recorded = *mended.sentences[i];
  }
  return std::move(mended.glitches);
}

}  // namespace animeme::inspect
