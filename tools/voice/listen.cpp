#include "tools/voice/listen.h"

#include <algorithm>
#include <cmath>

#include "tools/voice/align.h"
#include "tools/voice/denoise.h"
#include "tools/voice/hearing.h"

namespace animeme::voice {

namespace {

constexpr double kLeastSeconds = 0.1;
constexpr double kLeastSpeech = 0.1;        // seconds; less is a click
constexpr double kUnsure = 0.25;            // of the whole: below, it may be no speech at all
constexpr std::size_t kBlockFrames = 2000;  // drawn at once
constexpr std::size_t kLookAhead = 100;     // frames beyond, which settle how a block ends
// Quiet frames tell the room, not the voice: the mean is that of the louder seven of ten.
constexpr double kQuiet = 0.3;
constexpr std::size_t kPeakBlock = 160;  // samples

// The peak that one block of ten is above: speech, not a click.
float loudness_of(const std::vector<float>& samples) {
  std::vector<float> peaks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % kPeakBlock == 0) peaks.push_back(0);
    peaks.back() = std::max(peaks.back(), std::abs(samples[i]));
  }
  const auto high = peaks.begin() + std::ptrdiff_t(0.9 * double(peaks.size() - 1));
  std::nth_element(peaks.begin(), high, peaks.end());
  return *high;
}

std::vector<Cepstrum> cepstra_of(CepstraReader& reader, const std::vector<float>& samples) {
  std::vector<std::int16_t> whole;
  Trace trace{loudness_of(samples), 0};
  to_whole(samples, trace, whole);
  std::vector<Cepstrum> frames;
  reader.push(whole, frames);
  reader.finish(frames);
  return frames;
}

Cepstrum mean_of(const std::vector<Cepstrum>& frames) {
  std::vector<float> levels;
  for (const Cepstrum& frame : frames) levels.push_back(frame[0]);
  const auto quiet = levels.begin() + std::ptrdiff_t(kQuiet * double(levels.size() - 1));
  std::nth_element(levels.begin(), quiet, levels.end());
  std::array<double, kCepstra> sums{};
  double count = 0;
  for (const Cepstrum& frame : frames) {
    if (frame[0] < *quiet) continue;
    ++count;
    for (std::size_t i = 0; i < kCepstra; ++i) sums[i] += double(frame[i]);
  }
  Cepstrum mean{};
  for (std::size_t i = 0; i < kCepstra; ++i) mean[i] = float(sums[i] / std::max(count, 1.0));
  return mean;
}

// All paths of the sound, block by block.
struct Drawn {
  std::vector<Path> readings;
  Path agreed;
  Votes votes;  // of the frames of `agreed`
};

Drawn draw_all(const HearingModel& model, const std::vector<Cepstrum>& frames,
               const ListenOptions& options) {
  const Cepstrum mean = mean_of(frames);
  PhonePaths paths(model.sound, model.pairs, model.weights);
  std::vector<float> scores(model.sound.states());
  Drawn all;
  all.readings.resize(options.readings);
  std::size_t begun = 0;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    score_states(model.sound, features_of(frames, frame, mean), scores);
    paths.push(scores);
    const bool last = frame + 1 == frames.size();
    if (!last && paths.frames() < begun + kBlockFrames + kLookAhead) continue;
    const std::size_t size = last ? paths.frames() - begun : kBlockFrames;
    std::vector<Path> drawn;
    for (std::size_t i = 0; i < options.readings; ++i) drawn.push_back(paths.draw(begun, i));
    Votes votes = count_votes(drawn, model.labels.size());
    Path agreed = agreed_path(model, votes);
    const auto append = [&](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.begin() + std::ptrdiff_t(size));
    };
    for (std::size_t i = 0; i < options.readings; ++i) append(all.readings[i], drawn[i]);
    append(all.agreed, agreed);
    append(all.votes, votes);
    begun += size;
    paths.forget(begun);
    if (options.progress) options.progress(double(begun) / double(frames.size()));
  }
  return all;
}

void sum_up(Heard& heard) {
  double seconds = 0, sum = 0;
  for (std::size_t i = 0; i < heard.script.phones.size(); ++i) {
    const dam::Phone& phone = heard.script.phones[i];
    if (phone.label == dam::kSilence) continue;
    seconds += phone.duration();
    sum += phone.duration() * heard.confidences[i];
  }
  if (seconds < kLeastSpeech) {
    heard.warnings.push_back("nothing was heard that could be speech; the face stays still");
    return;
  }
  heard.confidence = sum / seconds;
  if (heard.confidence < kUnsure) {
    heard.warnings.push_back("this may be no speech: the readings hardly agree");
  }
}

}  // namespace

Result<Heard> listen(const media::Pcm& audio, const ListenOptions& options) {
  if (audio.sample_rate != kAlignRate) {
    return make_error(Code::invalid_argument, "the audio must be at 16000 Hz; resample it first");
  }
  const double seconds = audio.duration();
  if (seconds < kLeastSeconds) {
    return make_error(Code::truncated, "less than 0.1 s of sound: there is nothing to hear");
  }
  if (seconds > kMostListenSeconds) {
    return make_error(Code::out_of_range, "more than four hours of sound; part it");
  }
  auto model = load_hearing(options);
  if (!model) return model.error();
  auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  const std::vector<Cepstrum> frames = cepstra_of(**reader, denoised(audio.samples));
  Heard heard;
  if (frames.empty()) return make_error(Code::truncated, "there is nothing to hear");
  const Drawn drawn = draw_all(*model, frames, options);
  heard.script =
      script_of_path(*model, drawn.agreed, 0, 0, seconds, &drawn.votes, &heard.confidences);
  for (const Path& path : drawn.readings) {
    heard.readings.push_back(script_of_path(*model, path, 0, 0, seconds));
  }
  sum_up(heard);
  return heard;
}

}  // namespace animeme::voice
