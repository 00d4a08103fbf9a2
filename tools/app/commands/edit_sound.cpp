#include "tools/app/commands/edit_sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/stretch.h"

namespace animeme::tools {
namespace {

constexpr double kShortest = 0.005;  // seconds; less of a word is left out

double seconds_of(const EditCut& cut) {
  return cut.source->rate.seconds(double(cut.end - cut.first));
}

// Where a cut begins on the clock of its sound.
double sound_begin(const EditCut& cut) {
  return cut.source->origin + cut.source->rate.seconds(double(cut.first));
}

bool is_whole(const std::vector<EditCut>& cuts) {
  if (cuts.size() != 1) return false;
  const EditCut& cut = cuts.front();
  return cut.first == 0 && cut.end >= cut.source->frames && cut.source->origin == 0;
}

class SoundWriter {
 public:
  SoundWriter(media::AudioEncoder encoder, int sample_rate, int channels, double speed)
      : encoder_(std::move(encoder)), rate_(sample_rate), channels_(channels), speed_(speed) {
    sound_.format = encoder_.format();
    if (speed != 1) stretch_.emplace(sample_rate, channels, speed);
  }

  // A cut that ends `end` seconds behind the beginning of all.
  Result<void> add(const EditCut& cut, double end, bool last) {
    const std::int64_t until = std::llround(end * rate_);
    if (cut.source->sound) {
      if (auto ok = add_sound(cut, until); !ok) return ok;
      if (last && cut.end >= cut.source->frames) return {};  // it may end within the last frame
    }
    return add_silence(until - written_);
  }

  Result<media::EncodedAudio> finish() {
    if (stretch_) {
      stretched_.clear();
      stretch_->finish(stretched_);
      if (auto ok = encode(stretched_); !ok) return ok.error();
    }
    auto packets = encoder_.finish();
    if (!packets) return packets.error();
    keep(std::move(*packets));
    const auto samples = speed_ == 1 ? written_ : std::llround(double(written_) / speed_);
    sound_.length = samples * sound_.format.sample_rate / rate_;
    return std::move(sound_);
  }

 private:
  Result<void> add_sound(const EditCut& cut, std::int64_t until) {
    const std::int64_t begin = std::llround(sound_begin(cut) * rate_);  // of the sound's samples
    if (begin < 0) {
      if (auto ok = add_silence(std::min(-begin, until - written_)); !ok) return ok;
    }
    if (auto ok = open(*cut.source, begin); !ok) return ok.error().in_file(cut.source->path);
    const auto channels = std::size_t(reader_->channels());
    while (written_ < until) {
      if (block_.empty()) {
        const auto next = reader_->next();
        if (!next) return next.error().in_file(cut.source->path);
        if (next->empty()) break;
        block_ = *next;
      }
      const auto count = std::int64_t(block_.size() / channels);
      const std::int64_t left_out = std::clamp<std::int64_t>(begin - position_, 0, count);
      const std::int64_t used = std::min(count - left_out, until - written_);
      const auto part =
          block_.subspan(std::size_t(left_out) * channels, std::size_t(used) * channels);
      position_ += left_out + used;
      block_ = block_.subspan(std::size_t(left_out + used) * channels);
      if (auto ok = push(part, int(channels)); !ok) return ok;
    }
    for (const std::string& text : odd_) warn(cut.source->path + ": " + text);
    odd_.clear();
    return {};
  }

  // Pieces of a source that follow each other are read in one go.
  Result<void> open(const EditSource& source, std::int64_t begin) {
    if (open_ == &source && begin >= position_) return {};
    media::ReadAudioOptions options;
    options.sample_rate = rate_;
    options.most_channels = 2;
    options.warnings = &odd_;
    auto reader = media::AudioReader::open(source.path, options);
    if (!reader) return reader.error();
    reader_ = std::move(*reader);
    open_ = &source;
    position_ = 0;
    block_ = {};
    return {};
  }

  Result<void> add_silence(std::int64_t samples) {
    static constexpr std::array<float, 4096> kSilence{};
    while (samples > 0) {
      const auto now = std::min<std::int64_t>(samples, kSilence.size());
      if (auto ok = push(std::span(kSilence).first(std::size_t(now)), 1); !ok) return ok;
      samples -= now;
    }
    return {};
  }

  Result<void> push(std::span<const float> samples, int channels) {
    written_ += std::int64_t(samples.size()) / channels;
    if (channels < channels_) {
      both_.clear();
      for (const float sample : samples) both_.insert(both_.end(), {sample, sample});
      samples = both_;
    }
    if (!stretch_) return encode(samples);
    stretched_.clear();
    stretch_->push(samples, stretched_);
    return encode(stretched_);
  }

  Result<void> encode(std::span<const float> samples) {
    if (samples.empty()) return {};
    auto packets = encoder_.push(samples);
    if (!packets) return packets.error();
    keep(std::move(*packets));
    return {};
  }

  void keep(std::vector<media::AudioPacket> packets) {
    for (media::AudioPacket& packet : packets) sound_.packets.push_back(std::move(packet));
  }

  media::AudioEncoder encoder_;
  int rate_;
  int channels_;
  double speed_;
  std::optional<media::TimeStretch> stretch_;
  std::vector<float> stretched_;
  std::int64_t written_ = 0;  // samples of a channel, before they are stretched
  const EditSource* open_ = nullptr;
  std::optional<media::AudioReader> reader_;  // of that source
  std::int64_t position_ = 0;                 // samples of a channel that were taken from it
  std::span<const float> block_;              // samples that it gave and that were not taken yet
  std::vector<std::string> odd_;              // what it warned of
  std::vector<float> both_;
  media::EncodedAudio sound_;
};

}  // namespace

Result<std::optional<media::EncodedAudio>> cut_sound(const std::vector<EditCut>& cuts,
                                                     const media::AudioSettings& settings,
                                                     double speed, bool& copies) {
  int sample_rate = 0, channels = 1;
  const EditSource* seen = nullptr;
  for (const EditCut& cut : cuts) {
    if (!cut.source->sound || cut.source == seen) continue;
    seen = cut.source;
    media::ReadAudioOptions options;
    options.most_channels = 2;
    const auto reader = media::AudioReader::open(cut.source->path, options);
    if (!reader) return reader.error().in_file(cut.source->path);
    if (sample_rate == 0) sample_rate = reader->sample_rate();
    channels = std::max(channels, reader->channels());
  }
  if (sample_rate == 0) return std::optional<media::EncodedAudio>();
  if (copies && speed == 1 && is_whole(cuts)) {
    auto coded = media::read_encoded_audio(cuts.front().source->path);
    if (coded && coded->format.codec == settings.codec) return std::optional(std::move(*coded));
  }
  copies = false;
  auto encoder = media::AudioEncoder::open(sample_rate, settings, channels);
  if (!encoder) return encoder.error();
  SoundWriter writer(std::move(*encoder), sample_rate, channels, speed);
  double end = 0;
  for (const EditCut& cut : cuts) {
    end += seconds_of(cut);
    if (auto ok = writer.add(cut, end, &cut == &cuts.back()); !ok) return ok.error();
  }
  auto sound = writer.finish();
  if (!sound) return sound.error();
  return std::optional(std::move(*sound));
}

std::vector<media::TextTrack> cut_texts(const std::vector<EditCut>& cuts, double speed) {
  std::vector<media::TextTrack> merged;
  double begin = 0;
  for (const EditCut& cut : cuts) {
    const double from = sound_begin(cut);
    const double seconds = seconds_of(cut);
    for (const media::TextTrack& track : cut.source->texts) {
      auto into = std::ranges::find_if(merged, [&](const media::TextTrack& other) {
        return other.name == track.name && other.language == track.language;
      });
      if (into == merged.end()) {
        merged.push_back({track.name, track.language, {}});
        into = std::prev(merged.end());
      }
      for (media::TextCue cue : track.cues) {
        const double start = std::max(cue.start - from, 0.0);
        const double end = std::min(cue.end - from, seconds);
        if (end - start < kShortest) continue;
        cue.start = (begin + start) / speed;
        cue.end = (begin + end) / speed;
        into->cues.push_back(std::move(cue));
      }
    }
    begin += seconds;
  }
  std::erase_if(merged, [](const media::TextTrack& track) { return track.cues.empty(); });
  return merged;
}

}  // namespace animeme::tools
