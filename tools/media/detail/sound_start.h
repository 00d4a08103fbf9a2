// Where the sound of a file begins.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/media/detail/audio_decoder.h"

namespace animeme::media {

/// The time at which read_audio()'s sample 0 lies, found by decoding the first packets.
class SoundStart {
 public:
  /// `stream` may be null: there is no sound. Both are borrowed.
  SoundStart(const Input& input, AVStream* stream);

  /// False: it was found or cannot be.
  bool searching() const { return codec_ != nullptr; }
  int stream() const { return stream_ == nullptr ? -1 : stream_->index; }
  /// Stream time base; nullopt: not found (so far).
  std::optional<std::int64_t> time() const { return time_; }
  /// A packet of the stream, in their order.
  void try_packet(const AVPacket& packet);

 private:
  bool covers_zero(const AVFrame& frame) const;

  const Input& input_;
  AVStream* stream_;
  av::Codec codec_;
  av::Frame frame_;
  std::optional<std::int64_t> time_;
  int tried_ = 0;
};

}  // namespace animeme::media
