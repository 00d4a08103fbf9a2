#include "tools/speech/talking/voice_driven_face.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dam/speaking/readings.h"
#include "tools/speech/voice/listen_stream.h"

namespace animeme::speech {

namespace {

constexpr double kLeastDelay = 0.08, kMostDelay = 2;
constexpr double kReach = 0.8;      // seconds of speech behind a frame that still shape it
constexpr double kLipReach = 0.24;  // seconds about a frame in which a closure may lie
constexpr double kSettle = 0.1;     // seconds of silence by which the ears come to the end
constexpr std::size_t kReadings = 16;
constexpr int kBlocks = 100;    // a second: frames are looked for between them
constexpr double kKept = 0.25;  // of the last frame: readings that change must not twitch

class Follower : public VoiceDrivenFace {
 public:
  Follower(const dam::Model& model, int sample_rate, const VoiceDrivenFaceOptions& options,
           std::unique_ptr<voice::SoundListener> listener)
      : model_(&model), rate_(sample_rate), options_(options), listener_(std::move(listener)) {
    options_.synthesis.tongue = false;  // phones that are only probable do not show on it
    for (const dam::Control& control : model.controls) names_.push_back(control.name);
  }

  void push(std::span<const float> samples) override {
    waiting_.insert(waiting_.end(), samples.begin(), samples.end());
  }

  Result<dam::Signal> pull() override {
    dam::Signal made = nothing();
    std::size_t at = 0;
    // Block by block, so that frames do not depend on how many samples came at once.
    const std::size_t block = std::size_t(rate_) / kBlocks;
    while (waiting_.size() - at >= block) {
      hear(std::span(waiting_).subspan(at, block));
      at += block;
      if (auto ok = make_until(seconds_ - options_.delay, made); !ok) return ok.error();
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + std::ptrdiff_t(at));
    return made;
  }

  Result<dam::Signal> finish() override {
    auto made = pull();
    if (!made) return made;
    hear(waiting_);
    waiting_.clear();
    const double end = seconds_;
    hear(std::vector<float>(std::size_t(kSettle * rate_), 0.0f));
    if (auto ok = make_until(end - 1e-9, *made); !ok) return ok.error();
    return made;
  }

 private:
  dam::Signal nothing() const {
    dam::Signal signal;
    signal.rate = options_.synthesis.rate;
    signal.names = names_;
    signal.first_frame = next_;
    return signal;
  }

  void hear(std::span<const float> samples) {
    listener_->push(samples);
    seconds_ += double(samples.size()) / rate_;
  }

  // Frames before `until` seconds of sound. Those that fall due at once are made by one look.
  Result<void> make_until(double until, dam::Signal& made) {
    const double a_second = options_.synthesis.rate.frames_per_second();
    const auto lips = std::size_t(std::ceil(kLipReach * a_second));
    const auto reach = std::size_t(std::ceil(kReach * a_second));
    while (double(next_) / a_second <= until) {
      const std::size_t from = next_ > reach ? next_ - reach : 0;
      const voice::Recognition heard = listener_->hear(double(from) / a_second);
      if (heard.readings.empty()) return {};
      const std::size_t first = next_ - from > lips ? next_ - from - lips : 0;
      const std::size_t wanted = next_ - from - first;  // row of the frame
      auto some = dam::synthesise_readings(*model_, heard.readings, heard.script,
                                           options_.synthesis, {first, wanted + 1 + lips});
      if (!some) return some.error();
      std::vector<double> row(some->values.begin() + std::ptrdiff_t(wanted * names_.size()),
                              some->values.begin() + std::ptrdiff_t((wanted + 1) * names_.size()));
      for (std::size_t c = 0; c < row.size() && !last_.empty(); ++c) {
        row[c] += kKept * (last_[c] - row[c]);
      }
      made.values.insert(made.values.end(), row.begin(), row.end());
      last_ = std::move(row);
      ++next_;
      listener_->forget(double(next_) / a_second - kReach - 0.1);
    }
    return {};
  }

  const dam::Model* model_;
  double rate_;
  VoiceDrivenFaceOptions options_;
  std::unique_ptr<voice::SoundListener> listener_;
  std::vector<std::string> names_;
  std::vector<float> waiting_;
  std::vector<double> last_;
  double seconds_ = 0;
  std::size_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<VoiceDrivenFace>> VoiceDrivenFace::open(
    const dam::Model& model, int sample_rate, const VoiceDrivenFaceOptions& options) {
  if (!(options.delay >= kLeastDelay && options.delay <= kMostDelay)) {
    return make_error(Code::invalid_argument, "the delay must be between 0.08 and 2 s");
  }
  if (auto ok = dam::validate(options.synthesis); !ok) return ok.error();
  voice::ListenOptions listening;
  listening.language = options.language;
  listening.readings = kReadings;
  auto listener = voice::SoundListener::open(sample_rate, listening);
  if (!listener) return listener.error();
  std::unique_ptr<VoiceDrivenFace> face =
      std::make_unique<Follower>(model, sample_rate, options, std::move(*listener));
  return face;
}

}  // namespace animeme::speech
