#include "tools/studio/film.h"

#include <algorithm>
#include <cmath>

#include "tools/files/files.h"
#include "tools/media/video.h"
#include "tools/plot/strip.h"

namespace animeme::studio {

namespace {

constexpr int kStripHeight = 128;
constexpr double kLongestPage = 6;  // seconds of curves in view

double seconds_of(const media::MuxInput& sound) {
  if (sound.audio != nullptr) return sound.audio->duration();
  if (sound.encoded == nullptr) return 0;
  return double(sound.encoded->length) / sound.encoded->format.sample_rate;
}

// The face at `seconds`: between two frames, in proportion.
fap::Frame face_at(const fap::Sequence& clip, double seconds) {
  const double at = seconds * clip.rate.frames_per_second();
  const auto last = clip.frames.size() - 1;
  // A picture that falls on a frame shows it exactly.
  const auto index = std::size_t(std::clamp(std::floor(at + 1e-6), 0.0, double(last)));
  fap::Frame frame = clip.frames[index];
  const double share = at - double(index);
  if (index == last || share < 1e-3 || frame.mask[1] || frame.mask[2]) return frame;
  const fap::Frame& next = clip.frames[index + 1];
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const double value = frame.value[fap] + share * (double(next.value[fap]) - frame.value[fap]);
    frame.value[fap] = std::int32_t(std::lround(value));
  }
  return frame;
}

// Encoders halve the colour, so sides are even.
int even(int side) { return side - side % 2; }

struct Rendered {
  media::EncodedVideo video;
  bool stopped = false;
};

Result<Rendered> render_all(const std::string& path, const fap::Sequence& clip, double seconds,
                            const FilmOptions& options, const tools::Talk& talk,
                            const tools::Progress& progress) {
  Result<media::VideoCodec> codec = media::video_codec_for(tools::extension_of(path));
  if (!codec) return codec.error();
  HeadLook look = options.look;
  look.width = even(look.width);
  look.height = even(look.height);
  const fap::Rate rate = options.rate.value_or(clip.rate);
  Result<media::VideoEncoder> encoder =
      media::VideoEncoder::open({*codec, look.width, look.height, rate, options.quality});
  if (!encoder) return encoder.error();
  const bool has_strip = options.script != nullptr || !options.faps.empty();
  HeadLook above = look;  // the head keeps clear of the strip
  const int strip_height = has_strip ? std::min(kStripHeight, look.height / 3) : 0;
  above.height -= strip_height;
  Result<HeadView> view = HeadView::make(above, talk);
  if (!view) return view.error();
  plot::Strip strip(clip, {look.width, strip_height, options.faps, options.script,
                           std::clamp(seconds, 0.5, kLongestPage)});
  const auto pictures = std::int64_t(std::ceil(seconds * rate.frames_per_second() - 1e-6));
  Rendered out;
  for (std::int64_t i = 0; i < std::max<std::int64_t>(pictures, 1); ++i) {
    if (i > 0 && progress.stop()) {
      out.stopped = true;
      break;
    }
    const double time = rate.seconds(double(i));
    const render::Image& image = view->draw(face_at(clip, time));
    Result<void> pushed;
    if (has_strip) {
      std::vector<std::uint8_t> rgba = image.rgba;
      rgba.resize(std::size_t(look.width) * std::size_t(look.height) * 4);
      if (auto drawn = strip.draw(time, look.height, rgba); !drawn) return drawn.error();
      pushed = encoder->push(rgba);
    } else {
      pushed = encoder->push(image.rgba);
    }
    if (!pushed) return pushed.error();
    progress.at(double(i + 1) / double(pictures));
  }
  Result<media::EncodedVideo> video = encoder->finish();
  if (!video) return video.error();
  out.video = std::move(*video);
  return out;
}

}  // namespace

bool is_film(const std::string& extension) {
  return extension == ".mp4" || extension == ".webm" || extension == ".mkv";
}

Result<Film> write_film(const std::string& path, const fap::Sequence& clip,
                        const media::MuxInput& sound, const FilmOptions& options,
                        const tools::Talk& talk, const tools::Progress& progress) {
  if (clip.frames.empty()) return make_error(Code::not_found, "there is no frame to show");
  const double seconds = std::max(clip.duration(), seconds_of(sound));
  Result<Rendered> rendered = render_all(path, clip, seconds, options, talk, progress);
  if (!rendered) return rendered.error().in_file(path);
  const media::EncodedVideo& video = rendered->video;
  media::MuxInput input = sound;
  input.video = &video;
  media::MuxOptions mux;
  mux.audio = {media::usual_codec(path), options.audio_bit_rate};
  Result<media::MuxResult> written = media::write_container(path, input, mux);
  if (!written) return written.error().in_file(path);
  return Film{.pictures = video.packets.size(),
              .width = video.width,
              .height = video.height,
              .rate = video.rate,
              .codec = name_of(video.codec),
              .seconds = video.rate.seconds(double(video.packets.size())),
              .stopped = rendered->stopped};
}

}  // namespace animeme::studio
