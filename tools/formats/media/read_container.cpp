#include <algorithm>
#include <optional>
#include <utility>

#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/sound_start.h"
#include "tools/formats/media/detail/tracks/face_track.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/detail/tracks/unit_collector.h"

namespace animeme::media {
namespace {

constexpr const char* kFaceFormats = "mov,matroska,mpegts,nut";
// Sound in another place than the face: where its time 0 lies, and what it is.
struct OtherSound {
  AudioInfo info;
  std::optional<std::int64_t> time;
  AVRational time_base{1, 1};
};

std::optional<OtherSound> look_at_sound(Input& input) {
  AVFormatContext& file = *input.context();
  FaceTracks tracks;
  tracks.update(file);
  if (avformat_find_stream_info(&file, nullptr) < 0) return std::nullopt;
  const std::optional<int> index = find_audio(input);
  const av::Packet packet(av_packet_alloc());
  if (!index || !packet) return std::nullopt;
  AVStream* stream = file.streams[*index];
  SoundStart start(input, stream);
  while (start.searching() && av_read_frame(&file, packet.get()) >= 0) {
    if (packet->stream_index == *index) start.try_packet(*packet);
    av_packet_unref(packet.get());
  }
  return OtherSound{describe_audio(input, *stream), start.time(), stream->time_base};
}

class ContainerReader {
 public:
  ContainerReader(Input& input, const ReadOptions& options)
      : input_(input), file_(*input.context()), options_(options) {}

  /// The sound is not that of `input`.
  void use(const OtherSound& sound) {
    result_.audio = sound.info;
    other_sound_ = sound;
  }

  Result<Container> read(const av::LogCapture& log);
  /// stream_face().
  Result<std::optional<FaceSummary>> stream(const TakeUnit& take, const av::LogCapture& log);

 private:
  void choose_tracks(std::optional<int>& audio);
  bool indexed() const;
  Result<void> need_units() const;
  Result<void> read_packets(SoundStart& sound);
  Result<void> take(const AVPacket& packet);
  std::int64_t shift(const SoundStart& sound) const;
  Error no_face() const;
  void add_warnings(const av::LogCapture& log);
  void add_damage(std::int64_t found, const av::LogCapture& log);
  bool ends_in_packet() const;

  Input& input_;
  AVFormatContext& file_;
  const ReadOptions& options_;
  Container result_;
  FaceTracks tracks_;
  int face_ = -1;  // stream index, once it is certain
  std::optional<UnitCollector> units_;
  TakeUnit take_;  // empty: units are collected
  std::optional<OtherSound> other_sound_;
  int status_ = 0;
};

// What to call a stream that is no face.
std::string describe(const AVCodecParameters& parameters) {
  // Entry of BIFS scenes, object descriptors and BIFS-Anim, which this reader leaves alone.
  if (parameters.codec_tag == MKTAG('m', 'p', '4', 's')) return "MPEG-4 Systems stream";
  const char* type = av_get_media_type_string(parameters.codec_type);
  return std::string(type != nullptr ? type : "unknown") + " " +
         avcodec_get_name(parameters.codec_id);
}

Error ContainerReader::no_face() const {
  std::string found;
  for (unsigned i = 0; i < file_.nb_streams && i < 8; ++i) {
    found += (i == 0 ? "" : ", ") + describe(*file_.streams[i]->codecpar);
  }
  return make_error(Code::not_found, "the file has no face animation track" +
                                         (found.empty() ? "" : " (it holds: " + found + ")"));
}

Result<void> ContainerReader::take(const AVPacket& packet) {
  const int index = packet.stream_index;
  tracks_.decide(packet);
  // Of several faces the first, wherever its packets lie.
  if (face_ < 0 && index == tracks_.first() && tracks_[index].state == FaceTrack::State::yes) {
    face_ = index;
    units_.emplace(options_, tracks_[index].config, result_.format == "mpegts");
    if (take_) units_->pass_on(take_);
  }
  if (index != face_) return {};
  return units_->add(packet, file_.streams[index]->time_base);
}

Result<void> ContainerReader::read_packets(SoundStart& sound) {
  const av::Packet packet(av_packet_alloc());
  if (!packet) return av::no_memory();
  while ((status_ = av_read_frame(&file_, packet.get())) >= 0) {
    tracks_.update(file_);
    Result<void> taken;
    if (packet->stream_index == sound.stream()) {
      if (sound.searching()) sound.try_packet(*packet);
    } else {
      taken = take(*packet);
    }
    av_packet_unref(packet.get());
    if (!taken) return taken;
  }
  return {};
}

// Ticks to subtract from the face's times.
std::int64_t ContainerReader::shift(const SoundStart& sound) const {
  const AVRational base = units_->time_base();
  const std::optional<std::int64_t> time = other_sound_ ? other_sound_->time : sound.time();
  if (time) {
    const AVRational from =
        other_sound_ ? other_sound_->time_base : file_.streams[sound.stream()]->time_base;
    const std::int64_t ticks = av_rescale_q(known_start(*time), from, base);
    return std::clamp<std::int64_t>(ticks, -(std::int64_t(1) << 47), std::int64_t(1) << 47);
  }
  const bool arbitrary = (file_.iformat->flags & AVFMT_TS_DISCONT) != 0;
  return arbitrary && !units_->empty() ? units_->first_time() : 0;
}

void ContainerReader::add_warnings(const av::LogCapture& log) {
  if (input_.exhausted()) {
    result_.warnings.push_back("the file's index sends the reader in circles; reading was stopped");
  } else if (status_ != AVERROR_EOF && !options_.repair) {
    result_.warnings.push_back("reading stopped early: " + av::error_text(status_));
  }
  for (const std::string& line : log.lines()) result_.warnings.push_back("FFmpeg: " + line);
}

// A transport stream has whole packets of 188 bytes, on discs of 192, with error correction of 204.
bool ContainerReader::ends_in_packet() const {
  const std::int64_t size = avio_size(file_.pb);
  return result_.format == "mpegts" && size > 0 && size % 188 != 0 && size % 192 != 0 &&
         size % 204 != 0;
}

// What is missing behind the last of the units that were found.
void ContainerReader::add_damage(std::int64_t found, const av::LogCapture& log) {
  const std::int64_t stated = face_ < 0 ? 0 : file_.streams[face_]->nb_frames;
  const std::int64_t missing = stated - found;
  const bool stopped = status_ != AVERROR_EOF && options_.repair;
  const auto& lines = log.lines();
  const bool cut =
      options_.repair &&
      (ends_in_packet() || std::any_of(lines.begin(), lines.end(), [](const auto& line) {
         return line.find("ended prematurely") != std::string::npos;
       }));
  if (missing <= 0 && !stopped && !cut) return;
  std::string reason = "the file is cut off";
  if (missing > 0) {
    reason = "the file ends early: " + std::to_string(found) + " of " + std::to_string(stated) +
             " planes were found";
  } else if (stopped) {
    reason = "reading stopped early: " + av::error_text(status_);
  }
  if (!options_.repair) return result_.warnings.push_back(std::move(reason));
  add_damage_at_end(result_, std::move(reason));
}

// Leaves what is not needed to the demuxer, and finds the sound.
void ContainerReader::choose_tracks(std::optional<int>& audio) {
  result_.format = input_.format();
  tracks_.update(file_);
  if (avformat_find_stream_info(&file_, nullptr) < 0) {
    result_.warnings.push_back("the stream headers are incomplete");
  }
  tracks_.update(file_);
  if (!other_sound_) audio = find_audio(input_);
  for (unsigned i = 0; i < file_.nb_streams; ++i) {
    const bool wanted =
        int(i) == audio.value_or(-1) || tracks_[int(i)].state != FaceTrack::State::no;
    if (!wanted) file_.streams[i]->discard = AVDISCARD_ALL;
  }
  if (audio) result_.audio = describe_audio(input_, *file_.streams[*audio]);
}

Result<void> ContainerReader::need_units() const {
  if (units_) return {};
  if (tracks_.first() < 0) return no_face();
  return make_error(Code::truncated, "the face track is empty; the file is probably cut off");
}

// An index says where each sample is; without one, what cannot be read leaves no trace.
bool ContainerReader::indexed() const { return result_.format == "mp4" || result_.format == "mov"; }

Result<Container> ContainerReader::read(const av::LogCapture& log) {
  std::optional<int> audio;
  choose_tracks(audio);
  SoundStart sound(input_, audio ? file_.streams[*audio] : nullptr);
  Result<void> packets = read_packets(sound);
  if (!packets) return packets.error();
  if (auto found = need_units(); !found) return found.error();
  const std::int64_t ticks = shift(sound);
  add_warnings(log);
  const auto found = std::int64_t(units_->count());
  if (options_.repair && !indexed()) units_->find_gaps(!log.lines().empty());
  Result<void> finished = units_->finish(ticks, result_);
  if (!finished) return finished.error();
  add_damage(found, log);
  return std::move(result_);
}

Result<std::optional<FaceSummary>> ContainerReader::stream(const TakeUnit& take,
                                                           const av::LogCapture& log) {
  take_ = take;
  std::optional<int> audio;
  choose_tracks(audio);
  SoundStart sound(input_, audio ? file_.streams[*audio] : nullptr);
  Result<void> packets = read_packets(sound);
  if (!packets) return packets.error();
  if (auto found = need_units(); !found) return found.error();
  const std::int64_t stated = face_ < 0 ? 0 : file_.streams[face_]->nb_frames;
  const bool complete = status_ == AVERROR_EOF && stated <= std::int64_t(units_->count()) &&
                        !ends_in_packet() && !input_.exhausted();
  if (!complete || !log.lines().empty() || !result_.warnings.empty()) return {std::nullopt};
  FaceSummary summary;
  summary.format = result_.format;
  const Result<bool> intact = units_->finish_passing(shift(sound), !indexed(), summary);
  if (!intact) return intact.error();
  return *intact ? std::optional(summary) : std::nullopt;
}

template <class Source>
Result<Container> read_from(const Source& source, const ReadOptions& options) {
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(source, kFaceFormats);
  if (!input) return input.error();
  return ContainerReader(**input, options).read(log);
}

Result<Container> read_playlist(const std::string& path, const ReadOptions& options) {
  const Result<Presentation> presentation = read_presentation(path);
  if (!presentation) return presentation.error();
  const std::vector<std::uint8_t>* face = find_rendition(*presentation, TrackKind::face);
  if (face == nullptr) {
    if (!wanted_track().empty()) return no_wanted_track();
    return make_error(Code::not_found, "the presentation has no face animation track");
  }
  const std::vector<std::uint8_t>* sound = find_rendition(*presentation, TrackKind::audio);
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(*face, kFaceFormats);
  if (!input) return input.error();
  ContainerReader reader(**input, options);
  if (sound != nullptr && sound != face) {
    Result<std::unique_ptr<Input>> other = Input::open(*sound, nullptr);
    const auto found = other ? look_at_sound(**other) : std::nullopt;
    if (found) reader.use(*found);
  }
  Result<Container> container = reader.read(log);
  if (container) container->format = presentation->format;
  return container;
}

}  // namespace

Result<std::optional<FaceSummary>> stream_face(const std::string& path, const TakeUnit& take) {
  return av::guarded(path, [&]() -> Result<std::optional<FaceSummary>> {
    if (is_playlist(path)) return {std::nullopt};
    const av::LogCapture log;
    Result<std::unique_ptr<Input>> input = Input::open(path, kFaceFormats);
    if (!input) return input.error();
    ReadOptions options;
    options.repair = true;
    return ContainerReader(**input, options).stream(take, log);
  });
}

Result<Container> read_container(const std::string& path, const ReadOptions& options) {
  return av::guarded(path, [&] {
    return is_playlist(path) ? read_playlist(path, options) : read_from(path, options);
  });
}

Result<Container> read_container(std::span<const std::uint8_t> file, const ReadOptions& options) {
  return av::guarded([&] { return read_from(file, options); });
}

}  // namespace animeme::media
