// What an MPEG-4 Systems presentation says besides its media: the scene (BIFS), the object
// descriptors, the initial object descriptor. Source: containers, sections 1.4 and 1.5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// Initial object descriptor, the content of `iods` behind its version: profiles (0xFE: not
/// specified, 0xFF: none required) and the tracks of scene and objects.
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

/// Content of an `esds` box behind its version: ES_ID 0, as in files.
std::vector<std::uint8_t> elementary_stream_descriptor(const StreamDescription& stream);

}  // namespace animeme::media
