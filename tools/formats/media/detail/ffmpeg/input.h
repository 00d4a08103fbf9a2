// Opening a file or a memory block with libavformat in a closed room: whatever the content says,
// no other file, device or network address is opened.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/mp4/metadata_tracks.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {

/// An open AVFormatContext with its own reader beneath. Faces and texts that are timed metadata in
/// an mp4 look like MPEG-4 video and subtitles in it. Tracks that are not wanted (track_labels.h)
/// have no type. Not movable: FFmpeg keeps its address.
class Input {
 public:
  /// `formats`: libavformat names, comma separated, that are let in; nullptr: all.
  /// Errors: not_found, io (the file), truncated (empty), syntax (no known media format, or
  /// damaged), unsupported (a format outside `formats`, or a raw FBA stream); not_found (no track
  /// is wanted).
  static Result<std::unique_ptr<Input>> open(const std::string& path, const char* formats);
  static Result<std::unique_ptr<Input>> open(std::span<const std::uint8_t> memory,
                                             const char* formats);
  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  AVFormatContext* context() const { return context_; }
  /// Bytes of the whole input, -1: a pipe.
  std::int64_t size() const { return size_; }
  /// Short name: "mp4", "mov", "matroska", "mpegts", else libavformat's first name.
  std::string format() const;
  /// mp4 and its relatives: edit lists give exact begin and end.
  bool is_mp4_family() const;
  /// What the headers say of a stream, beside what it is.
  TrackLabels labels(const AVStream& stream) const;
  /// The read budget ran out: the index sends the reader over the same bytes again and again.
  bool exhausted() const { return exhausted_; }

 private:
  Input() = default;
  Result<void> start(const std::string& hint, const char* formats);
  bool holds_raw_stream();
  bool holds_transport_stream();
  Result<void> look_at_boxes();
  void reveal_metadata();
  void read_language_tags();
  Result<void> show_wanted();
  static int read(void* self, std::uint8_t* buffer, int size);
  static std::int64_t seek(void* self, std::int64_t offset, int whence);
  std::int64_t seek_to(std::int64_t offset, int whence);
  int read_some(std::uint8_t* buffer, int size);

  std::FILE* file_ = nullptr;
  std::span<const std::uint8_t> memory_;
  std::int64_t position_ = 0;  // in memory_
  std::int64_t size_ = -1;     // -1: a pipe
  std::int64_t budget_ = 0;
  bool exhausted_ = false;
  std::vector<MetadataTrack> metadata_;
  std::map<std::int64_t, std::string> tags_;  // languages of mp4, by number of the track
  std::vector<std::string> listed_tags_;      // of Matroska, in order
  av::Io io_;
  AVFormatContext* context_ = nullptr;
};

}  // namespace animeme::media
