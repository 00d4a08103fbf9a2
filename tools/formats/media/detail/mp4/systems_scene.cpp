#include "tools/formats/media/detail/mp4/systems_scene.h"

#include "codec/syntax/bits.h"

namespace animeme::media {
namespace {

using Bits = fba::BitWriter;

/// All bytes, the last one filled up with zeros.
std::vector<std::uint8_t> padded(Bits& out) {
  out.bits(0, int((8 - out.position() % 8) % 8));
  return out.take();
}

// Node types are numbered within the context they stand in (BIFS version 1).
constexpr unsigned kGroup = 1, kFace = 14, kSound = 39;                    // 3, 6, 6 bits
constexpr unsigned kAudioSource = 6;                                       // 3 bits
constexpr unsigned kFapField = 0, kVisemeField = 0, kExpressionField = 1;  // 3, 7, 7 bits
constexpr unsigned kSourceField = 8, kUrlField = 1;                        // 4, 3 bits

constexpr unsigned kDefined = 1, kAnonymous = 0;
constexpr unsigned kByMask = 1, kByList = 0;  // how fields are addressed
constexpr unsigned kMore = 0, kEnd = 1;       // of a list

/// A node of our own, not a reference to another.
void new_node(Bits& out, unsigned type, int type_bits) {
  out.bits(0, 1);
  out.bits(type, type_bits);
}

/// FAP node with an empty viseme and an empty expression.
void put_fap_node(Bits& out) {
  new_node(out, 1, 1);
  out.bits(kDefined, 1);
  out.bits(1, 2);  // its ID
  out.bits(kByList, 1);
  for (const unsigned field : {kVisemeField, kExpressionField}) {
    out.bits(kMore, 1);
    out.bits(field, 7);
    new_node(out, 1, 1);
    out.bits(kAnonymous, 1);
    out.bits(kByList, 1);
    out.bits(kEnd, 1);
  }
  out.bits(kEnd, 1);
}

void put_face(Bits& out) {
  new_node(out, kFace, 6);
  out.bits(kDefined, 1);
  out.bits(0, 2);  // its ID
  out.bits(kByList, 1);
  out.bits(kMore, 1);
  out.bits(kFapField, 3);
  put_fap_node(out);
  out.bits(kEnd, 1);
}

void put_sound(Bits& out) {
  new_node(out, kSound, 6);
  out.bits(kAnonymous, 1);
  out.bits(kByList, 1);
  out.bits(kMore, 1);
  out.bits(kSourceField, 4);
  new_node(out, kAudioSource, 3);
  out.bits(kAnonymous, 1);
  out.bits(kByList, 1);
  out.bits(kMore, 1);
  out.bits(kUrlField, 3);
  out.bits(0, 1);  // several values
  out.bits(1, 1);  // as a list
  out.bits(kMore, 1);
  out.bits(1, 1);  // an object descriptor, no text
  out.bits(kSoundTrack, 10);
  out.bits(kEnd, 1);  // of the list
  out.bits(kEnd, 1);  // of AudioSource
  out.bits(kEnd, 1);  // of Sound
}

void put_object(BoxWriter& out, unsigned id, unsigned reference) {
  out.u8(0x11);
  out.u8(6);
  out.u16(id << 6 | 0x1F);  // 10 bits, no URL, reserved
  out.u8(0x0F);             // ES_ID_Ref
  out.u8(2);
  out.u16(reference);
}

}  // namespace

std::vector<std::uint8_t> scene_config() {
  Bits out;
  out.bits(2, 5);  // bits of node IDs
  out.bits(0, 5);  // bits of route IDs
  out.bits(1, 1);  // a command stream
  out.bits(1, 1);  // in pixels
  out.bits(1, 1);  // has a size
  out.bits(320, 16);
  out.bits(240, 16);
  return padded(out);
}

std::vector<std::uint8_t> scene_unit(bool sound) {
  Bits out;
  out.bits(3, 2);  // SceneReplace
  out.bits(0, 6);
  out.bits(0, 1);  // no names
  out.bits(0, 1);  // no PROTO
  new_node(out, kGroup, 3);
  out.bits(kAnonymous, 1);
  out.bits(kByMask, 1);
  out.bits(1, 1);  // children
  out.bits(0, 1);  // several values
  out.bits(1, 1);  // as a list
  out.bits(kMore, 1);
  put_face(out);
  if (sound) {
    out.bits(kMore, 1);
    put_sound(out);
  }
  out.bits(kEnd, 1);
  out.bits(0, 1);  // no routes
  out.bits(0, 1);  // no more commands
  return padded(out);
}

std::vector<std::uint8_t> object_unit(bool sound) {
  BoxWriter out;
  out.u8(0x01);  // ObjectDescriptorUpdate
  out.u8(sound ? 16 : 8);
  put_object(out, kFaceTrack, 1);
  if (sound) put_object(out, kSoundTrack, 2);
  return out.bytes();
}

unsigned audio_profile(const AudioFormat* sound) {
  if (sound == nullptr) return kNoneRequired;
  constexpr unsigned kLowComplexity = 2;  // object type
  const bool known = sound->codec == AudioCodec::aac && !sound->config.empty() &&
                     sound->config[0] >> 3 == kLowComplexity && sound->sample_rate <= 96000;
  if (!known) return kUnspecified;
  const bool fast = sound->sample_rate > 48000;
  if (sound->channels > 5) return fast ? 0x51 : 0x50;          // levels 7 and 6
  if (sound->channels > 2 || fast) return fast ? 0x2B : 0x2A;  // 5 and 4
  return 0x29;                                                 // 2
}

std::vector<std::uint8_t> initial_object_descriptor(unsigned audio_profile,
                                                    unsigned visual_profile) {
  BoxWriter out;
  out.u8(0x10);
  out.u8(19);
  out.u16(1 << 6 | 0xF);  // ID 1, no URL, profiles of its own, reserved
  for (const unsigned profile : {0xFEu, 0xFEu, audio_profile, visual_profile, 0xFEu})
    out.u8(profile);
  for (const unsigned track : {kSceneTrack, kObjectTrack}) {
    out.u8(0x0E);  // ES_ID_Inc
    out.u8(4);
    out.u32(track);
  }
  return out.bytes();
}

std::vector<std::uint8_t> elementary_stream_descriptor(const StreamDescription& stream) {
  BoxWriter decoder;
  decoder.u8(stream.object_type);
  decoder.u8(stream.stream_type << 2 | 1);
  decoder.u8(unsigned(stream.buffer_size >> 16 & 0xFF));
  decoder.u16(unsigned(stream.buffer_size & 0xFFFF));
  decoder.u32({stream.max_bit_rate, stream.average_bit_rate});
  if (!stream.config.empty()) decoder.descriptor(0x05, stream.config);
  BoxWriter inside;
  inside.u16(0);  // ES_ID
  inside.u8(0);
  inside.descriptor(0x04, decoder.bytes());
  const std::uint8_t predefined[] = {2};
  inside.descriptor(0x06, predefined);
  BoxWriter out;
  out.descriptor(0x03, inside.bytes());
  return out.bytes();
}

void put_esds(BoxWriter& out, const StreamDescription& stream) {
  out.begin_full("esds", 0, 0);
  out.raw(elementary_stream_descriptor(stream));
  out.end();
}

}  // namespace animeme::media
