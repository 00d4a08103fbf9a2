/// @file
/// Video encoding, for the rendered preview of a face that any player shows.
///
///     Result<VideoEncoder> encoder = VideoEncoder::open({.width = 640, .height = 640});
///     for (const Picture& picture : pictures) {
///       if (auto ok = encoder->push(picture.rgba); !ok) return ok.error();
///     }
///     Result<EncodedVideo> video = encoder->finish();
///
/// The coded video stays in memory (a talking head of 640 x 640 takes about 2 MB a minute).
/// Source: tools/formats/media/containers.md, section 6.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::media {

/// Codecs of the preview.
enum class VideoCodec : std::uint8_t {
  h264,    ///< by libx264; most compatible
  vp9,     ///< by libvpx; free of patent questions
  mpeg4,   ///< part 2, which every FFmpeg has; large files
  prores,  ///< ProRes 4444, for editing programs; ten bits, large files
};

/// "h264", "vp9", "mpeg4" or "prores".
const char* name_of(VideoCodec codec);

/// The first codec that suits a file with this extension (".mp4", ".webm", ".mkv", ".mov") and that
/// this FFmpeg can encode. Errors: unsupported (another extension, or no encoder available).
Result<VideoCodec> video_codec_for(std::string_view extension);

/// Encoder settings.
struct VideoSettings {
  VideoCodec codec = VideoCodec::h264;  ///< see video_codec_for()
  int width = 640;                      ///< pixels, even, 16..8192
  int height = 640;                     ///< pixels, even, 16..8192
  fap::Rate rate{25, 1};                ///< pictures a second
  /// 0 (best) to 51 (smallest); about 20 is hard to tell from the original.
  int quality = 20;
  /// Encoder threads. The output depends on the number, so it does not default to the machine's.
  int threads = 4;
  /// Pixels have alpha, too: VP9 in .webm and .mkv, ProRes in .mov. Players without it show the
  /// colours.
  bool alpha = false;
};

/// One coded picture.
struct VideoPacket {
  std::vector<std::uint8_t> bytes;  ///< in the codec's format
  std::vector<std::uint8_t> alpha;  ///< likewise, of the second picture that holds alpha; or empty
  bool key = false;                 ///< a player can begin here
  std::int64_t time = 0;            ///< frame number; presentation = decoding order

  friend bool operator==(const VideoPacket&, const VideoPacket&) = default;
};

/// A coded video track: one packet per picture, in order.
struct EncodedVideo {
  VideoCodec codec = VideoCodec::h264;  ///< of the packets
  int width = 0;                        ///< pixels
  int height = 0;                       ///< pixels
  fap::Rate rate;                       ///< pictures a second
  std::vector<std::uint8_t> config;     ///< decoder configuration ("extradata")
  bool alpha = false;                   ///< the packets have alpha
  std::vector<VideoPacket> packets;     ///< one per picture
};

/// Movable, not copyable, not thread safe. Colours are BT.709, limited range; there is a key frame
/// every second.
class VideoEncoder {
 public:
  /// Errors: invalid_argument (settings out of bounds), unsupported (this FFmpeg lacks the
  /// encoder), out_of_range (memory).
  static Result<VideoEncoder> open(const VideoSettings& settings);
  VideoEncoder(VideoEncoder&&) noexcept;  ///< movable
  VideoEncoder& operator=(VideoEncoder&&) noexcept;
  ~VideoEncoder();

  /// Adds one picture: width x height x 4 bytes, rows from the top, R G B A (colours not
  /// multiplied with A, which is used only with VideoSettings::alpha).
  /// Errors: invalid_argument (another size), io (the encoder fails), out_of_range (memory).
  Result<void> push(std::span<const std::uint8_t> rgba);
  /// Ends and returns the video. Nothing can be pushed afterwards.
  /// Errors: as push(); invalid_argument (no picture was pushed).
  Result<EncodedVideo> finish();

 private:
  struct Impl;
  explicit VideoEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::media
