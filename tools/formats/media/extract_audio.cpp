#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/tracks/face_track.h"
#include "tools/formats/media/detail/tracks/muxer.h"

namespace animeme::media {
namespace {

// What each extension can take as it is. No codecs: any that the muxer accepts.
struct CopyTarget {
  std::string_view extension;
  const char* muxer;
  std::array<AVCodecID, 4> codecs;
};

constexpr CopyTarget kTargets[] = {
    {".m4a", "ipod", {AV_CODEC_ID_AAC, AV_CODEC_ID_ALAC}},
    {".mp4", "mp4", {AV_CODEC_ID_AAC, AV_CODEC_ID_MP3, AV_CODEC_ID_OPUS}},
    {".aac", "adts", {AV_CODEC_ID_AAC}},
    {".opus", "opus", {AV_CODEC_ID_OPUS}},
    {".ogg", "ogg", {AV_CODEC_ID_VORBIS, AV_CODEC_ID_OPUS, AV_CODEC_ID_FLAC}},
    {".mp3", "mp3", {AV_CODEC_ID_MP3}},
    {".flac", "flac", {AV_CODEC_ID_FLAC}},
    {".mka", "matroska", {}},
};

bool takes(const CopyTarget& target, AVCodecID codec) {
  const auto& codecs = target.codecs;
  if (codecs[0] == AV_CODEC_ID_NONE) return true;
  return codec != AV_CODEC_ID_NONE &&
         std::find(codecs.begin(), codecs.end(), codec) != codecs.end();
}

Error does_not_fit(std::string_view extension, AVCodecID codec) {
  std::string fitting;
  for (const CopyTarget& target : kTargets) {
    if (takes(target, codec)) fitting += std::string(target.extension) + ", ";
  }
  return make_error(Code::unsupported, std::string("the audio track is ") +
                                           avcodec_get_name(codec) + ", which a " +
                                           std::string(extension) + " file does not support; use " +
                                           fitting + "or .wav");
}

Result<void> copy_packets(Input& input, const AVStream& stream, Muxer& muxer) {
  const std::optional<std::int64_t> end = end_of_sound(input, stream);
  std::optional<std::int64_t> begin;  // subtracted; priming before 0 stays where it is
  Result<int> read = read_packets(input, stream.index, [&](AVPacket& packet) {
    const std::int64_t time = packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
    // The last packet of a fragmented file is said to be whole.
    if (end && time != AV_NOPTS_VALUE && time < *end && packet.duration > *end - time) {
      packet.duration = *end - time;
    }
    if (!begin && time != AV_NOPTS_VALUE) begin = std::max<std::int64_t>(time, 0);
    if (packet.pts != AV_NOPTS_VALUE) packet.pts -= begin.value_or(0);
    if (packet.dts != AV_NOPTS_VALUE) packet.dts -= begin.value_or(0);
    return muxer.write_packet(packet);
  });
  if (!read) return read.error();
  if (input.exhausted()) return make_error(Code::syntax, "the file's index is damaged");
  if (!begin) return make_error(Code::syntax, "the audio track of " + input.format() + " is empty");
  return {};
}

Result<void> copy_track(Input& input, const CopyTarget& target, const std::string& out) {
  FaceTracks().update(*input.context());
  Result<AVStream*> chosen = choose_audio(input);
  if (!chosen) return chosen.error();
  const AVStream& stream = **chosen;
  if (!takes(target, stream.codecpar->codec_id)) {
    return does_not_fit(target.extension, stream.codecpar->codec_id);
  }
  tools::OutputFile output(out);
  const Result<std::string> place = output.place();
  if (!place) return place.error();
  Result<std::unique_ptr<Muxer>> muxer = Muxer::open(*place, target.muxer);
  if (!muxer) return std::move(muxer.error()).in_file(out);
  av::Options header;
  if (target.extension == ".m4a" || target.extension == ".mp4") {
    header.set("movflags", std::string("+faststart"));
    header.set("movie_timescale", std::max(1, stream.codecpar->sample_rate));
  }
  Result<void> done = (*muxer)->add_stream(*stream.codecpar, stream.time_base);
  if (done) done = (*muxer)->write_header(header);
  if (done) done = copy_packets(input, stream, **muxer);
  if (done) done = (*muxer)->finish();
  if (!done) return std::move(done.error()).in_file(out);
  return output.publish();
}

Result<void> decode_to_wav(const std::string& in, const std::string& out) {
  Result<Pcm> pcm = read_audio(in);
  if (!pcm) return pcm.error();
  return write_wav(out, *pcm);
}

Result<void> extract(const std::string& in, const std::string& out) {
  const std::string extension = extension_of(out);
  if (extension == ".wav") return decode_to_wav(in, out);
  const auto* target =
      std::find_if(std::begin(kTargets), std::end(kTargets),
                   [&](const CopyTarget& candidate) { return candidate.extension == extension; });
  if (target == std::end(kTargets)) {
    return make_error(Code::unsupported,
                      "cannot write sound as \"" + extension +
                          "\"; use .wav, .m4a, .mp4, .aac, .opus, .ogg, .mka, .mp3 or .flac")
        .in_file(out);
  }
  const av::LogCapture log;
  const auto copy = [&](const auto& source) -> Result<void> {
    Result<std::unique_ptr<Input>> input = Input::open(source, nullptr);
    if (!input) return input.error();
    return copy_track(**input, *target, out);
  };
  return av::guarded(in, [&] { return read_sound_of(in, copy); });
}

}  // namespace

Result<void> extract_audio(const std::string& in, const std::string& out) {
  return av::guarded([&] { return extract(in, out); });
}

}  // namespace animeme::media
