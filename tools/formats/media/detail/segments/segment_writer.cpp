#include "tools/formats/media/detail/segments/segment_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/files/output_folder.h"
#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/mp4/mp4_fix.h"
#include "tools/formats/media/detail/segments/playlist_text.h"
#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/tracks/interleaver.h"
#include "tools/formats/media/detail/tracks/mux_parts.h"
#include "tools/formats/media/detail/tracks/text_samples.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::media {
namespace {

// One track on its way into the folder.
struct Track {
  SegmentedTrack description;
  std::string whole;  // file with all of its fragments
  std::unique_ptr<Muxer> muxer;
  std::vector<std::int64_t> begins;  // of the fragments, presentation time
};

// RFC 6381.
std::string codecs_of(const AudioFormat& sound) {
  if (sound.codec == AudioCodec::opus) return "opus";
  return "mp4a.40." + std::to_string(sound.config[0] >> 3);
}

bool is_ours(std::string_view file) {
  if (file.starts_with("text")) return file.ends_with(".vtt") || file.ends_with(".m3u8");
  const bool named = file.starts_with("face") || file.starts_with("sound");
  return named &&
         (file.ends_with(".m4s") || file.ends_with("-init.mp4") || file.ends_with(".m3u8"));
}

Result<void> write_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
  Result<std::unique_ptr<OutputStream>> out = OutputStream::to_file(path);
  if (!out) return out.error();
  constexpr std::size_t kPiece = 1 << 20;  // libavformat counts in int
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), kPiece))) {
    avio_write((*out)->io(), bytes.data(), int(std::min(bytes.size(), kPiece)));
  }
  return (*out)->close();
}

Result<void> write_text(const std::string& path, const std::string& text) {
  return write_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

struct TopBox {
  std::array<char, 4> type{};
  std::uint64_t size = 0;  // 0: there is none
};

// The box at `at`; libavformat's fragments have sizes of 32 bits.
TopBox next_box(std::istream& in, std::uint64_t at) {
  std::array<char, 8> header{};
  in.seekg(std::streamoff(at));
  if (!in.read(header.data(), header.size())) return {};
  std::array<std::uint8_t, 4> size{};
  std::copy(header.begin(), header.begin() + 4, size.begin());
  TopBox box{{header[4], header[5], header[6], header[7]}, read_big_endian(size, 0, 4)};
  if (box.size < 8) box.size = 0;
  return box;
}

Result<void> copy_part(std::istream& in, std::uint64_t at, std::uint64_t size,
                       const std::string& path) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.seekg(std::streamoff(at));
  if (!in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))) {
    return make_error(Code::io, "the fragments cannot be read again");
  }
  return write_bytes(path, bytes);
}

// The file of fragments as an initialization segment and one segment a fragment.
Result<void> split(const tools::OutputFolder& folder, Track& track, double end) {
  std::ifstream in(track.whole, std::ios::binary);
  SegmentedTrack& description = track.description;
  std::vector<std::uint64_t> begins;
  std::uint64_t size = 0;
  for (TopBox box = next_box(in, 0); box.size != 0; box = next_box(in, size)) {
    if (std::string_view(box.type.data(), 4) == "moof") begins.push_back(size);
    size += box.size;
  }
  in.clear();
  in.seekg(0, std::ios::end);
  if (begins.size() != track.begins.size() || std::uint64_t(in.tellg()) != size) {
    return make_error(Code::internal, "the fragments are not those that were asked for");
  }
  description.init = description.name + "-init.mp4";
  if (auto done = copy_part(in, 0, begins[0], folder.file(description.init)); !done) return done;
  begins.push_back(size);
  track.begins.push_back(std::llround(end * description.timescale));
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    char name[40];
    std::snprintf(name, sizeof name, "%s-%05zu.m4s", description.name.c_str(), i + 1);
    // What lies before time 0 is never heard.
    const std::int64_t time = std::max<std::int64_t>(track.begins[i], 0);
    const std::uint64_t length = begins[i + 1] - begins[i];
    description.segments.push_back(
        {name, time, std::max<std::int64_t>(track.begins[i + 1] - time, 1), std::int64_t(length)});
    if (auto done = copy_part(in, begins[i], length, folder.file(name)); !done) return done;
  }
  std::error_code ignored;
  std::filesystem::remove(track.whole, ignored);
  return {};
}

class SegmentWriter {
 public:
  SegmentWriter(const std::string& path, const MuxInput& input, const MuxOptions& options)
      : path_(path), input_(input), options_(options), dash_(extension_of(path) == ".mpd") {}

  Result<MuxResult> write();

 private:
  Result<void> open(const tools::OutputFolder& folder);
  Result<void> open_face(const tools::OutputFolder& folder, const MuxInput& part, bool first);
  Result<void> open_sound(const tools::OutputFolder& folder, const MuxInput& part, bool first);
  Result<Track*> add_track(const tools::OutputFolder& folder, const char* name,
                           const TrackLabels& labels, bool first);
  Result<void> start(Track& track, const Mp4Contents& contents, std::unique_ptr<TrackFeed> feed);
  Result<void> write_texts(const tools::OutputFolder& folder, const MuxInput& part, double seconds);
  std::string text(const std::string& folder) const;

  const std::string& path_;
  const MuxInput& input_;
  const MuxOptions& options_;
  bool dash_;
  std::vector<std::unique_ptr<SoundSource>> sounds_;
  std::vector<std::unique_ptr<Track>> tracks_;
  std::vector<std::unique_ptr<TrackFeed>> feeds_;
  std::vector<SidecarText> texts_;
};

// "face" and "sound", and numbers behind those of further languages.
Result<Track*> SegmentWriter::add_track(const tools::OutputFolder& folder, const char* name,
                                        const TrackLabels& labels, bool first) {
  auto track = std::make_unique<Track>();
  SegmentedTrack& description = track->description;
  description.name = name;
  if (!first) description.name += "-" + std::to_string(1 + tracks_.size());
  description.labels = labels;
  description.is_default = first;
  track->whole = folder.file(description.name + ".all");
  Result<std::unique_ptr<Muxer>> muxer = Muxer::open(track->whole, "mp4");
  if (!muxer) return muxer.error();
  track->muxer = std::move(*muxer);
  tracks_.push_back(std::move(track));
  return tracks_.back().get();
}

Result<void> SegmentWriter::start(Track& track, const Mp4Contents& contents,
                                  std::unique_ptr<TrackFeed> feed) {
  av::Options header;
  set_mp4_options(contents, header);
  set_fragment_options("frag_custom", 0, header);
  track.description.timescale = std::uint32_t(feed->time_base().den);
  // A fragment begins with the first packet, long enough after the last begin, with which a reader
  // can begin.
  feed->before = [&track, seconds = options_.fragment_seconds](const TrackFeed& due) {
    const std::int64_t now = due.time();
    const bool first = track.begins.empty();
    const bool cut =
        !first && due.sync() && double(now - track.begins.back()) >= seconds * due.time_base().den;
    const Result<void> ended = cut ? track.muxer->end_fragment() : Result<void>();
    if (ended && (first || cut)) track.begins.push_back(now);
    return ended;
  };
  feeds_.push_back(std::move(feed));
  return track.muxer->write_header(header);
}

Result<void> SegmentWriter::open_face(const tools::OutputFolder& folder, const MuxInput& part,
                                      bool first) {
  Result<Track*> track = add_track(folder, "face", part.labels, first);
  if (!track) return track.error();
  Muxer& muxer = *(*track)->muxer;
  const int profile = visual_profile(part);
  (*track)->description.face = true;
  (*track)->description.codecs = options_.face_track == FaceTrackType::metadata
                                     ? "mp4s.20"
                                     : "mp4v.20." + to_hex(std::array{std::uint8_t(profile)});
  auto added = muxer.add_face(*part.face, buffer_facts(*part.face), part.labels);
  if (!added) return added;
  return start(**track, {part.face, profile, nullptr}, face_feed(muxer, *part.face));
}

Result<void> SegmentWriter::open_sound(const tools::OutputFolder& folder, const MuxInput& part,
                                       bool first) {
  Result<std::optional<SoundSource>> opened = media::open_sound(part, options_);
  if (!opened) return opened.error();
  if (!*opened) return {};
  sounds_.push_back(std::make_unique<SoundSource>(std::move(**opened)));
  SoundSource& sound = *sounds_.back();
  Result<Track*> track = add_track(folder, "sound", part.labels, first);
  if (!track) return track.error();
  const AudioFormat& format = sound.format();
  SegmentedTrack& description = (*track)->description;
  description.codecs = codecs_of(format);
  description.sample_rate = format.sample_rate;
  description.channels = format.channels;
  Muxer& muxer = *(*track)->muxer;
  if (auto added = muxer.add_sound(format, sound.bit_rate(), part.labels); !added) return added;
  return start(**track, {nullptr, 0xFF, &format}, sound_feed(muxer, sound, sound.seconds()));
}

Result<void> SegmentWriter::open(const tools::OutputFolder& folder) {
  std::vector<const MuxInput*> parts = {&input_};
  for (const MuxInput& further : input_.more) parts.push_back(&further);
  bool first = true;
  for (const MuxInput* part : parts) {
    if (part->face == nullptr) continue;
    if (auto done = open_face(folder, *part, first); !done) return done;
    first = false;
  }
  for (const MuxInput* part : parts) {
    if (auto done = open_sound(folder, *part, sounds_.empty()); !done) return done;
  }
  return {};
}

std::string SegmentWriter::text(const std::string& folder) const {
  std::vector<SegmentedTrack> descriptions;
  for (const auto& track : tracks_) descriptions.push_back(track->description);
  return dash_ ? dash_description(descriptions, folder) : hls_master(descriptions, folder, texts_);
}

// Each in one piece: text is small.
Result<void> SegmentWriter::write_texts(const tools::OutputFolder& folder, const MuxInput& part,
                                        double seconds) {
  if (part.texts == nullptr) return {};
  for (const TextTrack& track : *part.texts) {
    const std::string name = "text-" + std::to_string(texts_.size() + 1);
    const std::string tag = tag_of_text(track.language, part.labels.language);
    texts_.push_back({name + ".m3u8", clean_text(track.name), tag.empty() ? track.language : tag,
                      part.labels.speaker});
    Result<void> done = write_text(folder.file(name + ".vtt"), webvtt_of(track));
    if (done) done = write_text(folder.file(name + ".m3u8"), hls_text(name + ".vtt", seconds));
    if (!done) return done;
  }
  return {};
}

Result<MuxResult> SegmentWriter::write() {
  tools::OutputFile playlist(path_);
  if (auto place = playlist.place(); !place) return place.error();
  const std::string place = segment_folder(path_);
  Result<tools::OutputFolder> folder = tools::OutputFolder::create(place, is_ours);
  if (!folder) return folder.error();
  const std::string folder_name = std::filesystem::path(place).filename().string();
  if (auto opened = open(*folder); !opened) return opened.error();
  Result<Interleaved> done = interleave(feeds_, options_.stop, options_.progress);
  if (!done) return done.error();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = *tracks_[i];
    Result<void> step = track.muxer->finish();
    TrackTypes types{options_.face_track};
    const TrackLabels& labels = track.description.labels;
    if (!labels.empty()) types.marks = {{labels.language, 0}};
    if (step) step = complete_mp4(track.whole, Layout::contents_first, types);
    if (step) step = split(*folder, track, feeds_[i]->end());
    if (step && !dash_) {
      step =
          write_text(folder->file(track.description.name + ".m3u8"), hls_media(track.description));
    }
    if (!step) return step.error();
  }
  Result<void> step = write_texts(*folder, input_, done->seconds);
  for (const MuxInput& further : input_.more)
    if (step) step = write_texts(*folder, further, done->seconds);
  if (step) step = playlist.write(text(to_reference(folder_name)));
  if (step) step = folder->commit();
  if (step) step = playlist.publish();  // last: it is what readers look for
  if (!step) return step.error();
  folder->keep();
  double sound_seconds = 0;
  for (const auto& sound : sounds_)
    sound_seconds = std::max(sound_seconds, sound->seconds_so_far());
  return MuxResult{done->seconds, sound_seconds, done->stopped};
}

}  // namespace

std::string segment_folder(const std::string& path) {
  const std::filesystem::path target(path);
  const std::string ending = extension_of(path);
  if (ending != ".m3u8" && ending != ".mpd") return {};
  const char* kind = ending == ".mpd" ? "_dash" : "_hls";
  return (target.parent_path() / (target.stem().string() + kind)).string();
}

Result<void> try_segments(const std::string& path) {
  const auto folder = tools::OutputFolder::create(segment_folder(path), is_ours);
  return folder ? Result<void>() : folder.error();
}

Result<MuxResult> write_segments(const std::string& path, const MuxInput& input,
                                 const MuxOptions& options) {
  return SegmentWriter(path, input, options).write();
}

}  // namespace animeme::media
