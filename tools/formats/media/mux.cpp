#include "tools/formats/media/mux.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "tools/formats/files/output_file.h"
#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/mp4/mp4_fix.h"
#include "tools/formats/media/detail/mp4/systems_movie.h"
#include "tools/formats/media/detail/segments/segment_writer.h"
#include "tools/formats/media/detail/tracks/interleaver.h"
#include "tools/formats/media/detail/tracks/mux_parts.h"
#include "tools/formats/media/detail/tracks/plane_cutter.h"
#include "tools/formats/media/detail/tracks/text_samples.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"
#include "tools/formats/media/detail/ts/ts_pmt.h"

namespace animeme::media {
namespace {

// What goes into files with an extension, and who writes them.
struct FileType {
  std::string_view extension;
  const char* muxer;
  bool face, aac, opus, h264, vp9, text;

  bool is_mp4() const { return std::string_view(muxer) == "mp4"; }
  bool is_mkv() const { return std::string_view(muxer) == "matroska"; }
  bool is_ts() const { return std::string_view(muxer) == "mpegts"; }
  bool is_segments() const { return std::string_view(muxer) == "segments"; }
  bool takes(AudioCodec codec) const { return codec == AudioCodec::opus ? opus : aac; }
  bool takes(VideoCodec codec) const {
    if (codec == VideoCodec::prores) return extension == ".mov";
    return codec == VideoCodec::vp9 ? vp9 : h264;
  }
};

// clang-format off
constexpr FileType kTypes[] = {
    // extension, muxer,  face,  aac,   opus,  h264,  vp9,   text (h264 stands for MPEG-4 video, too)
    {".mp4",  "mp4",      true,  true,  true,  true,  true,  true},
    {".mkv",  "matroska", true,  true,  true,  true,  true,  true},
    {".ts",   "mpegts",   true,  true,  false, false, false, false},
    {".m3u8", "segments", true,  true,  true,  false, false, true},
    {".mpd",  "segments", true,  true,  true,  false, false, false},
    {".m4a",  "mp4",      false, true,  false, false, false, false},
    {".mka",  "matroska", false, true,  true,  false, false, false},
    {".mov",  "mov",      false, true,  false, true,  false, false},
    {".webm", "webm",     false, false, true,  false, true,  false},
    {".weba", "webm",     false, false, true,  false, false, false},
    {".opus", "opus",     false, false, true,  false, false, false},
};
// clang-format on

const FileType* type_of(const std::string& path) {
  const std::string extension = extension_of(path);
  const auto* found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const FileType& type) {
    return type.extension == extension;
  });
  return found == std::end(kTypes) ? nullptr : found;
}

Error unsupported(std::string message) { return make_error(Code::unsupported, std::move(message)); }

// Of a transport stream, which has to fit in a packet.
Result<void> check_program_map(const MuxInput& input) {
  std::size_t faces = 0, sounds = 0, labelled = 0;
  const auto count = [&](const MuxInput& part) {
    const bool sound = part.sounds() > 0;
    faces += part.has_face() ? 1 : 0;
    sounds += sound ? 1 : 0;
    if (!part.labels.empty()) labelled += (part.has_face() ? 1 : 0) + (sound ? 1 : 0);
  };
  count(input);
  for (const MuxInput& further : input.more) count(further);
  if (program_map_bytes(faces, sounds, labelled) <= kMostProgramMap) return {};
  return unsupported("a transport stream takes up to six languages; use .mp4, .mkv or .m3u8");
}

Result<void> check_type(const FileType& type, const MuxInput& input, const MuxOptions& options) {
  const std::string name(type.extension);
  const bool labelled = !input.more.empty() || !input.labels.empty();
  if (labelled && (options.systems || !type.face)) {
    return unsupported(
        "several languages or speakers go into plain .mp4, .mkv, .ts, .m3u8 and .mpd files only");
  }
  if (type.is_ts() && !input.labels.speaker.empty()) {
    return unsupported("a transport stream tells languages but not who speaks; use .mp4 or .mkv");
  }
  if (type.is_ts() && !input.more.empty()) {
    if (auto fits = check_program_map(input); !fits) return fits;
    if (options.shared_seconds > 0) {
      return unsupported("planes share packets in files of one face only");
    }
  }
  for (const MuxInput& further : input.more) {
    if (auto legal = check_type(type, further, options); !legal) return legal;
  }
  if (options.systems && name != ".mp4") {
    return unsupported("a Systems presentation is an .mp4 file");
  }
  if (options.fragmented && !type.is_mp4()) return unsupported("only an mp4 can be fragmented");
  if (options.shared_seconds > 0 && !type.is_ts()) {
    return unsupported("planes share packets in .ts files only");
  }
  if (input.video != nullptr && !type.takes(input.video->codec)) {
    return unsupported("a " + name + " file does not support " + name_of(input.video->codec) +
                       " video; use .mp4 or .mkv");
  }
  const bool text = input.texts != nullptr && !input.texts->empty();
  if (text && (options.systems || !type.text)) {
    return unsupported("text goes into plain .mp4, .mkv and .m3u8 files only");
  }
  const bool whole = type.is_segments() || options.systems || options.shared_seconds > 0;
  if (input.face_units != nullptr && whole) {
    return unsupported("this file needs the access units of the face in memory");
  }
  if (input.has_face() && !type.face) {
    return unsupported("a " + name +
                       " file can only contain sound; use .mp4, .mkv or .ts for a face");
  }
  const AudioFormat* coded = input.coded_format();
  const AudioCodec codec = coded != nullptr ? coded->codec : options.audio.codec;
  const bool sound = input.sounds() > 0;
  if (sound && !type.takes(codec)) {
    return unsupported("a " + name + " file does not support " + name_of(codec) + "; " +
                       (type.opus ? "code the sound as opus" : "code the sound as aac") +
                       ", or use .mp4 or .mkv");
  }
  if (sound && options.systems && codec != AudioCodec::aac) {
    return unsupported("a Systems presentation needs AAC; encode the sound as aac");
  }
  return {};
}

OutputStream::Filter filter_of(const FileType& type, const MuxInput& input) {
  if (!type.is_ts() || !input.has_face()) return nullptr;
  std::vector<std::string> languages;
  if (input.has_face()) languages.push_back(input.labels.code);
  for (const MuxInput& further : input.more)
    if (further.has_face()) languages.push_back(further.labels.code);
  const auto filter =
      std::make_shared<ProgramMapFilter>(std::uint8_t(visual_profile(input)), std::move(languages));
  return [filter](std::span<const std::uint8_t> bytes) { return filter->push(bytes); };
}

// What a muxer asks for before the first unit.
fba::AccessUnits head_of(const fba::UnitReader& units) {
  const fba::UnitSummary& facts = units.summary();
  fba::AccessUnits head{facts.config, facts.timescale, {}};
  head.units.emplace_back().duration = facts.first_duration;
  return head;
}

/// A language, or all of a file without any, on its way to the muxer.
struct WrittenPart {
  const MuxInput* input = nullptr;
  std::optional<SoundSource> sound;
  fba::AccessUnits shared;
  const fba::AccessUnits* face = nullptr;
  std::vector<TextSamples> texts;
};

using Feeds = std::vector<std::unique_ptr<TrackFeed>>;

Result<void> add_face(Muxer& muxer, WrittenPart& part, const FileType& type,
                      const MuxOptions& options, Feeds& feeds, int& faces) {
  const MuxInput& input = *part.input;
  part.face = input.face;
  if (part.face != nullptr && type.is_ts() && options.shared_seconds > 0) {
    part.shared = share_packets(*part.face, options.shared_seconds);
    part.face = &part.shared;
  }
  if (input.face_units != nullptr) {
    part.shared = head_of(*input.face_units);
    part.face = &part.shared;
    const fba::UnitSummary& facts = input.face_units->summary();
    auto added =
        muxer.add_face(part.shared, BufferFacts{facts.largest, facts.peak_bits}, input.labels);
    if (!added) return added;
    feeds.push_back(face_feed(muxer, *input.face_units, faces++));
  } else if (part.face != nullptr) {
    auto added = muxer.add_face(*part.face, buffer_facts(*part.face), input.labels);
    if (!added) return added;
    feeds.push_back(face_feed(muxer, *part.face, faces++));
  }
  return {};
}

Result<void> add_sound(Muxer& muxer, WrittenPart& part, Feeds& feeds, int& sounds) {
  if (!part.sound) return {};
  auto added = muxer.add_sound(part.sound->format(), part.sound->bit_rate(), part.input->labels);
  if (!added) return added;
  feeds.push_back(sound_feed(muxer, *part.sound, part.sound->seconds(), sounds++));
  return {};
}

Result<void> add_texts(Muxer& muxer, WrittenPart& part, const FileType& type, Feeds& feeds) {
  if (part.input->texts == nullptr) return {};
  for (const TextTrack& track : *part.input->texts)
    part.texts.push_back(type.is_mp4() ? mov_text_samples(track) : subrip_samples(track));
  for (const TextSamples& track : part.texts) {
    TrackLabels labels = part.input->labels;
    labels.language = tag_of_text(track.language, labels.language);
    Result<int> added = muxer.add_text(track, labels);
    if (!added) return added.error();
    feeds.push_back(text_feed(muxer, track, *added));
  }
  return {};
}

// Of all tracks in their order; none where a file tells of no language and no speaker.
std::vector<TrackMark> marks_of(const std::vector<WrittenPart>& parts) {
  if (parts.size() == 1 && parts.front().input->labels.empty()) return {};
  std::vector<TrackMark> marks;
  // libavformat's own: 0 pictures, 1 sounds, 3 texts.
  constexpr unsigned kFaces = 10, kSounds = 40, kTexts = 100, kMostGroups = 30;
  std::vector<std::string> speakers, texts;
  const auto group = [&](std::vector<std::string>& known, unsigned first, const std::string& what) {
    const auto at = std::find(known.begin(), known.end(), what);
    const auto number = unsigned(at - known.begin());
    if (at == known.end()) known.push_back(what);
    return number < kMostGroups ? first + number : 0;
  };
  if (parts.front().input->video != nullptr) marks.emplace_back();
  for (const WrittenPart& part : parts) {
    const TrackLabels& labels = part.input->labels;
    if (part.face != nullptr)
      marks.push_back({labels.language, group(speakers, kFaces, labels.speaker)});
  }
  for (const WrittenPart& part : parts) {
    const TrackLabels& labels = part.input->labels;
    if (part.sound) marks.push_back({labels.language, group(speakers, kSounds, labels.speaker)});
  }
  for (const WrittenPart& part : parts) {
    const TrackLabels& labels = part.input->labels;
    for (const TextSamples& text : part.texts) {
      marks.push_back({tag_of_text(text.language, labels.language),
                       group(texts, kTexts, text.name + "\n" + labels.speaker)});
    }
  }
  return marks;
}

// All faces, then all sounds, then all texts; those of `input` first.
Result<void> add_tracks(Muxer& muxer, std::vector<WrittenPart>& parts, const FileType& type,
                        const MuxOptions& options, Feeds& feeds) {
  const MuxInput& first = *parts.front().input;
  if (first.video != nullptr) {
    if (auto added = muxer.add_video(*first.video); !added) return added;
    feeds.push_back(video_feed(muxer, *first.video));
  }
  int faces = 0, sounds = 0;
  for (WrittenPart& part : parts) {
    if (auto added = add_face(muxer, part, type, options, feeds, faces); !added) return added;
  }
  for (WrittenPart& part : parts) {
    if (auto added = add_sound(muxer, part, feeds, sounds); !added) return added;
  }
  for (WrittenPart& part : parts) {
    if (auto added = add_texts(muxer, part, type, feeds); !added) return added;
  }
  return {};
}

Result<MuxResult> write_streams(const std::string& path, const FileType& type,
                                const MuxInput& input, const MuxOptions& options) {
  std::vector<WrittenPart> parts(1 + input.more.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].input = i == 0 ? &input : &input.more[i - 1];
    Result<std::optional<SoundSource>> sound = open_sound(*parts[i].input, options);
    if (!sound) return sound.error();
    parts[i].sound = std::move(*sound);
  }
  Result<std::unique_ptr<Muxer>> opened = Muxer::open(path, type.muxer, filter_of(type, input));
  if (!opened) return opened.error();
  Muxer& muxer = **opened;
  Feeds feeds;
  if (auto added = add_tracks(muxer, parts, type, options, feeds); !added) return added.error();
  av::Options header;
  if (type.is_mp4()) {
    Mp4Contents contents{nullptr, 0xFF, nullptr, input.video};
    for (const WrittenPart& part : parts) {
      if (contents.face == nullptr && part.face != nullptr) {
        contents.face = part.face;
        contents.visual_profile = visual_profile(*part.input);
      }
      if (contents.sound == nullptr && part.sound) contents.sound = &part.sound->format();
    }
    set_mp4_options(contents, header);
    if (options.fragmented) {
      set_fragment_options("frag_keyframe", options.fragment_seconds, header);
    } else {
      set_chunk_options(header);
    }
  }
  if (type.is_ts()) set_ts_options(options.shared_seconds, header);
  if (auto started = muxer.write_header(header); !started) return started.error();
  Result<Interleaved> done = interleave(feeds, options.stop, options.progress);
  if (!done) return done.error();
  if (auto finished = muxer.finish(); !finished) return finished.error();
  if (type.is_mp4()) {
    auto completed = complete_mp4(
        path, options.faststart || options.fragmented ? Layout::indexed : Layout::as_written,
        {options.face_track, options.text_track, marks_of(parts)});
    if (!completed) return completed.error();
  }
  if (type.is_mkv()) {
    if (auto tagged = put_language_tags(path); !tagged) return tagged.error();
  }
  if (type.is_ts()) {
    if (auto filled = fill_up_ts(path); !filled) return filled.error();
  }
  double sound_seconds = 0;
  for (const WrittenPart& part : parts)
    if (part.sound) sound_seconds = std::max(sound_seconds, part.sound->seconds_so_far());
  return MuxResult{done->seconds, sound_seconds, done->stopped};
}

Result<EncodedAudio> read_all(SoundSource& source) {
  EncodedAudio audio{source.format(), {}, 0};
  for (;;) {
    const Result<const AudioPacket*> packet = source.next();
    if (!packet) return packet.error();
    if (*packet == nullptr) break;
    audio.packets.push_back(**packet);
  }
  if (audio.packets.empty()) {
    return make_error(Code::invalid_argument, "the sound is shorter than one coded sample");
  }
  audio.length = audio.packets.back().time + audio.packets.back().duration;
  return audio;
}

Result<MuxResult> write_systems(const std::string& path, const MuxInput& input,
                                const MuxOptions& options) {
  const EncodedAudio* sound = input.encoded;
  std::optional<EncodedAudio> coded;
  if (sound == nullptr) {
    Result<std::optional<SoundSource>> source = open_sound(input, options);
    if (!source) return source.error();
    if (*source) {
      Result<EncodedAudio> made = read_all(**source);
      if (!made) return made.error();
      sound = &coded.emplace(std::move(*made));
    }
  }
  Result<std::vector<std::uint8_t>> bytes =
      write_movie(systems_movie(*input.face, sound, visual_profile(input)));
  if (!bytes) return bytes.error();
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes->data()), std::streamsize(bytes->size()));
  out.close();
  if (!out) return make_error(Code::io, "cannot write the file; check the free space");
  const fba::AccessUnit& last = input.face->units.back();
  MuxResult result{double(last.time + last.duration) / input.face->timescale, 0, false};
  if (sound != nullptr) {
    result.sound_seconds = double(sound->length) / sound->format.sample_rate;
    result.seconds = std::max(result.seconds, result.sound_seconds);
  }
  return result;
}

Result<MuxResult> write_file(const std::string& path, const FileType& type, const MuxInput& input,
                             const MuxOptions& options) {
  if (auto legal = check_input(input, options); !legal) return legal.error();
  if (auto legal = check_type(type, input, options); !legal) return legal.error();
  const av::LogCapture log;
  if (type.is_segments()) return write_segments(path, input, options);
  tools::OutputFile out(path);
  const Result<std::string> place = out.place();
  if (!place) return place.error();
  Result<MuxResult> written = options.systems ? write_systems(*place, input, options)
                                              : write_streams(*place, type, input, options);
  if (!written) return written;
  if (auto published = out.publish(); !published) return published.error();
  return written;
}

Result<MuxResult> guarded_write(const std::string& path, const FileType& type,
                                const MuxInput& input, const MuxOptions& options) {
  return av::guarded(path, [&] {
    Result<MuxResult> written = write_file(path, type, input, options);
    if (written && options.progress) options.progress(1.0);
    return written;
  });
}

}  // namespace

const AudioFormat* MuxInput::coded_format() const {
  if (stored != nullptr) return &stored->format();
  return encoded != nullptr ? &encoded->format : nullptr;
}

bool takes_text(const std::string& path) {
  const FileType* type = type_of(path);
  return type != nullptr && type->text;
}

AudioCodec usual_codec(const std::string& path) {
  const FileType* type = type_of(path);
  return type == nullptr || type->aac ? AudioCodec::aac : AudioCodec::opus;
}

Result<MuxResult> write_mp4(const std::string& path, const MuxInput& input,
                            const MuxOptions& options) {
  return guarded_write(path, kTypes[0], input, options);
}

Result<MuxResult> write_container(const std::string& path, const MuxInput& input,
                                  const MuxOptions& options) {
  if (path == "-") {
    return unsupported(
        "a container cannot go to standard output, because its writer goes back in it; write a "
        "file");
  }
  const FileType* type = type_of(path);
  if (type != nullptr) return guarded_write(path, *type, input, options);
  const bool face = input.has_face();
  return unsupported("cannot write a \"" + extension_of(path) + "\" file; use .mp4, .mkv or .ts" +
                     (face ? "" : ", .m4a, .mka, .webm or .opus"))
      .in_file(path);
}

}  // namespace animeme::media
