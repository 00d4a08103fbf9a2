#include <algorithm>
#include <array>
#include <utility>

#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/tracks/face_track.h"
#include "tools/formats/media/detail/tracks/text_samples.h"
#include "tools/formats/media/detail/tracks/track_names.h"

namespace animeme::media {
namespace {

// Packets to read for the first one of a track that may be a face.
constexpr int kPacketsToTry = 2000;

std::string tag_text(std::uint32_t tag) {
  std::string text;
  for (; tag != 0; tag >>= 8) {
    const char c = char(tag & 255);
    if (c < 0x20 || c > 0x7e) return {};
    text += c;
  }
  return text;
}

TrackKind kind_of(const AVCodecParameters& parameters, const FaceTrack& face) {
  if (face.state == FaceTrack::State::yes) return TrackKind::face;
  if (face.video || parameters.codec_type == AVMEDIA_TYPE_VIDEO) return TrackKind::video;
  if (parameters.codec_type == AVMEDIA_TYPE_SUBTITLE) return TrackKind::text;
  return parameters.codec_type == AVMEDIA_TYPE_AUDIO ? TrackKind::audio : TrackKind::other;
}

TrackInfo describe(const AVStream& stream, const FaceTrack& face) {
  const AVCodecParameters& parameters = *stream.codecpar;
  TrackInfo track;
  track.kind = kind_of(parameters, face);
  track.codec = track.kind == TrackKind::face ? "fba"
                : face.video                  ? "mpeg4"
                                              : avcodec_get_name(parameters.codec_id);
  track.tag = tag_text(parameters.codec_tag);
  const AVRational base = stream.time_base;
  track.timescale = base.num == 1 && base.den > 0 ? std::uint32_t(base.den) : 0;
  // FFmpeg does not look where data begin, and a face is data to it (see FaceTracks).
  const bool known = track.kind == TrackKind::face && face.first != AV_NOPTS_VALUE;
  track.start = to_seconds(known ? face.first : stream.start_time, base);
  track.duration = to_seconds(stream.duration, base);
  track.bit_rate = parameters.bit_rate;
  track.samples = stream.nb_frames;
  if (track.kind == TrackKind::audio) {
    track.sample_rate = parameters.sample_rate;
    track.channels = parameters.ch_layout.nb_channels;
  }
  if (track.kind == TrackKind::video) {
    track.width = parameters.width;
    track.height = parameters.height;
    // That of the container counts before that of the codec, as in FFmpeg's players.
    for (const AVRational shape : {parameters.sample_aspect_ratio, stream.sample_aspect_ratio}) {
      if (shape.num > 0 && shape.den > 0) track.pixel_aspect = av_q2d(shape);
    }
  }
  if (track.kind == TrackKind::text) {
    track.name = name_of_text(stream);
    track.language = language_of_text(stream);
  }
  if (track.kind == TrackKind::face) {
    track.face_config = face.config;
    track.visual_profile = face.profile;
  }
  if (stream.avg_frame_rate.num > 0 && stream.avg_frame_rate.den > 0) {
    track.frame_rate = av_q2d(stream.avg_frame_rate);
  } else if (track.kind == TrackKind::face && track.samples > 0 && track.duration > 0) {
    track.frame_rate = double(track.samples) / track.duration;
  }
  return track;
}

// Reads on until every track that may be a face has shown a packet, and every face when it begins.
void settle(AVFormatContext& file, FaceTracks& tracks) {
  const av::Packet packet(av_packet_alloc());
  if (!packet) return;
  for (int i = 0; i < kPacketsToTry; ++i) {
    bool open = false;
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      const FaceTrack& track = tracks[int(t)];
      open = open || track.state == FaceTrack::State::maybe ||
             (track.state == FaceTrack::State::yes && track.first == AV_NOPTS_VALUE);
    }
    if (!open || av_read_frame(&file, packet.get()) < 0) return;
    tracks.update(file);
    tracks.decide(*packet);
    FaceTrack& track = tracks[packet->stream_index];
    if (track.first == AV_NOPTS_VALUE) track.first = packet->pts;
    if (track.state == FaceTrack::State::yes && track.profile == 0 && packet->size > 0) {
      track.profile = read_visual_headers({packet->data, std::size_t(packet->size)}).profile;
    }
    av_packet_unref(packet.get());
  }
}

ContainerInfo look_at(Input& input) {
  AVFormatContext& file = *input.context();
  ContainerInfo info;
  info.format = input.format();
  FaceTracks tracks;
  tracks.update(file);
  if (avformat_find_stream_info(&file, nullptr) < 0) {
    info.warnings.emplace_back("the stream headers are incomplete");
  }
  tracks.update(file);
  settle(file, tracks);
  for (unsigned i = 0; i < file.nb_streams; ++i) {
    info.tracks.push_back(describe(*file.streams[i], tracks[int(i)]));
    info.tracks.back().labels = input.labels(*file.streams[i]);
    info.tracks.back().is_default = (file.streams[i]->disposition & AV_DISPOSITION_DEFAULT) != 0;
  }
  info.duration = to_seconds(file.duration, {1, AV_TIME_BASE});
  info.bytes = input.size();
  return info;
}

template <class Source>
Result<ContainerInfo> probe_from(const Source& source) {
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(source, nullptr);
  if (!input) return input.error();
  ContainerInfo info = look_at(**input);
  for (const std::string& line : log.lines()) info.warnings.push_back("FFmpeg: " + line);
  return info;
}

// All renditions as one.
Result<ContainerInfo> probe_playlist(const std::string& path) {
  const Result<Presentation> presentation = read_presentation(path);
  if (!presentation) return presentation.error();
  ContainerInfo all;
  all.format = presentation->format;
  all.bytes = 0;
  for (const std::vector<std::uint8_t>& bytes : presentation->renditions) {
    Result<ContainerInfo> info = probe_from(bytes);
    if (!info) return info.error();
    all.duration = std::max(all.duration, info->duration);
    all.bytes += std::int64_t(bytes.size());
    for (TrackInfo& track : info->tracks) all.tracks.push_back(std::move(track));
    for (std::string& text : info->warnings) all.warnings.push_back(std::move(text));
  }
  for (const PresentedText& text : presentation->texts) {
    TrackInfo& track = all.tracks.emplace_back();
    track.kind = TrackKind::text;
    track.codec = "webvtt";
    const std::string name = clean_text(text.name), tag = clean_text(text.language);
    track.name = name_without_speaker(name);
    track.language = tag.empty() ? "und" : tag;
    track.labels = labels_of_text(name, tag);
    all.bytes += std::int64_t(text.file.size());
  }
  return all;
}

}  // namespace

const char* name_of(TrackKind kind) {
  constexpr std::array kNames = {"face", "audio", "video", "text", "other"};
  return kNames[std::size_t(kind)];
}

Result<ContainerInfo> probe(const std::string& path) {
  const TrackScope all({});
  return av::guarded(path,
                     [&] { return is_playlist(path) ? probe_playlist(path) : probe_from(path); });
}

Result<ContainerInfo> probe(std::span<const std::uint8_t> file) {
  const TrackScope all({});
  return av::guarded([&] { return probe_from(file); });
}

}  // namespace animeme::media
