#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/sound_start.h"
#include "tools/formats/media/detail/tracks/face_track.h"
#include "tools/formats/media/detail/tracks/text_samples.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/text_track.h"

namespace animeme::media {
namespace {

constexpr const char* kTextFormats = "mov,matroska";
constexpr std::size_t kLongestTrackName = 100;
constexpr double kOpen = HUGE_VAL;  // a cue that ends with the next packet

// Not by a factor, which would make 0.19999999999999998 of 0.2.
double exact_seconds(std::int64_t ticks, AVRational base) {
  return double(ticks) * base.num / base.den;
}

class TextReader {
 public:
  TextReader(Input& input, const TextLimits& limits)
      : input_(input), file_(*input.context()), limits_(limits) {}

  Result<std::vector<TextTrack>> read();

 private:
  void choose_streams();
  Result<void> read_texts(SoundStart& sound);
  Result<void> take_text(const AVPacket& packet);
  std::vector<TextTrack> finished(double start);

  Input& input_;
  AVFormatContext& file_;
  const TextLimits& limits_;
  std::vector<int> place_;  // by stream: in tracks_, -1: not there
  std::vector<TextTrack> tracks_;
  std::size_t cues_ = 0, bytes_ = 0;
};

void TextReader::choose_streams() {
  for (unsigned i = 0; i < file_.nb_streams; ++i) {
    AVStream& stream = *file_.streams[i];
    const bool wanted = stream.codecpar->codec_type == AVMEDIA_TYPE_SUBTITLE &&
                        is_plain_text(stream.codecpar->codec_id) &&
                        tracks_.size() < limits_.most_tracks;
    place_.push_back(wanted ? int(tracks_.size()) : -1);
    if (!wanted) {
      stream.discard = AVDISCARD_ALL;
      continue;
    }
    tracks_.push_back({name_of_text(stream), language_of_text(stream), {}});
  }
}

Result<void> TextReader::take_text(const AVPacket& packet) {
  const auto index = std::size_t(packet.stream_index);
  if (index >= place_.size() || place_[index] < 0) return {};
  if (packet.pts == AV_NOPTS_VALUE || std::abs(packet.pts) > INT64_MAX / 4) return {};
  const AVStream& stream = *file_.streams[index];
  std::vector<TextCue>& cues = tracks_[std::size_t(place_[index])].cues;
  const double start = exact_seconds(packet.pts, stream.time_base);
  // libavformat gives no durations for fragments; there each sample ends at the next one.
  if (!cues.empty() && cues.back().end == kOpen) cues.back().end = start;
  std::string text =
      clean_text(text_of_packet(stream.codecpar->codec_id, packet), limits_.longest_text);
  if (text.empty()) return {};
  bytes_ += text.size();
  if (++cues_ > limits_.most_cues || bytes_ > limits_.most_bytes) {
    return make_error(Code::out_of_range, "the file has more text than is read");
  }
  const bool open = packet.duration <= 0 || packet.duration > INT64_MAX / 4;
  const double end = open ? kOpen : exact_seconds(packet.pts + packet.duration, stream.time_base);
  cues.push_back({start, end, std::move(text)});
  return {};
}

Result<void> TextReader::read_texts(SoundStart& sound) {
  const av::Packet packet(av_packet_alloc());
  if (!packet) return av::no_memory();
  while (av_read_frame(&file_, packet.get()) >= 0) {
    Result<void> taken;
    if (packet->stream_index == sound.stream()) {
      if (sound.searching()) sound.try_packet(*packet);
    } else {
      taken = take_text(*packet);
    }
    av_packet_unref(packet.get());
    if (!taken) return taken;
  }
  return {};
}

// On the clock of the sound, whatever order and overlaps the file has.
std::vector<TextTrack> TextReader::finished(double start) {
  for (TextTrack& track : tracks_) {
    for (TextCue& cue : track.cues) {
      cue.start = std::max(cue.start - start, 0.0);
      cue.end -= start;
    }
    std::stable_sort(track.cues.begin(), track.cues.end(),
                     [](const TextCue& a, const TextCue& b) { return a.start < b.start; });
    for (std::size_t i = 0; i + 1 < track.cues.size(); ++i) {
      track.cues[i].end = std::min(track.cues[i].end, track.cues[i + 1].start);
    }
    std::erase_if(track.cues,
                  [](const TextCue& cue) { return !(cue.end > cue.start) || cue.end == kOpen; });
  }
  return std::move(tracks_);
}

Result<std::vector<TextTrack>> TextReader::read() {
  FaceTracks faces;  // keeps libavcodec's hands off them
  faces.update(file_);
  (void)avformat_find_stream_info(&file_, nullptr);     // what headers tell will do
  const std::optional<int> audio = find_audio(input_);  // of streams that are not left out
  choose_streams();
  if (tracks_.empty()) return std::vector<TextTrack>();
  AVStream* stream = audio ? file_.streams[*audio] : nullptr;
  if (stream != nullptr) stream->discard = AVDISCARD_DEFAULT;
  SoundStart sound(input_, stream);
  if (auto done = read_texts(sound); !done) return done.error();
  const auto time = sound.time();
  return finished(time ? to_seconds(known_start(*time), stream->time_base) : 0);
}

template <class Source>
Result<std::vector<TextTrack>> read_text_from(const Source& source, const TextLimits& limits) {
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(source, kTextFormats);
  if (!input) return input.error();
  return TextReader(**input, limits).read();
}

Result<std::vector<TextTrack>> read_playlist_text(const std::string& path,
                                                  const TextLimits& limits) {
  const Result<Presentation> presentation = read_presentation(path);
  if (!presentation) return presentation.error();
  std::vector<TextTrack> tracks;
  for (const PresentedText& text : presentation->texts) {
    const std::string tag = clean_text(text.language, kLongestTrackName);
    const TrackLabels labels = labels_of_text(clean_text(text.name, kLongestTrackName), tag);
    if (!labels.empty() && !wanted_track().empty() && !is_wanted(wanted_track(), labels)) continue;
    const av::LogCapture log;
    Result<std::unique_ptr<Input>> input =
        Input::open(std::span<const std::uint8_t>(text.file), "webvtt");
    if (!input) continue;
    Result<std::vector<TextTrack>> read = TextReader(**input, limits).read();
    if (!read) return read;
    for (TextTrack& track : *read) {
      track.name = name_without_speaker(clean_text(text.name, kLongestTrackName));
      track.language = tag.empty() ? "und" : tag.starts_with("zxx") ? "zxx" : tag;
      tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

}  // namespace

bool may_hold_text(std::span<const std::uint8_t> beginning) {
  constexpr std::string_view kBrand = "ftyp", kMatroska = "\x1A\x45\xDF\xA3", kHls = "#EXTM3U";
  const std::string_view bytes(reinterpret_cast<const char*>(beginning.data()), beginning.size());
  return bytes.starts_with(kMatroska) || bytes.starts_with(kHls) ||
         (bytes.size() >= 8 && bytes.substr(4, 4) == kBrand);
}

Result<std::vector<TextTrack>> read_text_tracks(const std::string& path, const TextLimits& limits) {
  return av::guarded(path, [&] {
    return is_playlist(path) ? read_playlist_text(path, limits) : read_text_from(path, limits);
  });
}

Result<std::vector<TextTrack>> read_text_tracks(std::span<const std::uint8_t> file,
                                                const TextLimits& limits) {
  return av::guarded([&] { return read_text_from(file, limits); });
}

std::string clean_text(std::string_view text, std::size_t longest) {
  const auto* at = reinterpret_cast<const std::uint8_t*>(text.data());
  const std::uint8_t* const end = at + text.size();
  std::string out;
  bool blank = false;
  while (at < end) {
    const std::uint8_t* const begin = at;
    std::int32_t code = 0;
    const bool legal = av_utf8_decode(&code, &at, end, 0) >= 0;
    if (at == begin) ++at;  // never seen; goes on whatever the library does
    const bool control = legal && (code <= 0x20 || (code >= 0x7F && code <= 0xA0) ||
                                   code == 0x2028 || code == 0x2029);
    const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    if (control) {
      blank = !out.empty();
      continue;
    }
    if (legal && (turns || code == 0xFEFF)) continue;
    const std::string_view character =
        legal ? std::string_view(reinterpret_cast<const char*>(begin), std::size_t(at - begin))
              : std::string_view("\xEF\xBF\xBD");
    if (out.size() + character.size() + (blank ? 1 : 0) > longest) break;
    if (blank) out += ' ';
    blank = false;
    out += character;
  }
  return out;
}

}  // namespace animeme::media
