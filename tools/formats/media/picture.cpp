#include "tools/formats/media/picture.h"

#include <cstring>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"

namespace animeme::media {

namespace {

constexpr int kLargestSide = 32767;  // of the renderer's surfaces

Result<av::Codec> open(const AVCodec* codec, const AVFrame* like) {
  if (codec == nullptr) {
    return make_error(Code::unsupported,
                      "this FFmpeg cannot draw SVG or write PNG; write the picture as .svg");
  }
  av::Codec context(avcodec_alloc_context3(codec));
  if (!context) return av::no_memory();
  context->thread_count = 1;
  context->time_base = {1, 1};
  if (like != nullptr) {
    context->width = like->width;
    context->height = like->height;
    context->pix_fmt = AVPixelFormat(like->format);
  }
  const int status = avcodec_open2(context.get(), codec, nullptr);
  if (status < 0) return av::make_av_error(status, "the picture cannot be made");
  return context;
}

Result<av::Frame> draw(std::string_view svg) {
  Result<av::Codec> decoder = open(avcodec_find_decoder(AV_CODEC_ID_SVG), nullptr);
  if (!decoder) return decoder.error();
  av::Packet packet(av_packet_alloc());
  av::Frame frame(av_frame_alloc());
  if (!packet || !frame || av_new_packet(packet.get(), int(svg.size())) < 0) {
    return av::no_memory();
  }
  std::memcpy(packet->data, svg.data(), svg.size());
  int status = avcodec_send_packet(decoder->get(), packet.get());
  if (status >= 0) status = avcodec_receive_frame(decoder->get(), frame.get());
  if (status < 0) return av::make_av_error(status, "the drawing cannot be shown");
  if (frame->width > kLargestSide || frame->height > kLargestSide) {
    return make_error(Code::out_of_range, "the picture is too large; write it as .svg");
  }
  return frame;
}

// The renderer's 32-bit pixels without their transparency.
Result<av::Frame> to_rgb(const AVFrame& drawn) {
  if (drawn.format != AV_PIX_FMT_RGB32) {
    return make_error(Code::unsupported, "the renderer returned an unknown pixel format");
  }
  av::Frame frame(av_frame_alloc());
  if (!frame) return av::no_memory();
  frame->format = AV_PIX_FMT_RGB24;
  frame->width = drawn.width;
  frame->height = drawn.height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) {
    return av::no_memory();
  }
  for (int y = 0; y < drawn.height; ++y) {
    const std::uint8_t* from = drawn.data[0] + std::ptrdiff_t(y) * drawn.linesize[0];
    std::uint8_t* to = frame->data[0] + std::ptrdiff_t(y) * frame->linesize[0];
    for (int x = 0; x < drawn.width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, from + 4 * x, 4);
      for (int c = 0; c < 3; ++c) to[3 * x + c] = std::uint8_t(pixel >> (16 - 8 * c));
    }
  }
  return frame;
}

Result<av::Frame> rgb_of(std::string_view svg) {
  if (svg.empty() || svg.size() > (64u << 20)) {
    return make_error(Code::out_of_range, "a drawing has 1 byte to 64 MB");
  }
  Result<av::Frame> drawn = draw(svg);
  if (!drawn) return drawn.error();
  return to_rgb(**drawn);
}

}  // namespace

Result<Pixels> svg_to_rgba(std::string_view svg) {
  return av::guarded([&]() -> Result<Pixels> {
    const av::LogCapture log;
    Result<av::Frame> rgb = rgb_of(svg);
    if (!rgb) return rgb.error();
    const AVFrame& frame = **rgb;
    Pixels pixels{frame.width, frame.height, {}};
    pixels.rgba.reserve(std::size_t(frame.width) * std::size_t(frame.height) * 4);
    for (int y = 0; y < frame.height; ++y) {
      const std::uint8_t* row = frame.data[0] + std::ptrdiff_t(y) * frame.linesize[0];
      for (int x = 0; x < frame.width; ++x) {
        pixels.rgba.insert(pixels.rgba.end(), {row[3 * x], row[3 * x + 1], row[3 * x + 2], 255});
      }
    }
    return pixels;
  });
}

Result<std::vector<std::uint8_t>> svg_to_png(std::string_view svg) {
  const av::LogCapture log;
  Result<av::Frame> rgb = rgb_of(svg);
  if (!rgb) return rgb.error();
  Result<av::Codec> encoder = open(avcodec_find_encoder(AV_CODEC_ID_PNG), rgb->get());
  if (!encoder) return encoder.error();
  av::Packet packet(av_packet_alloc());
  if (!packet) return av::no_memory();
  int status = avcodec_send_frame(encoder->get(), rgb->get());
  if (status >= 0) status = avcodec_receive_packet(encoder->get(), packet.get());
  if (status < 0) return av::make_av_error(status, "the picture cannot be written as PNG");
  return std::vector<std::uint8_t>(packet->data, packet->data + packet->size);
}

}  // namespace animeme::media
