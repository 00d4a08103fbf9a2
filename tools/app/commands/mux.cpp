#include "tools/formats/media/mux.h"
#include "tools/app/commands/bounds.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/preview.h"
#include "tools/formats/media/container.h"
#include "tools/live/sessions/clip.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::tools {

namespace {

struct MuxOptions {
  std::string face;
  std::string audio;
  std::string output;
  StreamSettings stream;
  std::string preview;
  bool copy = false;
  bool video_track = false;
  bool subtitles = false;
  SoundSettings sound;
  media::MuxOptions mux;
};

bool in_segments(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".m3u8" || extension == ".mpd";
}

// A segment begins where playing can begin, so a stream with one such point would be one segment.
Result<fba::AccessUnits> for_segments(fba::AccessUnits units, const MuxOptions& options) {
  const double longest = live::longest_intra_interval(units);
  if (options.copy) {
    if (longest > options.mux.fragment_seconds + options.stream.intra_seconds) {
      warn(options.face + ": segments last up to " + seconds_text(longest) +
           ", as far as its intra planes are apart; without --copy it is coded again");
    }
    return units;
  }
  const Result<fba::DecodedStream> decoded = fba::decode(fba::join_access_units(units));
  if (!decoded) return decoded.error();
  live::Coding coding;
  coding.intra_seconds = std::max(options.stream.intra_seconds, options.mux.fragment_seconds);
  auto again = live::with_joints(units, *decoded, coding);
  if (!again) return again.error();
  if (!*again) return units;
  say(options.face + ": coded again, so that a segment can begin every " +
      seconds_text(coding.intra_seconds) + "; --copy keeps it as it is");
  return std::move(**again);
}

// A face out of a container keeps its times, which its planes alone would not tell.
Result<fba::AccessUnits> read_units(const MuxOptions& options) {
  Result<std::vector<std::uint8_t>> bytes = read_input(options.face);
  if (!bytes) return bytes.error();
  if (kind_of(*bytes) == FileKind::media) {
    Result<media::Container> container = open_container(*bytes, options.face);
    if (!container) return container.error();
    for (const std::string& text : container->warnings) warn(options.face + ": " + text);
    return std::move(container->face);
  }
  Result<FaceInput> face = parse_face(std::move(*bytes), options.face);
  if (!face) return face.error();
  return access_units(*face, options.stream);
}

// Samples only where they are needed twice: a file is decoded while it is written.
Result<speech::SoundInput> sound_of(const MuxOptions& options) {
  speech::SoundInput sound;
  if (options.sound.codec == "copy") {
    Result<media::EncodedAudio> coded = media::read_encoded_audio(options.audio);
    if (!coded) return coded.error().in_file(options.audio);
    sound.coded = std::move(*coded);
    return sound;
  }
  if (options.preview.empty()) return sound;
  Result<media::Pcm> samples = speech::read_voice(options.audio, terminal_log());
  if (!samples) return samples.error();
  sound.samples = std::move(*samples);
  return sound;
}

Result<int> run(MuxOptions options) {
  Result<fba::AccessUnits> units = read_units(options);
  if (!units) return units.error().in_file(options.face);
  const bool one_point = options.stream.intra_seconds == 0;  // is asked for
  if (in_segments(options.output) && !one_point) {
    units = for_segments(std::move(*units), options);
    if (!units) return units.error().in_file(options.face);
  }
  const Result<speech::SoundInput> sound = sound_of(options);
  if (!sound) return sound.error();
  media::MuxInput input;
  input.face = &*units;
  sound->give_to(input);
  std::vector<media::TextTrack> texts;  // go with a face that is spoken to them
  if (!options.mux.systems && media::takes_text(options.output)) {
    texts = speech::carried_tracks(options.face, terminal_log());
    input.texts = &texts;
  }
  if (!sound->coded && !sound->samples) input.audio_file = &options.audio;
  options.mux.audio = audio_settings(options.sound, options.output);
  if (!options.subtitles) options.mux.text_track = media::TextTrackType::metadata;
  if (options.video_track) options.mux.face_track = media::FaceTrackType::video;
  Result<int> written = write_media(options.output, input, options.mux);
  if (!written || *written != kOk || options.preview.empty()) return written;
  return write_preview(options.preview, *units, input);
}

void add_options(CLI::App& app, MuxOptions& options) {
  app.add_option("face", options.face, "FAP text, FBA stream, or a container with a face")
      ->required();
  app.add_option("audio", options.audio, "Sound in any format that FFmpeg reads")->required();
  add_output(app.add_option("-o,--output", options.output,
                            "File to write: .mp4, .mkv, .ts; .m3u8 (HLS) or .mpd (DASH) with a "
                            "folder of segments beside it"),
             {})
      ->required();
  add_stream_options(app, options.stream);
  app.add_flag("--copy", options.copy,
               "HLS and DASH: keep a stream as it is, however far the points where playing can "
               "begin are apart; else it is coded again with --intra-seconds");
  add_sound_options(app, options.sound, true);
  CLI::Option* fragmented =
      app.add_flag("--fragmented", options.mux.fragmented,
                   "mp4: in fragments, so that a reader can begin before the file is complete");
  app.add_option("--fragment-seconds", options.mux.fragment_seconds,
                 "Length of fragments and of segments (.m3u8, .mpd), seconds")
      ->check(between(0.02, 600.0))
      ->capture_default_str();
  app.add_option(
         "--pes-seconds", options.mux.shared_seconds,
         "ts: planes of so many seconds share a packet, and tables come half a second apart: a "
         "fraction of the bytes, but few readers part the planes again; 0: a packet a plane")
      ->check(between(0.0, 2.0))
      ->capture_default_str();
  app.add_flag("--systems", options.mux.systems,
               "mp4: add the scene and object streams of a complete MPEG-4 Systems presentation")
      ->excludes(fragmented);
  app.add_flag(
      "--video-track", options.video_track,
      "mp4, HLS, DASH: the face as a video track (handler vide, entry mp4v), where readers "
      "of MPEG-4 look for it; programs that convert take it for a film that they cannot "
      "decode. Without: as timed metadata, which they leave alone");
  add_subtitles_option(app, options.subtitles);
  add_preview_option(app, options.preview);
}

}  // namespace

const Command kMux{"mux", "Put a face and a voice into one file",
                   "  animeme mux talk.fba voice.wav -o talk.mp4\n"
                   "  animeme mux talk.fap voice.flac --quant 2 -o talk.mkv\n"
                   "  animeme mux talk.fba voice.wav --audio-codec opus --fragmented -o talk.mp4\n"
                   "  animeme mux talk.mp4 talk.mp4 --audio-codec copy -o talk.ts\n"
                   "  animeme mux talk.fba voice.wav --pes-seconds 0.4 -o talk.ts\n"
                   "  animeme mux talk.fba voice.wav --fragment-seconds 4 -o talk.m3u8\n"
                   "  animeme mux talk.fba voice.wav --systems -o scene.mp4\n"
                   "  animeme mux talk.fba voice.wav -o talk.mp4 --preview talk.preview.mp4",
                   set_up<MuxOptions>};

}  // namespace animeme::tools
