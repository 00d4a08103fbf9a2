#include "tools/speech/talking/other_voice.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace animeme::speech {

namespace {

constexpr double kBlock = 0.01;   // seconds of a level
constexpr double kHum = 90;       // Hz: what lies below is no voice
constexpr double kLeastDb = -58;  // of full scale: what is softer is no speech anywhere
constexpr double kSilentDb = -75;
constexpr double kUsualNoise = -55;  // dB, before anything is known
constexpr double kAbove = 9;         // dB above the noise where speech begins
constexpr double kStays = 4;         // and where it ends
// The noise is learned fast where it falls, and slowly where it rises: vowels last, noise stays.
constexpr double kFalls = 0.3;                      // share of the way, a block
constexpr double kRises = 2.5, kRisesAtFirst = 10;  // dB a second
constexpr double kFirst = 1.0;                      // seconds
constexpr double kOnset = 0.05, kPause = 0.2;       // seconds
constexpr double kCatchUp = 1.02;  // a clock that runs faster than ours does not fall behind
constexpr double kNoSound = 0.2;   // seconds without sound that are a pause
constexpr double kLongest = 1.0;   // seconds at a time: what comes later than that is skipped

}  // namespace

VoiceActivity::VoiceActivity(int sample_rate)
    : rate_(sample_rate), left_(kBlock * sample_rate), noise_(kUsualNoise) {}

void VoiceActivity::add_block(double mean_square) {
  const double level = std::max(10 * std::log10(mean_square + 1e-12), kSilentDb);
  seconds_ += kBlock;
  if (level < noise_)
    noise_ += kFalls * (level - noise_);
  else
    noise_ += std::min((seconds_ < kFirst ? kRisesAtFirst : kRises) * kBlock, level - noise_);
  const double threshold = std::max(noise_ + (speaking_ ? kStays : kAbove), kLeastDb);
  const bool loud = level > threshold;
  loud_ = loud ? loud_ + kBlock : 0;
  quiet_ = loud ? 0 : quiet_ + kBlock;
  if (!speaking_ && loud_ >= kOnset - 1e-9) speaking_ = true;
  if (speaking_ && quiet_ >= kPause - 1e-9) speaking_ = false;
}

void VoiceActivity::push(std::span<const float> samples) {
  const double keep = std::exp(-2 * std::numbers::pi * kHum / rate_);
  const double block = kBlock * rate_;
  for (const float sample : samples) {
    const double in = std::isfinite(sample) ? double(sample) : 0;
    last_out_ = keep * (last_out_ + in - last_in_);
    last_in_ = in;
    sum_ += last_out_ * last_out_;
    if (--left_ > 0) continue;
    left_ += block;
    add_block(sum_ / block);
    sum_ = 0;
  }
}

struct OtherVoice::Impl {
  int descriptor = -1;        // if it is ours
  SoundPipe* pipe = nullptr;  // `feed`, if its rate is not known yet
  std::unique_ptr<SoundFeed> feed;
  int rate = 0;
  bool in_time = false;
  std::optional<VoiceActivity> activity;
  std::optional<double> last;  // time of the last call
  double owed = 0;             // samples, whose time has come
  double missed = 0;           // seconds without sound

  ~Impl() {
    feed.reset();
    if (descriptor >= 0) ::close(descriptor);
  }
  void listen(double seconds);
};

void OtherVoice::Impl::listen(double seconds) {
  owed += std::min(seconds, kLongest) * rate * (in_time ? kCatchUp : 1);
  const auto wanted = std::size_t(owed);
  const std::vector<float> samples = feed->take(wanted);
  activity->push(samples);
  owed -= double(in_time ? wanted : samples.size());
  owed = std::min(owed, kLongest * rate);
  missed = samples.empty() ? missed + seconds : 0;
  if (missed < kNoSound && !feed->over()) return;
  const std::vector<float> silence(std::size_t(std::min(seconds, kLongest) * rate), 0.0f);
  if (samples.empty()) activity->push(silence);
}

OtherVoice::OtherVoice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OtherVoice::~OtherVoice() = default;

OtherVoice::OtherVoice(std::unique_ptr<SoundFeed> feed, int rate, bool in_time)
    : impl_(std::make_unique<Impl>()) {
  impl_->feed = std::move(feed);
  impl_->rate = rate;
  impl_->in_time = in_time;
}

Result<std::unique_ptr<OtherVoice>> OtherVoice::open(const std::string& path,
                                                     std::optional<BareSound> bare) {
  auto impl = std::make_unique<Impl>();
  int descriptor = STDIN_FILENO;
  struct stat about {};
  if (path != "-") {
    if (::stat(path.c_str(), &about) != 0)
      return make_error(Code::not_found, "there is no such sound to hear").in_file(path);
    // A named pipe that is open for writing, too, neither waits for its first writer nor ends with
    // one.
    const bool named_pipe = S_ISFIFO(about.st_mode);
    descriptor = ::open(path.c_str(), (named_pipe ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    if (descriptor < 0)
      return make_error(Code::io, "the sound to hear cannot be opened").in_file(path);
    impl->descriptor = descriptor;
  }
  if (::fstat(descriptor, &about) != 0)
    return make_error(Code::io, "the sound to hear cannot be read").in_file(path);
  if (S_ISDIR(about.st_mode))
    return make_error(Code::io, "the sound to hear is a folder").in_file(path);
  impl->in_time = !S_ISREG(about.st_mode);
  auto pipe = std::make_unique<SoundPipe>(descriptor, bare);
  impl->pipe = pipe.get();
  impl->feed = std::move(pipe);
  return std::unique_ptr<OtherVoice>(new OtherVoice(std::move(impl)));
}

bool OtherVoice::at(double seconds) {
  Impl& impl = *impl_;
  const double passed = impl.last ? std::max(seconds - *impl.last, 0.0) : 0;
  const bool first = !impl.last;
  impl.last = seconds;
  if (impl.rate == 0 && impl.pipe != nullptr) impl.rate = impl.pipe->rate_so_far();
  if (impl.rate <= 0) return false;
  if (!impl.activity) impl.activity.emplace(impl.rate);
  if (first && impl.in_time) impl.feed->take(std::numeric_limits<std::size_t>::max());
  impl.listen(passed);
  return impl.activity->speaking();
}

std::optional<Error> OtherVoice::take_error() { return impl_->feed->take_error(); }

}  // namespace animeme::speech
