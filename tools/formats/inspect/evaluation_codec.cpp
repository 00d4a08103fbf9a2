#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "dam/signal/fap_signal.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/inspect/evaluation.h"

namespace animeme::inspect {

namespace {

// What a receiver shows, in as many frames as went in.
Result<dam::Signal> decoded_signal(const std::vector<std::uint8_t>& stream, std::size_t frames) {
  Result<fba::DecodedStream> decoded = fba::decode(stream);
  if (!decoded) return decoded.error();
  Result<fap::Sequence> shown = fba::fill(*decoded, {.complete = true});
  if (!shown) return shown.error();
  Result<dam::Signal> signal = dam::to_signal(*shown);
  if (!signal) return signal.error();
  if (signal->frames() != frames) {
    return make_error(Code::internal, "the decoded stream has " + std::to_string(signal->frames()) +
                                          " frames, " + std::to_string(frames) + " were coded");
  }
  return signal;
}

// FAP by its number: a corpus may call it otherwise than the tables do.
void rename(dam::Signal& signal, const dam::Signal& like) {
  for (std::string& name : signal.names) {
    for (const std::string& other : like.names) {
      if (dam::fap_of_channel(other) == dam::fap_of_channel(name)) name = other;
    }
  }
}

}  // namespace

Result<CodecScore> score_codec(const std::vector<dam::SentencePair>& pairs,
                               const fba::EncodeOptions& coding, const dam::ScoreOptions& scoring,
                               const std::function<void(double)>& progress) {
  CodecScore score;
  double seconds = 0;
  std::vector<dam::SentencePair> coded, total;
  for (const dam::SentencePair& pair : pairs) {
    if (progress) progress(double(coded.size()) / double(pairs.size()));
    Result<fap::Sequence> clip = dam::to_sequence(pair.synthesised);
    if (!clip) return clip.error();
    Result<std::vector<std::uint8_t>> stream = fba::encode(*clip, coding);
    if (!stream) return stream.error();
    Result<dam::Signal> shown = decoded_signal(*stream, pair.synthesised.frames());
    if (!shown) return shown.error();
    rename(*shown, pair.synthesised);
    score.bytes += stream->size();
    seconds += clip->duration();
    dam::Utterance before = pair.recorded;
    before.signal = pair.synthesised;
    before.signal.measured = pair.recorded.signal.measured;
    coded.push_back({std::move(before), *shown});
    total.push_back({pair.recorded, std::move(*shown)});
  }
  score.kbps = tools::kbit_per_s(score.bytes, seconds);
  dam::ScoreOptions options = scoring;
  std::erase_if(options.scale, [](const dam::Control& control) {
    return dam::fap_of_channel(control.name) < fap::kFirstLowLevel;
  });
  Result<dam::Evaluation> error = dam::score(coded, options);
  if (!error) return error.error();
  Result<dam::Evaluation> both = dam::score(total, options);
  if (!both) return both.error();
  score.error = std::move(*error);
  score.total = std::move(*both);
  return score;
}

}  // namespace animeme::inspect
