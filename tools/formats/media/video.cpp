#include "tools/formats/media/video.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ffmpeg/invalid.h"

namespace animeme::media {
namespace {

// By VideoCodec.
constexpr std::array kCodecNames = {"h264", "vp9", "mpeg4", "prores"};
// Asked for by name: FFmpeg's own choice for H.264 may be hardware that is not there.
constexpr std::array kEncoders = {"libx264", "libvpx-vp9", "mpeg4", "prores_ks"};

const char* encoder_of(VideoCodec codec) { return kEncoders[std::size_t(codec)]; }

Result<void> check(const VideoSettings& settings) {
  const auto bad = [](int side) { return side < 16 || side > 8192 || side % 2 != 0; };
  if (bad(settings.width) || bad(settings.height)) {
    return invalid("a video is 16 to 8192 pixels wide and high, both even numbers");
  }
  if (!settings.rate.valid() || settings.rate.frames_per_second() > 1000 ||
      settings.rate.num > INT32_MAX || settings.rate.den > INT32_MAX) {
    return invalid("a video has up to 1000 frames a second");
  }
  if (settings.quality < 0 || settings.quality > 51) {
    return invalid("the quality of a video is 0 (best) to 51");
  }
  if (settings.alpha && settings.codec != VideoCodec::vp9 && settings.codec != VideoCodec::prores)
    return make_error(Code::unsupported, "only VP9 (.webm) and ProRes (.mov) have transparency");
  if (settings.threads < 1 || settings.threads > 64) return invalid("1 to 64 threads");
  return {};
}

AVPixelFormat format_of(const VideoSettings& settings) {
  if (settings.codec == VideoCodec::prores)
    return settings.alpha ? AV_PIX_FMT_YUVA444P10 : AV_PIX_FMT_YUV444P10;
  return settings.alpha ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
}

void set_options(const VideoSettings& settings, AVCodecContext& codec, av::Options& options) {
  switch (settings.codec) {
    case VideoCodec::h264:
      options.set("preset", std::string("veryfast"));
      options.set("crf", settings.quality);
      break;
    case VideoCodec::vp9:  // its scale goes to 63
      options.set("deadline", std::string("realtime"));
      options.set("cpu-used", 6);
      options.set("row-mt", 1);
      options.set("crf", settings.quality * 63 / 51);
      codec.bit_rate = 0;
      break;
    case VideoCodec::mpeg4:  // 2..31
      codec.flags |= AV_CODEC_FLAG_QSCALE;
      codec.global_quality = FF_QP2LAMBDA * (2 + settings.quality * 29 / 51);
      break;
    case VideoCodec::prores:  // 1..16
      options.set("profile", std::string("4444"));
      options.set("vendor", std::string("apl0"));  // some programs read no other
      codec.global_quality = FF_QP2LAMBDA * (1 + settings.quality * 15 / 51);
      break;
  }
}

Result<av::Codec> open_codec(const VideoSettings& settings) {
  const AVCodec* encoder = avcodec_find_encoder_by_name(encoder_of(settings.codec));
  if (encoder == nullptr) {
    return make_error(Code::unsupported, std::string("this FFmpeg was built without ") +
                                             encoder_of(settings.codec) + ", the encoder for " +
                                             name_of(settings.codec));
  }
  av::Codec codec(avcodec_alloc_context3(encoder));
  if (!codec) return av::no_memory();
  const int num = int(settings.rate.num);
  const int den = int(settings.rate.den);
  codec->width = settings.width;
  codec->height = settings.height;
  codec->pix_fmt = format_of(settings);
  codec->time_base = {den, num};
  codec->framerate = {num, den};
  codec->gop_size = std::max(1, num / den);
  codec->max_b_frames = 0;
  codec->thread_count = settings.threads;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_BT709;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  av::Options options;
  set_options(settings, *codec, options);
  const int status = avcodec_open2(codec.get(), encoder, options.get());
  if (status < 0) return av::make_av_error(status, "the video encoder cannot be started");
  if (const char* name = options.unused()) {
    return make_error(Code::internal, std::string("the encoder does not know the option ") + name);
  }
  return codec;
}

Result<av::Sws> open_scaler(const VideoSettings& settings) {
  const int flags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INP;
  av::Sws sws(sws_getContext(settings.width, settings.height, AV_PIX_FMT_RGBA, settings.width,
                             settings.height, format_of(settings), flags, nullptr, nullptr,
                             nullptr));
  if (!sws) return av::no_memory();
  const int* matrix = sws_getCoefficients(SWS_CS_ITU709);
  const int one = 1 << 16;
  sws_setColorspaceDetails(sws.get(), matrix, 1, matrix, 0, 0, one, one);
  return sws;
}

}  // namespace

const char* name_of(VideoCodec codec) { return kCodecNames[std::size_t(codec)]; }

Result<VideoCodec> video_codec_for(std::string_view extension) {
  constexpr std::array kAny = {VideoCodec::h264, VideoCodec::vp9, VideoCodec::mpeg4};
  constexpr std::array kWebm = {VideoCodec::vp9};
  constexpr std::array kMov = {VideoCodec::prores};
  std::span<const VideoCodec> wanted;
  if (extension == ".mp4" || extension == ".mkv") wanted = kAny;
  if (extension == ".webm") wanted = kWebm;
  if (extension == ".mov") wanted = kMov;
  if (wanted.empty()) {
    return make_error(Code::unsupported, "cannot write a video as \"" + std::string(extension) +
                                             "\"; use .mp4, .webm, .mkv or .mov");
  }
  for (const VideoCodec codec : wanted) {
    if (avcodec_find_encoder_by_name(encoder_of(codec)) != nullptr) return codec;
  }
  return make_error(Code::unsupported, "this FFmpeg has no video encoder for " +
                                           std::string(extension) +
                                           "; on Debian the package ffmpeg has");
}

struct VideoEncoder::Impl {
  VideoSettings settings;
  av::Codec codec;
  av::Sws scaler;
  av::Frame frame;
  av::Packet packet;
  EncodedVideo video;
  std::int64_t pushed = 0;
  bool finished = false;

  ~Impl() {
    const av::LogCapture log;  // libx264 says its statistics on closing
    codec.reset();
  }
  Result<void> send(const AVFrame* picture);
};

VideoEncoder::VideoEncoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoEncoder::VideoEncoder(VideoEncoder&&) noexcept = default;
VideoEncoder& VideoEncoder::operator=(VideoEncoder&&) noexcept = default;
VideoEncoder::~VideoEncoder() = default;

Result<VideoEncoder> VideoEncoder::open(const VideoSettings& settings) {
  return av::guarded([&]() -> Result<VideoEncoder> {
    if (auto legal = check(settings); !legal) return legal.error();
    const av::LogCapture log;
    auto impl = std::make_unique<Impl>();
    impl->settings = settings;
    Result<av::Codec> codec = open_codec(settings);
    if (!codec) return codec.error();
    impl->codec = std::move(*codec);
    Result<av::Sws> scaler = open_scaler(settings);
    if (!scaler) return scaler.error();
    impl->scaler = std::move(*scaler);
    impl->frame.reset(av_frame_alloc());
    impl->packet.reset(av_packet_alloc());
    if (!impl->frame || !impl->packet) return av::no_memory();
    const AVCodecContext& context = *impl->codec;
    impl->video = {
        settings.codec, settings.width, settings.height, settings.rate, {}, settings.alpha, {}};
    impl->video.config.assign(context.extradata, context.extradata + context.extradata_size);
    return VideoEncoder(std::move(impl));
  });
}

Result<void> VideoEncoder::Impl::send(const AVFrame* picture) {
  const av::LogCapture log;
  int status = avcodec_send_frame(codec.get(), picture);
  while (status >= 0) {
    status = avcodec_receive_packet(codec.get(), packet.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return {};
    if (status < 0) break;
    VideoPacket coded;
    coded.bytes.assign(packet->data, packet->data + packet->size);
    coded.key = (packet->flags & AV_PKT_FLAG_KEY) != 0;
    coded.time = packet->pts;
    std::size_t size = 0;
    // Behind a number of 8 bytes that names the kind of what follows: 1, alpha.
    constexpr auto kBeside = AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL;
    const std::uint8_t* beside = av_packet_get_side_data(packet.get(), kBeside, &size);
    if (beside != nullptr && size > 8) coded.alpha.assign(beside + 8, beside + size);
    video.packets.push_back(std::move(coded));
    av_packet_unref(packet.get());
  }
  return av::make_av_error(status, "the video cannot be encoded");
}

Result<void> VideoEncoder::push(std::span<const std::uint8_t> rgba) {
  return av::guarded([&]() -> Result<void> {
    Impl& impl = *impl_;
    const int width = impl.settings.width;
    const int height = impl.settings.height;
    if (impl.finished) return invalid("the video has been finished");
    if (rgba.size() != std::size_t(width) * std::size_t(height) * 4) {
      return invalid("the picture has not the size of the video");
    }
    AVFrame& frame = *impl.frame;
    frame.format = format_of(impl.settings);
    frame.width = width;
    frame.height = height;
    if (av_frame_get_buffer(&frame, 0) < 0) return av::no_memory();
    const std::array<const std::uint8_t*, 4> planes = {rgba.data(), nullptr, nullptr, nullptr};
    const std::array<int, 4> strides = {4 * width, 0, 0, 0};
    sws_scale(impl.scaler.get(), planes.data(), strides.data(), 0, height, frame.data,
              frame.linesize);
    const bool key = impl.pushed % impl.codec->gop_size == 0;
    frame.pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    frame.pts = impl.pushed++;
    frame.quality = impl.codec->global_quality;  // read by mpeg4 alone
    Result<void> sent = impl.send(&frame);
    av_frame_unref(&frame);
    return sent;
  });
}

Result<EncodedVideo> VideoEncoder::finish() {
  return av::guarded([&]() -> Result<EncodedVideo> {
    if (impl_->finished) return invalid("the video has been finished");
    impl_->finished = true;
    if (impl_->pushed == 0) return invalid("a video needs at least one picture");
    if (auto sent = impl_->send(nullptr); !sent) return sent.error();
    return std::move(impl_->video);
  });
}

}  // namespace animeme::media
