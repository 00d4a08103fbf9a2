#include "tools/view/studio/film.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "tools/formats/files/files.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/video.h"
#include "tools/view/plot/strip.h"
#include "tools/view/studio/captions.h"
#include "tools/view/studio/gif.h"
#include "tools/view/studio/picture_file.h"

namespace animeme::studio {

namespace {

constexpr int kStripHeight = 128;
constexpr double kLongestPage = 6;  // seconds of curves in view

// Not what its header says, which may be wrong. A file that cannot be read is answered when it is
// written.
double seconds_of_file(const std::string& path) {
  Result<media::AudioReader> reader = media::AudioReader::open(path);
  if (!reader) return 0;
  std::size_t samples = 0;
  for (;;) {
    const Result<std::span<const float>> block = reader->next();
    if (!block || block->empty()) return double(samples) / reader->sample_rate();
    samples += block->size();
  }
}

double seconds_of(const media::MuxInput& sound) {
  if (sound.audio != nullptr) return sound.audio->duration();
  if (sound.audio_file != nullptr) return seconds_of_file(*sound.audio_file);
  if (sound.encoded == nullptr) return 0;
  return double(sound.encoded->length) / sound.encoded->format.sample_rate;
}

// Of the longest of them.
double seconds_of_faces(const fap::Sequence& clip, const FilmOptions& options) {
  double seconds = clip.duration();
  for (const StagePerson& person : options.people) {
    if (person.clip != nullptr) seconds = std::max(seconds, person.clip->duration());
  }
  return seconds;
}

// Encoders halve the colour, so sides are even.
int even(int side) { return side - side % 2; }

// Takes the pictures one by one, with their numbers.
using TakePicture = std::function<Result<void>(std::span<const std::uint8_t> rgba, std::int64_t)>;

// The film as it will be; `pictures` counts what was drawn when it ended.
Result<Film> render_all(const fap::Sequence& clip, double seconds, const FilmOptions& options,
                        const TakePicture& take, const tools::Log& log,
                        const tools::Progress& progress) {
  const HeadLook& look = options.look;
  const fap::Rate rate = options.rate.value_or(clip.rate);
  const bool has_strip = options.script != nullptr || !options.faps.empty();
  HeadLook above = look;  // the head keeps clear of the strip
  const int strip_height = has_strip ? std::min(kStripHeight, look.height / 3) : 0;
  above.height -= strip_height;
  std::vector<StagePerson> people = options.people;
  if (people.empty())
    people.push_back({.head = look.head, .clip = &clip, .visemes = options.visemes});
  Result<Stage> stage = Stage::make(above, std::move(people), log);
  if (!stage) return stage.error();
  plot::Strip strip(clip, {look.width, strip_height, options.faps, options.script,
                           std::clamp(seconds, 0.5, kLongestPage)});
  std::optional<CaptionPainter> captions;
  if (options.captions != nullptr) captions.emplace(*options.captions, above.width, above.height);
  std::vector<std::uint8_t> rgba;  // of the head with what is over and below it
  const auto pictures = std::int64_t(std::ceil(seconds * rate.frames_per_second() - 1e-6));
  Film out{.width = look.width, .height = look.height, .rate = rate};
  for (std::int64_t i = 0; i < std::max<std::int64_t>(pictures, 1); ++i) {
    if (i > 0 && progress.stop()) {
      out.stopped = true;
      break;
    }
    const double time = rate.seconds(double(i));
    const render::Image& image = stage->draw(time);
    Result<void> taken;
    if (has_strip || captions) {
      rgba = image.rgba;
      rgba.resize(std::size_t(look.width) * std::size_t(look.height) * 4);
      if (has_strip) {
        if (auto drawn = strip.draw(time, look.height, rgba); !drawn) return drawn.error();
      }
      if (captions) {
        if (auto drawn = captions->draw(time, rgba); !drawn) return drawn.error();
      }
      taken = take(rgba, i);
    } else {
      taken = take(image.rgba, i);
    }
    if (!taken) return taken.error();
    ++out.pictures;
    progress.at(double(i + 1) / double(pictures));
  }
  out.seconds = rate.seconds(double(out.pictures));
  return out;
}

Result<Film> write_video(const std::string& path, const fap::Sequence& clip,
                         const media::MuxInput& sound, const FilmOptions& options,
                         const tools::Log& log, const tools::Progress& progress) {
  Result<media::VideoCodec> codec = media::video_codec_for(tools::extension_of(path));
  if (!codec) return codec.error();
  const fap::Rate rate = options.rate.value_or(clip.rate);
  media::VideoSettings settings{*codec, options.look.width, options.look.height, rate,
                                options.quality};
  settings.alpha = options.look.background.kind == Background::Kind::none;
  Result<media::VideoEncoder> encoder = media::VideoEncoder::open(settings);
  if (!encoder) return encoder.error();
  Result<Film> film = render_all(
      clip, std::max(seconds_of_faces(clip, options), seconds_of(sound)), options,
      [&](std::span<const std::uint8_t> rgba, std::int64_t) { return encoder->push(rgba); }, log,
      progress);
  if (!film) return film;
  Result<media::EncodedVideo> video = encoder->finish();
  if (!video) return video.error();
  media::MuxInput input = sound;
  input.video = &*video;
  media::MuxOptions mux;
  mux.audio = {media::usual_codec(path), options.audio_bit_rate};
  Result<media::MuxResult> written = media::write_container(path, input, mux);
  if (!written) return written.error();
  film->codec = name_of(video->codec);
  return film;
}

// Without sound. `animation`: a Gif or an Animation.
template <class Pictures>
Result<Film> write_pictures(const std::string& path, const fap::Sequence& clip,
                            const FilmOptions& options, Pictures& animation, const char* codec,
                            const tools::Log& log, const tools::Progress& progress) {
  const fap::Rate rate = options.rate.value_or(clip.rate);
  const auto instant = [&](std::int64_t picture) {
    return int(std::lround(rate.seconds(double(picture)) * 1000));
  };
  Result<Film> film = render_all(
      clip, seconds_of_faces(clip, options), options,
      [&](std::span<const std::uint8_t> rgba, std::int64_t picture) {
        return animation.push(rgba, instant(picture));
      },
      log, progress);
  if (!film) return film;
  const auto file = animation.finish(instant(std::int64_t(film->pictures)));
  if (!file) return file.error();
  if (auto done = tools::write_file(path, *file); !done) return done.error();
  film->codec = codec;
  return film;
}

Result<Film> write_animation(const std::string& path, const fap::Sequence& clip,
                             const FilmOptions& options, const tools::Log& log,
                             const tools::Progress& progress) {
  const int quality = picture_quality(options.quality);
  if (tools::extension_of(path) == ".gif") {
    Gif gif(options.look.width, options.look.height, quality);
    return write_pictures(path, clip, options, gif, "animated GIF", log, progress);
  }
  Result<Animation> animation = Animation::open(options.look.width, options.look.height, quality);
  if (!animation) return animation.error();
  return write_pictures(path, clip, options, *animation, "animated WebP", log, progress);
}

// Where the number of the picture goes into the path.
struct NumberPlace {
  std::size_t at = 0;
  std::size_t length = 0;  // of "%04d"
  int digits = 0;
};

std::optional<NumberPlace> number_place(const std::string& path) {
  const std::size_t at = path.find('%');
  if (at == std::string::npos || path.find('%', at + 1) != std::string::npos) return std::nullopt;
  std::size_t end = at + 1;
  int digits = 0;
  if (end < path.size() && path[end] == '0') ++end;
  if (end < path.size() && path[end] >= '1' && path[end] <= '9') digits = path[end++] - '0';
  if (end >= path.size() || path[end] != 'd') return std::nullopt;
  return NumberPlace{at, end + 1 - at, digits};
}

Result<Film> write_sequence(const std::string& path, const fap::Sequence& clip,
                            const FilmOptions& options, const tools::Log& log,
                            const tools::Progress& progress) {
  const NumberPlace place = number_place(path).value_or(NumberPlace{});
  const auto name_of_picture = [&](std::int64_t number) {
    std::string digits = std::to_string(number);
    digits.insert(0, std::size_t(std::max(place.digits - int(digits.size()), 0)), '0');
    std::string name = path;
    return name.replace(place.at, place.length, digits);
  };
  Result<Film> film = render_all(
      clip, seconds_of_faces(clip, options), options,
      [&](std::span<const std::uint8_t> rgba, std::int64_t picture) -> Result<void> {
        const auto file = picture_of(
            {options.look.width, options.look.height, {rgba.begin(), rgba.end()}}, ".png");
        if (!file) return file.error();
        return tools::write_file(name_of_picture(picture + 1), *file);
      },
      log, progress);
  if (film) film->codec = "PNG";
  return film;
}

Result<Film> write_any(const std::string& path, const fap::Sequence& clip,
                       const media::MuxInput& sound, const FilmOptions& options,
                       const tools::Log& log, const tools::Progress& progress) {
  const std::string extension = tools::extension_of(path);
  if (options.look.background.kind == Background::Kind::none && !keeps_alpha(extension)) {
    return make_error(
        Code::unsupported,
        "a file of this kind has no transparency; write .webm, .mov, .webp (animated), or "
        "a .png a frame (frame_%04d.png)");
  }
  if (is_picture_sequence(path)) return write_sequence(path, clip, options, log, progress);
  return is_animation(extension) ? write_animation(path, clip, options, log, progress)
                                 : write_video(path, clip, sound, options, log, progress);
}

}  // namespace

bool is_picture_sequence(const std::string& path) {
  return tools::extension_of(path) == ".png" && number_place(path).has_value();
}

bool keeps_alpha(const std::string& extension) {
  return extension == ".webm" || extension == ".mov" || extension == ".webp" || extension == ".png";
}

bool is_animation(const std::string& extension) {
  return extension == ".webp" || extension == ".gif";
}

int picture_quality(int quality) { return std::clamp(100 - quality, 1, 100); }

bool is_film(const std::string& extension) {
  return extension == ".mp4" || extension == ".webm" || extension == ".mkv" ||
         extension == ".mov" || is_animation(extension);
}

Result<Film> write_film(const std::string& path, const fap::Sequence& clip,
                        const media::MuxInput& sound, const FilmOptions& options,
                        const tools::Log& log, const tools::Progress& progress) {
  if (clip.frames.empty()) return make_error(Code::not_found, "there is no frame to show");
  FilmOptions own = options;
  own.look.width = even(options.look.width);
  own.look.height = even(options.look.height);
  Result<Film> film = write_any(path, clip, sound, own, log, progress);
  if (!film) return film.error().in_file(path);
  return film;
}

}  // namespace animeme::studio
