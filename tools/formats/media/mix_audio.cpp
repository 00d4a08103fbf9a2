#include "tools/formats/media/mix_audio.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/formats/media/audio.h"

namespace animeme::media {

namespace {

constexpr std::size_t kMixBlock = 4096;  // samples
constexpr int kMostMixRate = 48000;      // Hz
constexpr float kStraight = 0.8f;        // full scale up to which samples stay as they are

// Above kStraight it approaches 1 smoothly.
float limited(float sample) {
  const float size = std::abs(sample);
  if (!(size > kStraight)) return sample;
  const float room = 1 - kStraight;
  return std::copysign(kStraight + room * std::tanh((size - kStraight) / room), sample);
}

// One of the sounds, in blocks of any size.
class MixReader {
 public:
  static Result<MixReader> open(const MixPart& part, int sample_rate) {
    const TrackScope scope(part.labels);
    auto reader = AudioReader::open(part.path, {.sample_rate = sample_rate});
    if (!reader) return reader.error().in_file(part.path);
    return MixReader(std::move(*reader), part.path);
  }
  int sample_rate() const { return reader_.sample_rate(); }

  /// Adds its next samples; the number of them, 0 at its end.
  Result<std::size_t> add_to(std::span<float> sum) {
    std::size_t done = 0;
    while (done < sum.size()) {
      if (at_ == block_.size()) {
        auto next = reader_.next();
        if (!next) return next.error().in_file(path_);
        if (next->empty()) break;
        block_ = *next;
        at_ = 0;
      }
      const std::size_t count = std::min(sum.size() - done, block_.size() - at_);
      for (std::size_t i = 0; i < count; ++i) sum[done + i] += block_[at_ + i];
      done += count;
      at_ += count;
    }
    return done;
  }

 private:
  MixReader(AudioReader reader, std::string path)
      : reader_(std::move(reader)), path_(std::move(path)) {}

  AudioReader reader_;
  std::string path_;
  std::span<const float> block_;
  std::size_t at_ = 0;  // in it
};

}  // namespace

Result<void> mix_audio(const std::string& path, std::span<const MixPart> parts) {
  if (parts.empty()) return make_error(Code::invalid_argument, "there is no sound to mix");
  int rate = 0;
  for (const MixPart& part : parts) {
    const auto reader = MixReader::open(part, 0);
    if (!reader) return reader.error();
    rate = std::max(rate, std::min(reader->sample_rate(), kMostMixRate));
  }
  std::vector<MixReader> readers;
  for (const MixPart& part : parts) {
    auto reader = MixReader::open(part, rate);
    if (!reader) return reader.error();
    readers.push_back(std::move(*reader));
  }
  auto file = WavWriter::open(path, rate);
  if (!file) return file.error();
  std::vector<float> sum(kMixBlock);
  for (;;) {
    std::fill(sum.begin(), sum.end(), 0.0f);
    std::size_t longest = 0;
    for (MixReader& reader : readers) {
      const auto added = reader.add_to(sum);
      if (!added) return added.error();
      longest = std::max(longest, *added);
    }
    if (longest == 0) return file->finish();
    for (float& sample : sum) sample = limited(sample);
    if (auto done = file->write(std::span(sum).first(longest)); !done) return done;
  }
}

}  // namespace animeme::media
