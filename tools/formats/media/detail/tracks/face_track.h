// Finding the FBA stream of an open file and keeping libavcodec's hands off it.
// Source: tools/formats/media/containers.md, section 2.3.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ffmpeg/input.h"

namespace animeme::media {

/// What is known of one stream.
struct FaceTrack {
  enum class State : std::uint8_t {
    no,
    maybe,  ///< no configuration in the header; the first packet decides
    yes,
  };
  State state = State::no;
  bool video = false;                ///< libavformat thought of it as MPEG-4 video
  std::vector<std::uint8_t> config;  ///< as in the header; may be empty
  std::uint8_t profile = 0;
  std::int64_t first = AV_NOPTS_VALUE;  ///< time of its first packet, where one was read
};

/// States of all streams, by stream index. Must be called before avformat_find_stream_info() and
/// again whenever streams may have been added: it turns faces, certain or possible, into data
/// streams, so that neither decoder nor parser touches them.
class FaceTracks {
 public:
  void update(AVFormatContext& file);
  FaceTrack& operator[](int stream) { return tracks_[std::size_t(stream)]; }
  std::size_t size() const { return tracks_.size(); }
  /// Settles a `maybe` by a packet of it.
  void decide(const AVPacket& packet);
  /// First stream that is, or (if none is) may be a face; -1: none.
  int first() const;

 private:
  std::vector<FaceTrack> tracks_;
};

/// Facts of an audio stream.
AudioInfo describe_audio(const Input& input, const AVStream& stream);

/// 0: not known.
inline double to_seconds(std::int64_t ticks, AVRational base) {
  return ticks == AV_NOPTS_VALUE || base.den <= 0 ? 0 : double(ticks) * av_q2d(base);
}

}  // namespace animeme::media
