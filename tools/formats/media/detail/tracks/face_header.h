// The start codes around an FBA stream: telling a face from a film, and an intra plane from a
// predicted one. Looks at headers only and never searches plane data for start codes.
// Source: tools/formats/media/containers.md, sections 1.2, 1.3 and 4.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace animeme::media {

enum class VisualKind : std::uint8_t {
  unknown,  ///< no visual object header
  face,     ///< visual_object_type 4
  other,    ///< video, still texture, mesh ...
};

/// Start code of an object, with stuffing up to the byte, in front of its first plane.
inline constexpr std::array<std::uint8_t, 5> kObjectStart = {0x00, 0x00, 0x01, 0xBA, 0x7F};

/// Visual object sequence and visual object header, as in a decoder configuration or in front of
/// a plane.
struct VisualHeaders {
  VisualKind kind = VisualKind::unknown;
  std::uint8_t profile = 0;  ///< profile and level code; 0: not given
  std::size_t size = 0;      ///< bytes up to the first code that is none of these headers
};

/// Reads headers 000001B0, B5 (both forms) and user data B2 (skipped) at the begin of `bytes`.
VisualHeaders read_visual_headers(std::span<const std::uint8_t> bytes);

/// Does a packet of a track without configuration begin like a face? Needs a visual object header
/// of type 4, or an FBA object or plane code.
bool looks_like_face(std::span<const std::uint8_t> packet);

/// Does a file begin like a raw FBA stream (or an MPEG program stream, which shares its first
/// code) instead of a container?
bool looks_like_raw_stream(std::span<const std::uint8_t> head);

/// is_intra of the plane in an access unit (configuration already taken off). nullopt: the unit
/// does not begin with an object or plane start code, or has no plane.
std::optional<bool> read_is_intra(std::span<const std::uint8_t> unit);

/// The 11 bytes for Simple Face Animation with this profile and level.
std::vector<std::uint8_t> default_face_config(std::uint8_t profile = 0x61);

}  // namespace animeme::media
