#include "tools/formats/media/detail/tracks/face_track.h"

#include <algorithm>

#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

FaceTrack classify(const AVCodecParameters& parameters) {
  FaceTrack track;
  if (parameters.codec_type == AVMEDIA_TYPE_DATA) {
    if (parameters.codec_id == AV_CODEC_ID_BIN_DATA) track.state = FaceTrack::State::maybe;
    return track;
  }
  if (parameters.codec_id != AV_CODEC_ID_MPEG4) return track;
  track.video = true;
  if (parameters.extradata != nullptr && parameters.extradata_size > 0) {
    track.config.assign(parameters.extradata, parameters.extradata + parameters.extradata_size);
  }
  const VisualHeaders headers = read_visual_headers(track.config);
  track.profile = headers.profile;
  if (headers.kind == VisualKind::face) {
    track.state = FaceTrack::State::yes;
  } else if (track.config.empty()) {
    track.state = FaceTrack::State::maybe;
  }
  return track;
}

}  // namespace

void FaceTracks::update(AVFormatContext& file) {
  while (tracks_.size() < file.nb_streams) {
    AVCodecParameters& parameters = *file.streams[tracks_.size()]->codecpar;
    tracks_.push_back(classify(parameters));
    if (tracks_.back().state == FaceTrack::State::no) continue;
    parameters.codec_type = AVMEDIA_TYPE_DATA;
    parameters.codec_id = AV_CODEC_ID_BIN_DATA;
  }
}

void FaceTracks::decide(const AVPacket& packet) {
  FaceTrack& track = tracks_[std::size_t(packet.stream_index)];
  if (track.state != FaceTrack::State::maybe) return;
  if (packet.data == nullptr || packet.size <= 0) return;
  const bool face = looks_like_face({packet.data, std::size_t(packet.size)});
  track.state = face ? FaceTrack::State::yes : FaceTrack::State::no;
}

int FaceTracks::first() const {
  int possible = -1;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].state == FaceTrack::State::yes) return int(i);
    if (tracks_[i].state == FaceTrack::State::maybe && possible < 0) possible = int(i);
  }
  return possible;
}

AudioInfo describe_audio(const Input& input, const AVStream& stream) {
  const AVCodecParameters& parameters = *stream.codecpar;
  AudioInfo info;
  info.codec = avcodec_get_name(parameters.codec_id);
  info.sample_rate = parameters.sample_rate;
  info.channels = parameters.ch_layout.nb_channels;
  info.duration = to_seconds(stream.duration, stream.time_base);
  if (!(info.duration > 0)) {  // that of the whole file
    info.duration = std::max(to_seconds(input.context()->duration, {1, AV_TIME_BASE}), 0.0);
  }
  info.bit_rate = parameters.bit_rate;
  return info;
}

}  // namespace animeme::media
