#include "tools/formats/media/detail/tracks/muxer.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"
#include "tools/formats/media/language_codes.h"

namespace animeme::media {
namespace {

// Below this libavformat's mp4 writer doubles the time scale until it is reached.
constexpr std::uint32_t kLowestTimescale = 10000;

std::uint32_t container_timescale(std::uint32_t timescale) {
  if (timescale >= kLowestTimescale) return timescale;
  return timescale * ((kLowestTimescale + timescale - 1) / timescale);
}

bool set_buffer_facts(AVStream& stream, const BufferFacts& face) {
  std::size_t size = 0;
  AVCPBProperties* facts = av_cpb_properties_alloc(&size);
  if (facts == nullptr) return false;
  facts->buffer_size = 8 * std::int64_t(face.largest);
  facts->max_bitrate = face.peak_bits;
  auto* data = reinterpret_cast<std::uint8_t*>(facts);
  if (av_stream_add_side_data(&stream, AV_PKT_DATA_CPB_PROPERTIES, data, size) >= 0) return true;
  av_free(facts);
  return false;
}

}  // namespace

Result<std::unique_ptr<Muxer>> Muxer::open(const std::string& path, const char* format,
                                           OutputStream::Filter filter) {
  std::unique_ptr<Muxer> muxer(new Muxer);
  muxer->packet_.reset(av_packet_alloc());
  if (!muxer->packet_) return av::no_memory();
  const std::string url = "file:" + path;  // a colon in the name must not mean a protocol
  int status = avformat_alloc_output_context2(&muxer->context_, nullptr, format, url.c_str());
  if (status == AVERROR(EINVAL)) {
    return make_error(Code::unsupported,
                      std::string("this FFmpeg was built without the format ") + format);
  }
  if (status < 0) return write_error(status);
  Result<std::unique_ptr<OutputStream>> out = OutputStream::to_file(path, std::move(filter));
  if (!out) return out.error();
  muxer->out_ = std::move(*out);
  muxer->context_->pb = muxer->out_->io();
  muxer->context_->flags |= AVFMT_FLAG_BITEXACT;
  return muxer;
}

Muxer::~Muxer() { avformat_free_context(context_); }

bool Muxer::is(const char* format) const {
  return std::strcmp(context_->oformat->name, format) == 0;
}

// Only where there is something to say: files of one face stay as they are.
void Muxer::label(AVStream& stream, const TrackLabels& labels, const char* kind) {
  if (labels.empty()) return;
  const std::string code = labels.code.empty() ? "und" : labels.code;
  const std::string language = is("matroska") || is("webm") ? bibliographic_code(code) : code;
  av_dict_set(&stream.metadata, "language", language.c_str(), 0);
  const std::string name = name_with_speaker(kind, labels.speaker);
  const bool mp4 = is("mp4");
  if (!mp4 && labels.language.empty() && labels.speaker.empty()) return;
  av_dict_set(&stream.metadata, mp4 ? "handler_name" : "title",
              mp4 ? name.c_str() : title_with_tag(name, labels.language).c_str(), 0);
}

Result<void> Muxer::add_face(const fba::AccessUnits& units, const std::optional<BufferFacts>& facts,
                             const TrackLabels& labels) {
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  AVCodecParameters& parameters = *stream->codecpar;
  parameters.codec_type = AVMEDIA_TYPE_VIDEO;
  parameters.codec_id = AV_CODEC_ID_MPEG4;
  parameters.width = 320;  // as the reference library writes it; 0 is refused
  parameters.height = 240;
  if (!av::set_extradata(parameters, units.config) ||
      (facts && !set_buffer_facts(*stream, *facts))) {
    return av::no_memory();
  }
  stream->time_base = {1, int(container_timescale(units.timescale))};
  const std::int64_t first_duration = units.units.front().duration;
  av_reduce(&stream->avg_frame_rate.num, &stream->avg_frame_rate.den, units.timescale,
            first_duration, INT32_MAX);
  av_dict_set(&stream->metadata, "handler_name", "FBA", 0);
  label(*stream, labels, "FBA");
  // The pictures, or the first face.
  if (!labels.empty() && faces_.empty() && video_track_.stream == nullptr)
    stream->disposition |= AV_DISPOSITION_DEFAULT;
  faces_.push_back({&units, {stream, {1, int(units.timescale)}}});
  return {};
}

Result<void> Muxer::add_video(const EncodedVideo& video) {
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  AVCodecParameters& parameters = *stream->codecpar;
  parameters.codec_type = AVMEDIA_TYPE_VIDEO;
  // By VideoCodec.
  constexpr AVCodecID kIds[] = {AV_CODEC_ID_H264, AV_CODEC_ID_VP9, AV_CODEC_ID_MPEG4,
                                AV_CODEC_ID_PRORES};
  parameters.codec_id = kIds[std::size_t(video.codec)];
  parameters.width = video.width;
  parameters.height = video.height;
  parameters.format = video.alpha ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
  if (video.codec == VideoCodec::prores) {
    parameters.format = video.alpha ? AV_PIX_FMT_YUVA444P10 : AV_PIX_FMT_YUV444P10;
    parameters.codec_tag =
        MKTAG('a', 'p', '4', 'h');  // of ProRes 4444, which the packets do not say
    parameters.bits_per_coded_sample = video.alpha ? 32 : 24;
  }
  parameters.color_range = AVCOL_RANGE_MPEG;
  parameters.color_space = AVCOL_SPC_BT709;
  parameters.color_primaries = AVCOL_PRI_BT709;
  parameters.color_trc = AVCOL_TRC_BT709;
  if (!av::set_extradata(parameters, video.config)) return av::no_memory();
  video_track_ = {stream, {int(video.rate.den), int(video.rate.num)}};
  stream->avg_frame_rate = av_inv_q(video_track_.base);
  stream->time_base = {1, int(container_timescale(video.rate.num))};
  stream->disposition = AV_DISPOSITION_DEFAULT;
  if (video.alpha && video.codec == VideoCodec::vp9)
    av_dict_set(&stream->metadata, "alpha_mode", "1", 0);
  return {};
}

Result<void> Muxer::add_stream(const AVCodecParameters& parameters, AVRational time_base) {
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  const int status = avcodec_parameters_copy(stream->codecpar, &parameters);
  if (status < 0) return write_error(status);
  stream->codecpar->codec_tag = 0;
  stream->time_base = time_base;
  other_track_ = {stream, time_base};
  return {};
}

Result<void> Muxer::add_sound(const AudioFormat& format, std::int64_t bit_rate,
                              const TrackLabels& labels) {
  Result<av::Parameters> parameters = codec_parameters(format, bit_rate);
  if (!parameters) return parameters.error();
  if (auto added = add_stream(**parameters, {1, format.sample_rate}); !added) return added;
  Sound sound{format, 0, other_track_};
  // libavformat 5.1 moves the blocks by the pre-skip and has players skip it, too. Source:
  // tools/formats/media/containers.md, section 3.1.
  if (format.codec == AudioCodec::opus && (is("matroska") || is("webm"))) {
    sound.shift = format.priming;
  }
  label(*sound.track.stream, labels, "sound");
  if (!labels.empty() && sounds_.empty()) sound.track.stream->disposition = AV_DISPOSITION_DEFAULT;
  sounds_.push_back(std::move(sound));
  return {};
}

Result<int> Muxer::add_text(const TextSamples& text, const TrackLabels& labels) {
  AVStream* stream = avformat_new_stream(context_, nullptr);
  if (stream == nullptr) return av::no_memory();
  stream->codecpar->codec_type = AVMEDIA_TYPE_SUBTITLE;
  stream->codecpar->codec_id = text.codec;
  if (!av::set_extradata(*stream->codecpar, text.config)) return av::no_memory();
  stream->time_base = text.time_base;
  av_dict_set(&stream->metadata, "language", text.language.c_str(), 0);
  // Matroska's name of a track, and mp4's.
  const std::string name = name_with_speaker(text.name, labels.speaker);
  const std::string shown = is("mp4") ? name : title_with_tag(name, labels.language);
  av_dict_set(&stream->metadata, is("mp4") ? "handler_name" : "title", shown.c_str(), 0);
  text_tracks_.push_back({stream, text.time_base});
  return int(text_tracks_.size()) - 1;
}

Result<void> Muxer::check(int status) {
  // The reason lies where the bytes went; libavformat passes on what it made of it.
  if (context_->pb->error < 0) status = context_->pb->error;
  return status < 0 ? write_error(status) : Result<void>();
}

Result<void> Muxer::write_header(av::Options& options) {
  Result<void> written = check(avformat_write_header(context_, options.get()));
  if (!written) return written;
  if (const char* name = options.unused()) {
    return make_error(Code::internal, std::string("this FFmpeg does not know the option ") + name);
  }
  return {};
}

Result<void> Muxer::write(AVPacket& packet, const Track& track) {
  packet.stream_index = track.stream->index;
  av_packet_rescale_ts(&packet, track.base, track.stream->time_base);
  packet.pos = -1;
  return check(av_interleaved_write_frame(context_, &packet));
}

Result<void> Muxer::write_unit(const fba::AccessUnit& unit, int number) {
  const Face& face = faces_[std::size_t(number)];
  const std::size_t prefix = is("mpegts") && unit.intra ? face.units->config.size() : 0;
  const int status = av_new_packet(packet_.get(), int(prefix + unit.bytes.size()));
  if (status < 0) return av::no_memory();
  if (prefix > 0) std::memcpy(packet_->data, face.units->config.data(), prefix);
  std::memcpy(packet_->data + prefix, unit.bytes.data(), unit.bytes.size());
  packet_->pts = packet_->dts = unit.time;
  packet_->duration = unit.duration;
  if (unit.intra) packet_->flags |= AV_PKT_FLAG_KEY;
  return write(*packet_, face.track);
}

Result<void> Muxer::write_sound(const AudioPacket& packet, int number) {
  const Sound& sound = sounds_[std::size_t(number)];
  Result<void> copied = copy_packet(packet, sound.format, *packet_);
  if (!copied) return copied;
  packet_->pts += sound.shift;
  packet_->dts += sound.shift;
  return write(*packet_, sound.track);
}

Result<void> Muxer::write_picture(const VideoPacket& picture) {
  if (av_new_packet(packet_.get(), int(picture.bytes.size())) < 0) return av::no_memory();
  std::memcpy(packet_->data, picture.bytes.data(), picture.bytes.size());
  packet_->pts = packet_->dts = picture.time;
  packet_->duration = 1;
  if (picture.key) packet_->flags |= AV_PKT_FLAG_KEY;
  if (!picture.alpha.empty()) {
    std::uint8_t* beside = av_packet_new_side_data(
        packet_.get(), AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, 8 + picture.alpha.size());
    if (beside == nullptr) return av::no_memory();
    AV_WB64(beside, 1);  // the kind: alpha
    std::memcpy(beside + 8, picture.alpha.data(), picture.alpha.size());
  }
  return write(*packet_, video_track_);
}

Result<void> Muxer::write_text(const TextSample& sample, int text) {
  if (av_new_packet(packet_.get(), int(sample.bytes.size())) < 0) return av::no_memory();
  std::memcpy(packet_->data, sample.bytes.data(), sample.bytes.size());
  packet_->pts = packet_->dts = sample.time;
  packet_->duration = sample.duration;
  packet_->flags |= AV_PKT_FLAG_KEY;
  return write(*packet_, text_tracks_[std::size_t(text)]);
}

Result<void> Muxer::write_packet(AVPacket& packet) { return write(packet, other_track_); }

Result<void> Muxer::end_fragment() {
  Result<void> flushed = check(av_interleaved_write_frame(context_, nullptr));
  // With delay_moov the first call writes the contents only; one too many does nothing.
  for (int i = 0; flushed && i < 2; ++i) flushed = check(av_write_frame(context_, nullptr));
  avio_flush(context_->pb);
  return flushed ? check(0) : flushed;
}

void Muxer::allow_late_track() {
  // Else libavformat 5.1 begins it at 0. Other formats do not know the option.
  if (is("mp4")) av_opt_set(context_->priv_data, "movflags", "+frag_discont", 0);
}

Result<void> Muxer::finish() {
  Result<void> ended = check(av_write_trailer(context_));
  return ended ? out_->close() : ended;
}

}  // namespace animeme::media
