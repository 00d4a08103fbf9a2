#include "tools/app/commands/preview.h"

#include <algorithm>
#include <iterator>

#include "fap/rate_text.h"
#include "fap/turns.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/report.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::tools {

Result<int> write_preview(const std::string& path, const fap::Sequence& clip,
                          const media::MuxInput& sound, const studio::FilmOptions& options) {
  const Interrupt interrupt;
  ProgressLine line("rendering " + path);
  // Who looks at a film reads captions, not single words and phones.
  std::vector<media::TextTrack> captions;
  if (sound.texts != nullptr && media::takes_text(path)) {
    captions = *sound.texts;
    std::erase_if(captions, [](const auto& track) { return track.name == media::kCaptionTrack; });
    speech::add_captions(captions);
    std::erase_if(captions, [](const auto& track) { return track.name != media::kCaptionTrack; });
  }
  media::MuxInput tracks = sound;
  tracks.texts = &captions;
  const auto film = studio::write_film(
      path, clip, tracks, options, terminal_log(),
      {[&line](double done) { line.update(done); }, [] { return Interrupt::requested(); }});
  line.clear();
  if (!film) return film.error();
  const std::string rate = fap::format_rate(film->rate);
  report_output(path,
                std::to_string(film->pictures) + " pictures, " + std::to_string(film->width) + "x" +
                    std::to_string(film->height) + ", " + rate + " per second, " + film->codec,
                {{"pictures", film->pictures},
                 {"width", film->width},
                 {"height", film->height},
                 {"rate", rate},
                 {"codec", film->codec}});
  if (!film->stopped) return kOk;
  say(path + ": stopped; the file holds the first " + seconds_text(film->seconds));
  return kInterrupted;
}

Result<int> write_preview(const std::string& path, const fba::AccessUnits& face,
                          const media::MuxInput& sound) {
  Result<FaceInput> input = parse_face(fba::join_access_units(face), path);
  if (!input) return input.error();
  Result<fap::Sequence> clip = shown_face(*input, path, {.interpolate = true});
  if (!clip) return clip.error();
  fap::smooth_turns(*clip);
  media::MuxInput tracks = sound;
  tracks.face = nullptr;
  if (media::usual_codec(path) != media::AudioCodec::opus || sound.encoded == nullptr ||
      sound.encoded->format.codec == media::AudioCodec::opus) {
    return write_preview(path, *clip, tracks, {});
  }
  Result<media::Pcm> samples = media::decode_audio(*sound.encoded);
  if (!samples) return samples.error().in_file(path);
  tracks.encoded = nullptr;
  tracks.audio = &*samples;
  return write_preview(path, *clip, tracks, {});
}

void add_preview_option(OptionTable& cli, std::string& path) {
  cli.add("--preview", path,
          "Also render a video for ordinary players: .mp4 (H.264), .webm (VP9) or .webp "
          "(silent)")
      ->output(".mp4 .webm .mkv .webp", OutputKind::file);
}

}  // namespace animeme::tools
