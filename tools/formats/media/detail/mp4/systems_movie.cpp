#include "tools/formats/media/detail/mp4/systems_movie.h"

#include <algorithm>

#include "tools/formats/media/detail/mp4/systems_scene.h"
#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"

namespace animeme::media {
namespace {

constexpr unsigned kSceneStream = 3, kObjectStream = 1, kVisualStream = 4;
constexpr unsigned kSystems = 0x01, kVisualObjects = 0x20;
constexpr unsigned kWidth = 320, kHeight = 240;  // a face has no size; readers want one
constexpr std::uint32_t kSystemsTimescale = 1000;

std::vector<std::uint8_t> systems_entry(const StreamDescription& stream) {
  BoxWriter out;
  begin_entry(out, "mp4s");
  put_esds(out, stream);
  out.end();
  return out.bytes();
}

std::vector<std::uint8_t> visual_entry(const StreamDescription& stream) {
  BoxWriter out;
  begin_entry(out, "mp4v");
  out.zeros(16);
  out.u16(kWidth);
  out.u16(kHeight);
  out.u32({72 << 16, 72 << 16, 0});  // dots an inch
  out.u16(1);                        // frame a sample
  out.zeros(32);                     // name of the compressor
  out.u16(24);
  out.u16(0xFFFF);
  put_esds(out, stream);
  out.end();
  return out.bytes();
}

std::vector<std::uint8_t> sound_entry(const StreamDescription& stream, int sample_rate) {
  BoxWriter out;
  // The template requires two channels; the configuration has the real number.
  begin_sound_entry(out, "mp4a", 2, sample_rate);
  put_esds(out, stream);
  out.end();
  return out.bytes();
}

/// A track that holds one unit for the whole presentation.
Mp4Track constant_track(unsigned id, const char* handler, const char* name, unsigned stream_type,
                        std::vector<std::uint8_t> unit, std::span<const std::uint8_t> config,
                        std::int64_t length) {
  Mp4Track track;
  track.id = id;
  track.handler = handler;
  track.name = name;
  track.timescale = kSystemsTimescale;
  track.length = length;
  track.presented = false;
  track.entry = systems_entry({kSystems, stream_type, unit.size(), 0, 0, config});
  track.samples = {{std::move(unit), length, true}};
  return track;
}

Mp4Track face_track(const fba::AccessUnits& face) {
  Mp4Track track;
  track.id = kFaceTrack;
  track.handler = "vide";
  track.name = "FBA";
  track.timescale = face.timescale;
  track.width = kWidth;
  track.height = kHeight;
  track.start = face.units.front().time;
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    const fba::AccessUnit& unit = face.units[i];
    const bool last = i + 1 == face.units.size();
    const std::int64_t duration = last ? unit.duration : face.units[i + 1].time - unit.time;
    track.samples.push_back({unit.bytes, duration, unit.intra});
    track.length += duration;
  }
  StreamDescription stream{kVisualObjects, kVisualStream, largest_unit(face), 0, 0, face.config};
  stream.max_bit_rate = std::uint32_t(peak_bit_rate(face));
  stream.average_bit_rate = std::uint32_t(mean_bit_rate(face));
  track.entry = visual_entry(stream);
  return track;
}

Mp4Track sound_track(const EncodedAudio& sound) {
  Mp4Track track;
  track.id = kSoundTrack;
  track.handler = "soun";
  track.name = "audio";
  track.timescale = std::uint32_t(sound.format.sample_rate);
  track.start = sound.packets.front().time;
  track.length = sound.length;
  std::size_t largest = 0;
  for (const AudioPacket& packet : sound.packets) {
    track.samples.push_back({packet.bytes, packet.duration, true});
    largest = std::max(largest, packet.bytes.size());
  }
  StreamDescription stream{kAacObject, kAudioStream, largest, 0, 0, sound.format.config};
  stream.max_bit_rate = stream.average_bit_rate = std::uint32_t(mean_bit_rate(sound));
  track.entry = sound_entry(stream, sound.format.sample_rate);
  return track;
}

std::int64_t length_in_ms(const Mp4Track& track) {
  const double ticks = double(std::max<std::int64_t>(track.start, 0) + track.length);
  return std::int64_t(ticks * kSystemsTimescale / track.timescale + 0.5);
}

}  // namespace

Mp4Movie systems_movie(const fba::AccessUnits& face, const EncodedAudio* sound,
                       int visual_profile) {
  Mp4Movie movie;
  Mp4Track visual = face_track(face);
  std::int64_t length = length_in_ms(visual);
  // The unit of track durations; 1 ms would round them.
  movie.timescale = sound != nullptr ? std::uint32_t(sound->format.sample_rate) : face.timescale;
  std::vector<Mp4Track> media;
  media.push_back(std::move(visual));
  if (sound != nullptr) {
    media.push_back(sound_track(*sound));
    length = std::max(length, length_in_ms(media.back()));
  }
  const std::vector<std::uint8_t> config = scene_config();
  movie.tracks.push_back(constant_track(kSceneTrack, "sdsm", "scene", kSceneStream,
                                        scene_unit(sound != nullptr), config, length));
  movie.tracks.push_back(constant_track(kObjectTrack, "odsm", "od", kObjectStream,
                                        object_unit(sound != nullptr), {}, length));
  movie.tracks.back().references = {kFaceTrack};
  if (sound != nullptr) movie.tracks.back().references.push_back(kSoundTrack);
  for (Mp4Track& track : media) movie.tracks.push_back(std::move(track));
  movie.initial_object_descriptor = initial_object_descriptor(
      audio_profile(sound != nullptr ? &sound->format : nullptr), unsigned(visual_profile));
  return movie;
}

}  // namespace animeme::media
