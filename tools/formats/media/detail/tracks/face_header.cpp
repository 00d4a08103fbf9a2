#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kSequence = 0xB0;
constexpr std::uint8_t kUserData = 0xB2;
constexpr std::uint8_t kVisualObject = 0xB5;
constexpr std::uint8_t kObject = 0xBA;
constexpr std::uint8_t kPlane = 0xBB;
constexpr std::uint8_t kOldObject = 0x01;
constexpr std::uint8_t kOldPlane = 0x03;
constexpr std::uint8_t kStuffing = 0x7F;
constexpr unsigned kFaceType = 4;

// The last byte of a start code at `at`, or -1.
int code_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  if (at > bytes.size() || bytes.size() - at < 4) return -1;
  return bytes[at] == 0 && bytes[at + 1] == 0 && bytes[at + 2] == 1 ? bytes[at + 3] : -1;
}

// Headers and user data cannot contain a start code prefix, so a search is safe here.
std::size_t next_code(std::span<const std::uint8_t> bytes, std::size_t at) {
  while (at < bytes.size() && code_at(bytes, at) < 0) ++at;
  return at;
}

VisualKind kind_of(std::span<const std::uint8_t> header) {
  if (header.empty()) return VisualKind::unknown;
  unsigned type = (header[0] >> 3) & 15u;
  if ((header[0] & 0x80) != 0) {  // 7 bits of version and priority come first
    if (header.size() < 2) return VisualKind::unknown;
    type = header[1] >> 4;
  }
  return type == kFaceType ? VisualKind::face : VisualKind::other;
}

bool is_object(int code) { return code == kObject || code == kOldObject; }
bool is_plane(int code) { return code == kPlane || code == kOldPlane; }

}  // namespace

VisualHeaders read_visual_headers(std::span<const std::uint8_t> bytes) {
  VisualHeaders headers;
  std::size_t at = 0;
  for (;;) {
    const int code = code_at(bytes, at);
    if (code != kSequence && code != kVisualObject && code != kUserData) break;
    const std::size_t body = at + 4;
    if (code == kSequence && body < bytes.size()) headers.profile = bytes[body];
    if (code == kVisualObject) headers.kind = kind_of(bytes.subspan(body));
    at = next_code(bytes, body);
  }
  headers.size = at;
  return headers;
}

bool looks_like_face(std::span<const std::uint8_t> packet) {
  const VisualHeaders headers = read_visual_headers(packet);
  if (headers.kind != VisualKind::unknown) return headers.kind == VisualKind::face;
  const int code = code_at(packet, headers.size);
  return code == kObject || code == kPlane;  // the old codes also occur in MPEG-4 video
}

bool looks_like_raw_stream(std::span<const std::uint8_t> head) {
  const VisualHeaders headers = read_visual_headers(head);
  return headers.kind == VisualKind::face || code_at(head, headers.size) == kObject ||
         code_at(head, headers.size) == kPlane;
}

std::optional<bool> read_is_intra(std::span<const std::uint8_t> unit) {
  std::size_t at = 0;
  bool found = false;
  if (is_object(code_at(unit, at))) {
    found = true;
    at += 4;
    if (at < unit.size() && unit[at] == kStuffing) ++at;
  }
  if (is_plane(code_at(unit, at))) {
    found = true;
    at += 4;
  }
  if (!found || at >= unit.size()) return std::nullopt;
  return (unit[at] & 0x80) != 0;
}

std::vector<std::uint8_t> default_face_config(std::uint8_t profile) {
  return {0, 0, 1, kSequence, profile, 0, 0, 1, kVisualObject, 0x89, 0x47};
}

}  // namespace animeme::media
