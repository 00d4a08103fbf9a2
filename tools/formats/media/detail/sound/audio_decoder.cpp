#include "tools/formats/media/detail/sound/audio_decoder.h"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace animeme::media {

Result<av::Codec> open_audio_decoder(const AVCodecParameters& parameters, AVRational time_base,
                                     int flags2) {
  const AVCodec* decoder = avcodec_find_decoder(parameters.codec_id);
  if (decoder == nullptr) {
    return make_error(Code::unsupported, std::string("no decoder for the audio codec ") +
                                             avcodec_get_name(parameters.codec_id));
  }
  av::Codec codec(avcodec_alloc_context3(decoder));
  if (!codec) return av::no_memory();
  int status = avcodec_parameters_to_context(codec.get(), &parameters);
  codec->pkt_timebase = time_base;
  codec->flags2 |= flags2;
  codec->thread_count = 1;  // the same result and the same log everywhere
  if (status >= 0) status = avcodec_open2(codec.get(), decoder, nullptr);
  if (status < 0) {
    return av::make_av_error(status, std::string("the audio track (") +
                                         avcodec_get_name(parameters.codec_id) +
                                         ") cannot be decoded");
  }
  return codec;
}

Result<bool> decode_packet(AVCodecContext& codec, const AVPacket* packet, AVFrame& frame,
                           const std::function<Result<void>(AVFrame&)>& take) {
  bool sound = avcodec_send_packet(&codec, packet) >= 0;
  for (;;) {
    const int status = avcodec_receive_frame(&codec, &frame);
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return sound;
    if (status < 0) return false;
    Result<void> taken = take(frame);
    av_frame_unref(&frame);
    if (!taken) return taken.error();
  }
}

std::int64_t first_played(const Input& input, std::int64_t first_decoded) {
  return input.is_mp4_family() ? std::max<std::int64_t>(first_decoded, 0) : first_decoded;
}

std::optional<std::int64_t> end_of_sound(const Input& input, const AVStream& stream) {
  const bool timed = stream.start_time != AV_NOPTS_VALUE && stream.duration > 0 &&
                     stream.duration < INT64_MAX / 4 && std::abs(stream.start_time) < INT64_MAX / 4;
  if (!input.is_mp4_family() || !timed) return std::nullopt;
  return stream.start_time + stream.duration;
}

std::optional<int> find_audio(const Input& input) {
  const int index = av_find_best_stream(input.context(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
  return index < 0 ? std::nullopt : std::optional<int>(index);
}

Result<AVStream*> choose_audio(Input& input) {
  AVFormatContext& file = *input.context();
  const int found = avformat_find_stream_info(&file, nullptr);
  if (found < 0) return av::make_av_error(found, "the file is damaged");
  const std::optional<int> index = find_audio(input);
  if (!index) return make_error(Code::not_found, "the file has no audio track");
  for (unsigned i = 0; i < file.nb_streams; ++i) {
    if (int(i) != *index) file.streams[i]->discard = AVDISCARD_ALL;
  }
  return file.streams[*index];
}

Result<int> read_packets(Input& input, int stream,
                         const std::function<Result<void>(AVPacket&)>& take) {
  const av::Packet packet(av_packet_alloc());
  if (!packet) return av::no_memory();
  for (;;) {
    const int status = av_read_frame(input.context(), packet.get());
    if (status < 0) return status;
    Result<void> taken;
    if (packet->stream_index == stream) taken = take(*packet);
    av_packet_unref(packet.get());
    if (!taken) return taken.error();
  }
}

}  // namespace animeme::media
