// What an MPEG-4 Systems presentation says besides its media: the scene (BIFS), the object
// descriptors, the initial object descriptor. Source: tools/formats/media/containers.md,
// sections 1.4 and 1.5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/formats/media/detail/mp4/box_writer.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Track IDs, which are object descriptor IDs, too.
inline constexpr unsigned kSceneTrack = 1, kObjectTrack = 2, kFaceTrack = 10, kSoundTrack = 20;

/// BIFSConfig: node IDs of 2 bits, a command stream in pixels, 320 x 240.
std::vector<std::uint8_t> scene_config();

/// The one access unit of the scene: a Group with a Face (FAP node with viseme and expression)
/// and, with sound, a Sound whose source is the object of kSoundTrack.
std::vector<std::uint8_t> scene_unit(bool sound);

/// The one access unit of the object stream: descriptors of the face and the sound that name the
/// first and second track of the `mpod` reference.
std::vector<std::uint8_t> object_unit(bool sound);

/// Profiles: not specified, none required.
inline constexpr unsigned kUnspecified = 0xFE, kNoneRequired = 0xFF;

/// Profile and level of sound, which may be null: that of AAC-LC by its channels and rate.
unsigned audio_profile(const AudioFormat* sound);

/// Initial object descriptor, the content of `iods` behind its version: profiles and the tracks of
/// scene and objects.
std::vector<std::uint8_t> initial_object_descriptor(unsigned audio_profile,
                                                    unsigned visual_profile);

/// Stream types and object types of an ES descriptor.
struct StreamDescription {
  unsigned object_type = 0;
  unsigned stream_type = 0;
  std::size_t buffer_size = 0;  ///< bytes, the largest access unit
  std::uint32_t max_bit_rate = 0, average_bit_rate = 0;
  std::span<const std::uint8_t> config;  ///< DecoderSpecificInfo; empty: none
};

/// Numbers of a StreamDescription.
inline constexpr unsigned kAudioStream = 5, kAacObject = 0x40;

/// Content of an `esds` box behind its version: ES_ID 0, as in files.
std::vector<std::uint8_t> elementary_stream_descriptor(const StreamDescription& stream);

/// The whole box.
void put_esds(BoxWriter& out, const StreamDescription& stream);

}  // namespace animeme::media
