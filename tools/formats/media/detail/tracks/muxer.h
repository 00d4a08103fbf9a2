// One output of libavformat: streams first, then packets in time order. Knows formats, not where
// the data comes from.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/detail/tracks/text_samples.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/media/video.h"

namespace animeme::media {

class Muxer {
 public:
  /// A file at `path`, written by a muxer of libavformat's: "mp4", "matroska", "mpegts" ...
  /// `filter` as in OutputStream. Errors: unsupported, io.
  static Result<std::unique_ptr<Muxer>> open(const std::string& path, const char* format,
                                             OutputStream::Filter filter = nullptr);
  ~Muxer();
  Muxer(const Muxer&) = delete;
  Muxer& operator=(const Muxer&) = delete;

  /// Adds the face stream. `units` must outlive the muxer; it has one at least, whose duration
  /// tells the rate. `facts` are those of all units; nullopt: they are not known yet, and the
  /// decoder configuration is left open.
  /// Several faces and sounds are numbered from 0, in the order in which they are added; the first
  /// of each kind is the default of the file.
  Result<void> add_face(const fba::AccessUnits& units, const std::optional<BufferFacts>& facts,
                        const TrackLabels& labels = {});
  /// Adds the pictures; before the face, so that players choose them. `video` must outlive the
  /// muxer.
  Result<void> add_video(const EncodedVideo& video);
  /// Adds a stream with these parameters and packet times in `time_base`.
  Result<void> add_stream(const AVCodecParameters& parameters, AVRational time_base);
  /// Adds a stream of coded sound; `bit_rate` 0: not known.
  Result<void> add_sound(const AudioFormat& format, std::int64_t bit_rate,
                         const TrackLabels& labels = {});

  /// Adds a text behind them; its number for write_text().
  Result<int> add_text(const TextSamples& text, const TrackLabels& labels = {});

  /// Streams are complete. Options that the format does not know are an error (internal).
  Result<void> write_header(av::Options& options);
  Result<void> write_unit(const fba::AccessUnit& unit, int face = 0);
  Result<void> write_sound(const AudioPacket& packet, int sound = 0);
  Result<void> write_picture(const VideoPacket& packet);
  Result<void> write_text(const TextSample& sample, int text);
  /// Takes the packet's content. Times in the time_base given to add_stream().
  Result<void> write_packet(AVPacket& packet);
  /// What was written goes to the disk, and what comes next begins a fragment (mp4 with
  /// frag_custom) or a cluster.
  Result<void> end_fragment();
  /// Before the first packet of a track that comes after the first fragment (mp4): it keeps its
  /// time.
  void allow_late_track();
  /// Completes the file and closes it.
  Result<void> finish();

 private:
  struct Track {
    AVStream* stream = nullptr;
    AVRational base{1, 1};  // of the times that come in
  };
  Muxer() = default;
  struct Face {
    const fba::AccessUnits* units = nullptr;
    Track track;
  };
  struct Sound {
    AudioFormat format;
    std::int64_t shift = 0;  // samples
    Track track;
  };
  void label(AVStream& stream, const TrackLabels& labels, const char* kind);
  Result<void> check(int status);
  Result<void> write(AVPacket& packet, const Track& track);
  bool is(const char* format) const;

  std::unique_ptr<OutputStream> out_;
  AVFormatContext* context_ = nullptr;
  av::Packet packet_;
  std::vector<Face> faces_;
  std::vector<Sound> sounds_;
  Track video_track_, other_track_;
  std::vector<Track> text_tracks_;
};

}  // namespace animeme::media
