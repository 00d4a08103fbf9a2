#include "tools/speech/voice/listen_stream.h"

#include <algorithm>
#include <cmath>

#include "tools/speech/voice/hearing.h"
#include "tools/speech/voice/rate_change.h"

namespace animeme::voice {

namespace {

// The cepstral mean follows the voice: what it is at first counts as so many frames, and what lies
// behind fades within as many.
constexpr double kFirstFrames = 100, kMostFrames = 1000;
// A frame is speech if its level is in the upper part of the last seconds.
constexpr float kLoudPart = 0.35f;
constexpr float kForgetLevel = 0.002f;  // a frame, of the distance of the levels
// Before anything is heard: the mean of GRID and of espeak-ng's voices lies about there, and so
// does that of the recordings that the model is made from (its feat.params).
constexpr Cepstrum kFirstMean{41.0f,  -5.29f, -0.12f, 5.09f,  2.48f,  -4.07f, -1.37f,
                              -1.78f, -5.08f, -2.05f, -6.45f, -1.42f, 1.17f};

class Listener : public SoundListener {
 public:
  Listener(std::shared_ptr<const HearingModel> model, std::unique_ptr<CepstraReader> reader,
           std::unique_ptr<RateChange> rate, std::size_t readings)
      : model_(std::move(model)),
        reader_(std::move(reader)),
        rate_(std::move(rate)),
        readings_(readings),
        paths_(model_->sound, model_->pairs, model_->weights),
        scores_(model_->sound.states()) {}

  void push(std::span<const float> samples) override {
    clean_.assign(samples.begin(), samples.end());
    for (float& one : clean_) one = std::isfinite(one) ? std::clamp(one, -1.0f, 1.0f) : 0.0f;
    changed_.clear();
    rate_->push(clean_, changed_);
    whole_.clear();
    to_whole(changed_, trace_, whole_);
    new_.clear();
    reader_->push(whole_, new_);
    for (const Cepstrum& frame : new_) {  // one by one, so that it does not matter how many came
      frames_.push_back(frame);
      follow(frame);
      if (next_ + kFeatureReach >= frames_.size()) continue;
      Cepstrum mean;
      for (std::size_t i = 0; i < kCepstra; ++i) mean[i] = float(sums_[i] / count_);
      score_states(model_->sound, features_of(frames_, next_, mean), scores_);
      paths_.push(scores_);
      ++next_;
    }
    if (next_ > 2 * kFeatureReach) {  // no more than features look back
      const std::size_t old = next_ - kFeatureReach;
      frames_.erase(frames_.begin(), frames_.begin() + std::ptrdiff_t(old));
      next_ -= old;
    }
  }

  double heard() const override { return double(paths_.frames()) * 0.01; }

  Recognition hear(double from) const override {
    Recognition heard;
    const auto wanted = std::size_t(std::max(from, 0.0) * 100);
    const std::size_t first = std::max(wanted > 2 ? wanted - 2 : 0, paths_.first());
    const double length = this->heard() - from;
    if (length <= 0 || paths_.frames() <= first) return heard;
    std::vector<Path> drawn;
    for (std::size_t i = 0; i < readings_; ++i) drawn.push_back(paths_.draw(first, i));
    const Votes votes = count_votes(drawn, model_->labels.size());
    heard.script = script_of_path(*model_, agreed_path(*model_, votes, kLeastClosureLive), first,
                                  from, length, &votes, &heard.confidences);
    for (const Path& path : drawn) {
      heard.readings.push_back(script_of_path(*model_, path, first, from, length));
    }
    return heard;
  }

  void forget(double before) override {
    const auto frame = std::size_t(std::max(before, 0.0) * 100);
    if (frame > 4) paths_.forget(frame - 4);
  }

 private:
  void follow(const Cepstrum& frame) {
    if (count_ == 0) {
      count_ = kFirstFrames;
      for (std::size_t i = 0; i < kCepstra; ++i) sums_[i] = count_ * double(kFirstMean[i]);
      highest_ = lowest_ = frame[0];
    }
    const float spread = highest_ - lowest_;
    highest_ = std::max(highest_ - kForgetLevel * spread, frame[0]);
    lowest_ = std::min(lowest_ + kForgetLevel * spread, frame[0]);
    if (frame[0] < lowest_ + kLoudPart * (highest_ - lowest_)) return;
    if (count_ >= kMostFrames) {
      for (double& sum : sums_) sum *= 1 - 1 / kMostFrames;
      count_ -= count_ / kMostFrames;
    }
    count_ += 1;
    for (std::size_t i = 0; i < kCepstra; ++i) sums_[i] += double(frame[i]);
  }

  std::shared_ptr<const HearingModel> model_;
  std::unique_ptr<CepstraReader> reader_;
  std::unique_ptr<RateChange> rate_;
  std::size_t readings_;
  PhonePaths paths_;
  std::vector<float> scores_, clean_, changed_;
  std::vector<std::int16_t> whole_;
  std::vector<Cepstrum> new_, frames_;  // of a piece; the last ones
  Trace trace_;
  std::size_t next_ = 0;  // of frames_: the first that is not scored
  std::array<double, kCepstra> sums_{};
  double count_ = 0;
  float highest_ = 0, lowest_ = 0;
};

}  // namespace

Result<std::unique_ptr<SoundListener>> SoundListener::open(int rate, const ListenOptions& options) {
  auto change = RateChange::open(rate);
  if (!change) return change.error();
  auto model = shared_hearing(options);
  if (!model) return model.error();
  auto reader = CepstraReader::open(options.model_path);
  if (!reader) return reader.error();
  std::unique_ptr<SoundListener> listener = std::make_unique<Listener>(
      std::move(*model), std::move(*reader), std::move(*change), options.readings);
  return listener;
}

}  // namespace animeme::voice
