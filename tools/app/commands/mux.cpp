#include "tools/formats/media/mux.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>

#include "codec/encode/long_clip.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"
#include "tools/app/commands/preview.h"
#include "tools/app/commands/track_option.h"
#include "tools/formats/files/cost.h"
#include "tools/formats/media/container.h"
#include "tools/formats/programs/scratch_folder.h"
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
  std::vector<std::string> tracks;  // --track
};

bool in_segments(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".m3u8" || extension == ".mpd";
}

// A segment begins where playing can begin, so a stream with one such point would be one segment.
// `coded`: the input was, so that limits of error or rate have not been applied yet.
Result<fba::AccessUnits> for_segments(fba::AccessUnits units, bool coded,
                                      const MuxOptions& options) {
  const double longest = live::longest_intra_interval(units);
  if (options.copy) {
    if (longest > options.mux.fragment_seconds + options.stream.intra_seconds) {
      warn(options.face + ": segments last up to " + seconds_text(longest) +
           ", the longest interval between its intra planes; without --copy it is encoded again");
    }
    return units;
  }
  const Result<fba::DecodedStream> decoded = fba::decode(fba::join_access_units(units));
  if (!decoded) return decoded.error();
  live::Coding coding;
  coding.intra_seconds = std::max(options.stream.intra_seconds, options.mux.fragment_seconds);
  if (coded) give_limits(options.stream, coding);
  auto again = live::with_joints(units, *decoded, coding);
  if (!again) return again.error();
  if (!*again) return units;
  say(options.face + ": encoded again, so that a segment can start every " +
      seconds_text(coding.intra_seconds) + "; --copy keeps it");
  return std::move(**again);
}

// A face that is written while it is read.
struct LongFace {
  std::optional<fba::UnitReader> units;   // nullopt: the face has to be in memory
  std::unique_ptr<ScratchFolder> folder;  // where it is, if it was made of text
};

Result<LongFace> read_long_stream(const std::string& path,
                                  std::unique_ptr<ScratchFolder> folder = nullptr) {
  Result<fba::UnitReader> units = open_units(path);
  if (!units) return units.error();
  return LongFace{std::move(*units), std::move(folder)};
}

Result<LongFace> code_long_text(const MuxOptions& options) {
  const Result<FapFile> text = FapFile::open(options.face);
  if (!text) return text.error();
  Result<std::unique_ptr<ScratchFolder>> folder = ScratchFolder::make();
  if (!folder) return folder.error();
  const std::string stream = (*folder)->file("face.fba");
  const fap::Rate rate = text->survey().rate;
  const fba::ClipSource source{
      rate, [&text](const fba::TakeInstant& take) {
        return text->for_each([&](const fap::Frame& frame) { return take(&frame, nullptr); });
      }};
  AtStep step(Step::coding);
  std::ofstream out(stream, std::ios::binary);
  std::size_t size = 0;
  const auto coded = fba::encode_long(
      source, unit_options(options.stream, rate), [&](std::span<const std::uint8_t> bytes) {
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        size += bytes.size();
        return Result<void>();
      });
  if (!coded) return coded.error();
  if (options.stream.default_ranges) warn_of_default_ranges(coded->default_ranges);
  out.close();
  if (!out) return make_error(Code::io, "cannot write the file").in_file(stream);
  step.made(size);
  return read_long_stream(stream, std::move(*folder));
}

// Out of a container, with its times.
Result<LongFace> keep_face(const std::string& path) {
  auto units = media::store_face(path);
  if (!units || !*units) return LongFace();  // what there is to say is told when it is read
  return LongFace{std::move(**units), nullptr};
}

// An intact stream, a text, or a container.
Result<LongFace> read_long_face(const MuxOptions& options) {
  const bool whole = in_segments(options.output) || options.mux.systems ||
                     options.mux.shared_seconds > 0 || !options.preview.empty();
  if (whole) return LongFace();
  if (FapFile::can_read(options.face)) return code_long_text(options);
  if (!PlaneFile::can_read(options.face)) {
    return is_on_disk(options.face) ? keep_face(options.face) : LongFace();
  }
  bool faces = false;
  std::vector<std::string> warnings;
  const auto note = [&faces](const fba::Plane& plane) {
    faces = faces || fba::has_face(plane.object_mask);
    return Result<void>();
  };
  const auto read = PlaneFile(options.face).for_each(note, &warnings);
  if (!read || !warnings.empty() || !faces) return LongFace();
  return read_long_stream(options.face);
}

// A face out of a container keeps its times, which its planes alone would not tell.
// `coded` receives whether it is a stream.
Result<fba::AccessUnits> read_units(const MuxOptions& options, bool& coded) {
  Result<std::vector<std::uint8_t>> bytes = read_input(options.face);
  if (!bytes) return bytes.error();
  if (kind_of(*bytes) == FileKind::media) {
    Result<media::Container> container = open_container(*bytes, options.face);
    if (!container) return container.error();
    return std::move(container->face);
  }
  Result<FaceInput> face = parse_face(std::move(*bytes), options.face);
  if (!face) return face.error();
  coded = !face->stream.empty();
  return access_units(*face, options.stream);
}

// Coded sound that is read while it is written.
bool keeps_sound(const MuxOptions& options) {
  return !options.audio.empty() && options.sound.codec == "copy" && options.preview.empty();
}

// Samples only of what is needed twice and cannot be read twice, a pipe: a file is decoded while it
// is written, with both of its channels.
Result<speech::SoundInput> sound_of(const MuxOptions& options) {
  speech::SoundInput sound;
  if (options.audio.empty() || keeps_sound(options)) return sound;
  if (options.sound.codec == "copy") {
    Result<media::EncodedAudio> coded = media::read_encoded_audio(options.audio);
    if (!coded) return coded.error().in_file(options.audio);
    sound.coded = std::move(*coded);
    return sound;
  }
  std::error_code status;
  const bool file = std::filesystem::is_regular_file(options.audio, status);
  if (options.preview.empty() || file) return sound;
  Result<media::Pcm> samples = speech::read_voice(options.audio, terminal_log());
  if (!samples) return samples.error();
  sound.samples = std::move(*samples);
  return sound;
}

// As a whole, as read_long_face() leaves it to be.
Result<fba::AccessUnits> read_whole_face(const MuxOptions& options) {
  bool coded = true;
  Result<fba::AccessUnits> units = read_units(options, coded);
  const bool one_point = options.stream.intra_seconds == 0;  // is asked for
  if (!units || !in_segments(options.output) || one_point) return units;
  return for_segments(std::move(*units), coded, options);
}

// Into one of them, to which the input refers.
Result<void> give_face(const MuxOptions& options, LongFace& long_face, fba::AccessUnits& units,
                       media::MuxInput& input) {
  Result<LongFace> streamed = read_long_face(options);
  if (!streamed) return streamed.error().in_file(options.face);
  long_face = std::move(*streamed);
  if (long_face.units) {
    input.face_units = &*long_face.units;
    return {};
  }
  Result<fba::AccessUnits> whole = read_whole_face(options);
  if (!whole) return whole.error().in_file(options.face);
  units = std::move(*whole);
  input.face = &units;
  return {};
}

// A language or a person of --track: files, and what tells them apart.
struct MuxTrack {
  std::string face, audio, words;  // paths; empty: none
  media::TrackLabels labels;
};

Result<MuxTrack> read_mux_track(const std::string& text) {
  MuxTrack track;
  std::string labels;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view before = rest;
    const std::string one = media::next_label(rest);
    const std::size_t equals = one.find('=');
    const std::string name = one.substr(0, equals);
    std::string* place = name == "face"    ? &track.face
                         : name == "audio" ? &track.audio
                         : name == "words" ? &track.words
                                           : nullptr;
    if (place == nullptr) {
      // As it is written, with its backslashes.
      std::string_view part = before.substr(0, before.size() - rest.size());
      if (!rest.empty() && part.ends_with(',')) part.remove_suffix(1);
      labels += (labels.empty() ? "" : ",") + std::string(part);
    } else if (equals == std::string::npos || equals + 1 == one.size() || !place->empty()) {
      return make_error(Code::invalid_argument,
                        "'" + one + "' needs one file behind " + name + "=");
    } else {
      *place = one.substr(equals + 1);
    }
  }
  if (track.face.empty() && track.audio.empty() && track.words.empty()) {
    return make_error(Code::invalid_argument,
                      "'" + text + "' names no file; write face=, audio= or words=");
  }
  if (labels.empty()) {
    return make_error(Code::invalid_argument,
                      "'" + text + "' tells no language and no speaker; write lang= or speaker=");
  }
  const auto told = read_track_labels(labels);
  if (!told) return told.error();
  track.labels = *told;
  return track;
}

// What a part of the file is written from; the input refers to it.
struct MuxPart {
  LongFace long_face;
  fba::AccessUnits face;  // in place of it
  std::string audio;
  std::optional<media::StoredAudio> coded;
  std::vector<media::TextTrack> texts;
};

Result<void> read_part(const MuxTrack& track, const MuxOptions& options, MuxPart& part,
                       media::MuxInput& input) {
  input.labels = track.labels;
  if (!track.face.empty()) {
    MuxOptions one = options;
    one.face = track.face;
    if (auto read = give_face(one, part.long_face, part.face, input); !read) return read;
  }
  if (!track.audio.empty() && options.sound.codec == "copy") {
    auto coded = media::StoredAudio::read(track.audio);
    if (!coded) return coded.error().in_file(track.audio);
    input.stored = &part.coded.emplace(std::move(*coded));
  } else if (!track.audio.empty()) {
    part.audio = track.audio;
    input.audio_file = &part.audio;
  }
  if (!track.words.empty() && !media::takes_text(options.output)) {
    warn(track.words + ": " + extension_of(options.output) +
         " files carry no words; .mp4, .mkv and .m3u8 do");
  } else if (!track.words.empty()) {
    speech::ScriptInput reading;
    if (!track.labels.language.empty()) reading.language = track.labels.language;
    const auto script = speech::read_script(track.words, reading, terminal_log());
    if (!script) return script.error();
    part.texts = speech::carried_texts(*script, track.labels.language);
  } else if (!track.face.empty()) {
    part.texts = speech::carried_tracks(track.face, terminal_log());
  }
  if (shows_captions(options.output, options.subtitles)) speech::add_captions(part.texts);
  if (media::takes_text(options.output)) input.texts = &part.texts;
  return {};
}

Result<int> write_tracks(MuxOptions& options) {
  std::vector<MuxPart> parts(options.tracks.size());
  media::MuxInput input;
  input.more.resize(options.tracks.size() - 1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto track = read_mux_track(options.tracks[i]);
    if (!track) return track.error();
    media::MuxInput& place = i == 0 ? input : input.more[i - 1];
    if (auto read = read_part(*track, options, parts[i], place); !read) return read.error();
  }
  options.mux.audio = audio_settings(options.sound, options.output);
  options.mux.text_track = media::TextTrackType::metadata;
  if (options.video_track) options.mux.face_track = media::FaceTrackType::video;
  return write_media(options.output, input, options.mux);
}

Result<int> run(MuxOptions options) {
  if (options.face.empty() == options.tracks.empty()) {
    return usage_error("name one face to write, or each with its language by --track lang=");
  }
  if (!options.tracks.empty()) {
    if (!options.preview.empty()) return usage_error("--preview is for files of one face");
    return write_tracks(options);
  }
  media::MuxInput input;
  LongFace long_face;
  fba::AccessUnits units;
  if (auto read = give_face(options, long_face, units, input); !read) return read.error();
  const Result<speech::SoundInput> sound = sound_of(options);
  if (!sound) return sound.error();
  sound->give_to(input);
  std::optional<media::StoredAudio> stored;
  if (keeps_sound(options)) {
    auto coded = media::StoredAudio::read(options.audio);
    if (!coded) return coded.error().in_file(options.audio);
    input.stored = &stored.emplace(std::move(*coded));
  }
  std::vector<media::TextTrack> texts;  // go with a face that is spoken to them
  if (!options.mux.systems && media::takes_text(options.output)) {
    texts = speech::carried_tracks(options.face, terminal_log());
    if (shows_captions(options.output, options.subtitles)) speech::add_captions(texts);
    input.texts = &texts;
  }
  const bool from_file = !options.audio.empty() && !sound->coded && !sound->samples && !stored;
  if (from_file) input.audio_file = &options.audio;
  options.mux.audio = audio_settings(options.sound, options.output);
  options.mux.text_track = media::TextTrackType::metadata;
  if (options.video_track) options.mux.face_track = media::FaceTrackType::video;
  Result<int> written = write_media(options.output, input, options.mux);
  if (!written || *written != kOk || options.preview.empty()) return written;
  return write_preview(options.preview, units, input);
}

void add_options(OptionTable& cli, MuxOptions& options) {
  cli.add("face", options.face, "FAP text, FBA stream, or a container with a face");
  cli.add("audio", options.audio, "Sound in any format that FFmpeg reads; default: none");
  cli.add("-o,--output", options.output,
          "File to write: .mp4, .mkv, .ts; .m3u8 (HLS) or .mpd (DASH) with a folder of "
          "segments beside it")
      ->output("")
      ->required();
  cli.add("--track", options.tracks,
          "A language or a person of a file with several, in place of the arguments, separated by "
          "commas: lang=de and speaker=Ann, then face=de.fba, audio=de.wav and words=de.vtt (a "
          "comma "
          "in a name is \\,); may be repeated, the first is the default (.mp4 .mkv .m3u8 .mpd; up "
          "to "
          "six languages in .ts)")
      ->value("LABELS,FILES")
      ->check(problem_of<read_mux_track>)
      ->one_at_a_time();
  add_stream_options(cli, options.stream);
  cli.add("--copy", options.copy,
          "HLS and DASH: keep the stream however long its intra intervals are; by default it "
          "is encoded again with --intra-seconds");
  add_sound_options(cli, options.sound, true);
  cli.add("--fragmented", options.mux.fragmented,
          "mp4: write fragments, so that reading can start before the file is complete");
  cli.add("--fragment-seconds", options.mux.fragment_seconds,
          "Length of fragments and of segments (.m3u8, .mpd), seconds")
      ->between(0.02, 600.0)
      ->show_default();
  cli.add("--pes-seconds", options.mux.shared_seconds,
          "ts: put the planes of so many seconds into a packet, and tables half a second "
          "apart: much smaller, but few readers split the planes again; 0: a packet per plane")
      ->between(0.0, 2.0)
      ->show_default();
  cli.add("--systems", options.mux.systems,
          "mp4: add the scene and object streams of a complete MPEG-4 Systems presentation")
      ->excludes("--fragmented");
  cli.add(
      "--video-track", options.video_track,
      "mp4, HLS, DASH: write the face as a video track (handler vide, entry mp4v), where MPEG-4 "
      "readers look for it; converters take it for a video that they cannot decode. Default: "
      "timed metadata, which they leave alone");
  add_subtitles_option(cli, options.subtitles);
  add_preview_option(cli, options.preview);
}

}  // namespace

const Command kMux{"mux", "Mux a face and sound into one file",
                   "  animeme mux talk.fba voice.wav -o talk.mp4\n"
                   "  animeme mux talk.fba -o face.mp4                # without sound\n"
                   "  animeme mux talk.fap voice.flac --quant 2 -o talk.mkv\n"
                   "  animeme mux talk.fba voice.wav --audio-codec opus --fragmented -o talk.mp4\n"
                   "  animeme mux talk.mp4 talk.mp4 --audio-codec copy -o talk.ts\n"
                   "  animeme mux talk.fba voice.wav --pes-seconds 0.4 -o talk.ts\n"
                   "  animeme mux talk.fba voice.wav --fragment-seconds 4 -o talk.m3u8\n"
                   "  animeme mux --track lang=en,face=en.fba,audio=en.wav --track "
                   "lang=de,face=de.fba,audio=de.wav -o both.mp4\n"
                   "  animeme mux talk.fba voice.wav --systems -o scene.mp4\n"
                   "  animeme mux talk.fba voice.wav -o talk.mp4 --preview talk.preview.mp4",
                   set_up<MuxOptions>};

}  // namespace animeme::tools
