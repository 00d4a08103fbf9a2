#include "tools/formats/media/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/ffmpeg/invalid.h"

namespace animeme::media {

namespace {

constexpr int kLargestSide = 32767;  // of the renderer's surfaces
constexpr int kLargestPicture = 16384, kLargestShown = 8192;
constexpr double kMostCut =
    16;  // of a picture that covers another: its area by the one that is seen
constexpr std::size_t kLargestPictureFile = 256u << 20;

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

// The only picture of a file.
Result<av::Frame> decoded(AVCodecContext& decoder, const void* bytes, std::size_t size,
                          const char* problem) {
  av::Packet packet(av_packet_alloc());
  av::Frame frame(av_frame_alloc());
  if (!packet || !frame || av_new_packet(packet.get(), int(size)) < 0) return av::no_memory();
  std::memcpy(packet->data, bytes, size);
  int status = avcodec_send_packet(&decoder, packet.get());
  // A decoder with threads of its own gives the picture at the end of the stream.
  if (status >= 0) status = avcodec_send_packet(&decoder, nullptr);
  if (status >= 0) status = avcodec_receive_frame(&decoder, frame.get());
  if (status < 0) return av::make_av_error(status, problem);
  return frame;
}

Result<av::Frame> draw(std::string_view svg) {
  Result<av::Codec> decoder = open(avcodec_find_decoder(AV_CODEC_ID_SVG), nullptr);
  if (!decoder) return decoder.error();
  Result<av::Frame> made =
      decoded(**decoder, svg.data(), svg.size(), "the drawing cannot be shown");
  if (!made) return made;
  av::Frame frame = std::move(*made);
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

Result<av::Frame> drawn_of(std::string_view svg) {
  if (svg.empty() || svg.size() > (64u << 20)) {
    return make_error(Code::out_of_range, "a drawing has 1 byte to 64 MB");
  }
  return draw(svg);
}

Result<av::Frame> rgb_of(std::string_view svg) {
  Result<av::Frame> drawn = drawn_of(svg);
  if (!drawn) return drawn.error();
  return to_rgb(**drawn);
}

// By the first bytes; AV_CODEC_ID_NONE: none of those that are read.
AVCodecID codec_of(std::span<const std::uint8_t> file) {
  const auto begins = [&](std::size_t at, std::string_view text) {
    return file.size() >= at + text.size() &&
           std::equal(text.begin(), text.end(), file.begin() + std::ptrdiff_t(at),
                      [](char a, std::uint8_t b) { return std::uint8_t(a) == b; });
  };
  if (begins(0, "\x89PNG")) return AV_CODEC_ID_PNG;
  if (begins(0, "\xFF\xD8\xFF")) return AV_CODEC_ID_MJPEG;
  if (begins(0, "RIFF") && begins(8, "WEBP")) return AV_CODEC_ID_WEBP;
  return AV_CODEC_ID_NONE;
}

// The picture in a size, R G B A.
Result<std::vector<std::uint8_t>> scaled(const AVFrame& frame, int width, int height) {
  const int flags = SWS_AREA | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT;
  const av::Sws sws(sws_getContext(frame.width, frame.height, AVPixelFormat(frame.format), width,
                                   height, AV_PIX_FMT_RGBA, flags, nullptr, nullptr, nullptr));
  if (!sws)
    return make_error(Code::unsupported, "the pixels of the picture are of an unknown kind");
  std::vector<std::uint8_t> out(std::size_t(width) * std::size_t(height) * 4);
  const std::array<std::uint8_t*, 4> planes = {out.data(), nullptr, nullptr, nullptr};
  const std::array<int, 4> strides = {4 * width, 0, 0, 0};
  sws_scale(sws.get(), frame.data, frame.linesize, 0, frame.height, planes.data(), strides.data());
  return out;
}

}  // namespace

Result<Pixels> svg_to_overlay(std::string_view svg) {
  return av::guarded([&]() -> Result<Pixels> {
    const av::LogCapture log;
    const Result<av::Frame> drawn = drawn_of(svg);
    if (!drawn) return drawn.error();
    const AVFrame& frame = **drawn;
    if (frame.format != AV_PIX_FMT_RGB32)
      return make_error(Code::unsupported, "the renderer returned an unknown pixel format");
    Pixels pixels{frame.width, frame.height, {}};
    pixels.rgba.reserve(std::size_t(frame.width) * std::size_t(frame.height) * 4);
    for (int y = 0; y < frame.height; ++y) {
      const std::uint8_t* row = frame.data[0] + std::ptrdiff_t(y) * frame.linesize[0];
      for (int x = 0; x < frame.width; ++x) {
        std::uint32_t argb = 0;
        std::memcpy(&argb, row + 4 * x, 4);
        for (const int shift : {16, 8, 0, 24}) pixels.rgba.push_back(std::uint8_t(argb >> shift));
      }
    }
    return pixels;
  });
}

Result<Pixels> svg_to_rgba(std::string_view svg) {
  Result<Pixels> pixels = svg_to_overlay(svg);
  if (!pixels) return pixels;
  for (std::size_t i = 3; i < pixels->rgba.size(); i += 4) pixels->rgba[i] = 255;
  return pixels;
}

Result<Pixels> covering_picture(std::span<const std::uint8_t> file, int width, int height) {
  return av::guarded([&]() -> Result<Pixels> {
    if (std::min(width, height) < 1 || std::max(width, height) > kLargestShown)
      return invalid("a background has 1 to 8192 pixels in width and height");
    if (file.size() > kLargestPictureFile)
      return make_error(Code::out_of_range, "the picture has more than 256 MB");
    const av::LogCapture log;
    const AVCodecID id = codec_of(file);
    if (id == AV_CODEC_ID_NONE)
      return make_error(Code::unsupported, "this is no PNG, JPEG or WebP picture");
    Result<av::Codec> decoder = open(avcodec_find_decoder(id), nullptr);
    if (!decoder) return decoder.error();
    const Result<av::Frame> frame =
        decoded(**decoder, file.data(), file.size(), "the picture cannot be decoded");
    if (!frame) return frame.error();
    const AVFrame& whole = **frame;
    if (whole.width < 1 || whole.height < 1 ||
        std::max(whole.width, whole.height) > kLargestPicture) {
      return make_error(Code::out_of_range,
                        "the picture has more than 16384 pixels in width or height");
    }
    const double scale = std::max(double(width) / whole.width, double(height) / whole.height);
    // A stripe would grow to a picture of any size.
    const double wide = std::max(std::round(whole.width * scale), double(width));
    const double high = std::max(std::round(whole.height * scale), double(height));
    if (wide * high > kMostCut * width * height)
      return make_error(Code::out_of_range, "the picture is too narrow to fill the background");
    const auto all = scaled(whole, int(wide), int(high));
    if (!all) return all.error();
    Pixels pixels{width, height, {}};
    pixels.rgba.reserve(std::size_t(width) * std::size_t(height) * 4);
    const auto left = std::size_t(int(wide) - width) / 2, top = std::size_t(int(high) - height) / 2;
    for (std::size_t y = 0; y < std::size_t(height); ++y) {
      const auto row = all->begin() + std::ptrdiff_t(((top + y) * std::size_t(wide) + left) * 4);
      pixels.rgba.insert(pixels.rgba.end(), row, row + std::ptrdiff_t(4 * width));
    }
    for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) pixels.rgba[i] = 255;
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
