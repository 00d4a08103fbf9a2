// Where time 0 of a file lies.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/formats/media/detail/sound/audio_decoder.h"

namespace animeme::media {

/// Looks for the time at which read_audio()'s sample 0 lies, while others read the file.
class SoundStart {
 public:
  /// `stream`: the best sound of `input`, which outlives this; nullptr: there is none.
  SoundStart(const Input& input, AVStream* stream);

  /// Does it want packets of stream()?
  bool searching() const { return codec_ != nullptr; }
  /// -1: there is none.
  int stream() const { return stream_ == nullptr ? -1 : stream_->index; }
  /// In the stream's time base; nullopt: not found.
  std::optional<std::int64_t> time() const { return time_; }
  void try_packet(const AVPacket& packet);

 private:
  bool covers_zero(const AVFrame& frame) const;
  void give_up();

  const Input& input_;
  AVStream* stream_;
  av::Codec codec_;
  av::Frame frame_;
  std::optional<std::int64_t> time_;
  int tried_ = 0;
};

/// Within one tick of a coarse clock the start is not known better than 0.
inline std::int64_t known_start(std::int64_t time) { return time >= -1 && time <= 1 ? 0 : time; }

}  // namespace animeme::media
