#include "tools/formats/media/live/audio_segments.h"

#include <algorithm>

#include "tools/formats/media/detail/mp4/mp4_file.h"
#include "tools/formats/media/detail/mp4/systems_scene.h"

namespace animeme::media {
namespace {

constexpr unsigned kTrack = 1;
constexpr unsigned kDefaultBaseIsMoof = 0x020000;
constexpr unsigned kDataOffset = 0x1, kDurations = 0x100, kSizes = 0x200;
// Bytes of a segment in front of the time in tfdt: moof, mfhd, traf, tfhd, tfdt up to its time.
constexpr std::size_t kTimeAt = 8 + 16 + 8 + 16 + 12;

/// OpusHead (little endian) as the box dOps (big endian), without pre-skip.
void put_opus_box(BoxWriter& out, const AudioFormat& format) {
  out.begin("dOps");
  out.u8(0);
  out.u8(unsigned(format.channels));
  out.u16(0);
  out.u32(48000);
  out.u16(format.config.size() >= 18 ? format.config[16] | unsigned(format.config[17]) << 8 : 0);
  out.u8(0);  // mapping family
  out.end();
}

std::vector<std::uint8_t> sample_entry(const AudioFormat& format) {
  const bool aac = format.codec == AudioCodec::aac;
  BoxWriter out;
  begin_sound_entry(out, aac ? "mp4a" : "Opus", unsigned(format.channels), format.sample_rate);
  const StreamDescription stream{
      .object_type = kAacObject, .stream_type = kAudioStream, .config = format.config};
  aac ? put_esds(out, stream) : put_opus_box(out, format);
  out.end();
  return out.bytes();
}

}  // namespace

std::string audio_mime(const AudioFormat& format) {
  if (format.codec == AudioCodec::opus) return "audio/mp4; codecs=\"opus\"";
  const int object_type = format.config.empty() ? 2 : format.config[0] >> 3;
  return "audio/mp4; codecs=\"mp4a.40." + std::to_string(object_type) + "\"";
}

Result<std::vector<std::uint8_t>> write_audio_init(const AudioFormat& format) {
  if (format.config.empty() || format.sample_rate <= 0 || format.channels <= 0) {
    return make_error(Code::invalid_argument,
                      "the sound has no configuration, sample rate or channels");
  }
  Mp4Movie movie{.brands = "iso5mp42", .fragments = true};
  Mp4Track& track = movie.tracks.emplace_back();
  track.id = kTrack;
  track.handler = "soun";
  track.entry = sample_entry(format);
  track.timescale = std::uint32_t(format.sample_rate);
  track.fragment_duration = std::uint32_t(std::max(format.frame_samples, 0));
  return write_contents(movie);
}

Result<std::vector<std::uint8_t>> write_audio_segment(std::uint32_t sequence,
                                                      std::span<const AudioPacket> packets) {
  if (packets.empty() || packets.front().time < 0) {
    return make_error(Code::invalid_argument, "no packets, or a negative time");
  }
  // The size of moof: everything up to the time, the time, trun with two numbers a packet.
  const std::size_t moof = kTimeAt + 8 + 20 + 8 * packets.size();
  BoxWriter out;
  out.begin("moof");
  out.begin_full("mfhd", 0, 0);
  out.u32(sequence);
  out.end();
  out.begin("traf");
  out.begin_full("tfhd", 0, kDefaultBaseIsMoof);
  out.u32(kTrack);
  out.end();
  out.begin_full("tfdt", 1, 0);
  out.u64(std::uint64_t(packets.front().time));
  out.end();
  out.begin_full("trun", 0, kDataOffset | kDurations | kSizes);
  out.u32({packets.size(), moof + 8});
  for (const AudioPacket& packet : packets) {
    if (packet.bytes.empty() || packet.duration <= 0) {
      return make_error(Code::invalid_argument, "a packet of sound is empty");
    }
    out.u32({std::uint64_t(packet.duration), packet.bytes.size()});
  }
  for (int open = 0; open < 3; ++open) out.end();  // trun, traf, moof
  out.begin("mdat");
  for (const AudioPacket& packet : packets) out.raw(packet.bytes);
  out.end();
  return out.bytes();
}

void set_segment_time(std::span<std::uint8_t> segment, std::int64_t time) {
  if (segment.size() >= kTimeAt + 8) write_big_endian(segment, kTimeAt, 8, std::uint64_t(time));
}

void set_priming(AudioFormat& format, int priming) {
  format.priming = priming;
  if (format.codec != AudioCodec::opus || format.config.size() < 12) return;
  format.config[10] = std::uint8_t(priming & 0xFF);
  format.config[11] = std::uint8_t(priming >> 8);
}

}  // namespace animeme::media
