#include "tools/formats/media/detail/ts/ts_pmt.h"

#include <algorithm>
#include <utility>

#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kMapTable = 0x02;
constexpr std::uint8_t kVisualStreamType = 0x10;  // stream type of 14496-2
constexpr std::uint8_t kDescriptor = 0x1B;        // MPEG-4_video_descriptor
constexpr std::uint8_t kLanguage = 0x0A;          // ISO_639_language_descriptor

void put_u12(std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t value) {
  bytes[at] = std::uint8_t((bytes[at] & 0xF0) | (value >> 8 & 0x0F));
  bytes[at + 1] = std::uint8_t(value);
}

/// Where the payload of a packet begins; 0: it has none, or no section begins in it.
std::size_t section_begin(ByteSpan packet) {
  const bool starts = (packet[1] & 0x40) != 0, has_payload = (packet[3] & 0x10) != 0;
  if (packet[0] != kTsSync || !starts || !has_payload) return 0;
  std::size_t at = 4;
  if ((packet[3] & 0x20) != 0) at += 1 + std::size_t(packet[4]);
  if (at >= packet.size()) return 0;
  at += 1 + std::size_t(packet[at]);  // pointer field
  return at + 3 <= packet.size() ? at : 0;
}

/// The section at `at`; empty: it is not whole in this packet.
ByteSpan section_at(ByteSpan packet, std::size_t at) {
  const std::size_t size = 3 + (read_big_endian(packet, at + 1, 2) & 0x0FFF);
  return at + size <= packet.size() ? packet.subspan(at, size) : ByteSpan();
}

bool has_descriptor(ByteSpan descriptors, std::uint8_t tag) {
  for (std::size_t at = 0; at + 2 <= descriptors.size(); at += 2 + std::size_t(descriptors[at + 1]))
    if (descriptors[at] == tag) return true;
  return false;
}

/// The map with the descriptors, without its CRC; empty: nothing is to be done, or it is damaged.
std::vector<std::uint8_t> describe(ByteSpan section, std::uint8_t profile,
                                   const std::vector<std::string>& languages) {
  constexpr std::size_t kFixed = 12;  // up to program_info_length
  if (section.size() < kFixed + kTsCrcSize) return {};
  const std::size_t end = section.size() - kTsCrcSize;
  std::size_t at = kFixed + (read_big_endian(section, 10, 2) & 0x0FFF);
  if (at > end) return {};
  std::vector<std::uint8_t> out(section.begin(), section.begin() + std::ptrdiff_t(at));
  bool changed = false;
  std::size_t faces = 0;
  while (at + 5 <= end) {
    const std::size_t length = read_big_endian(section, at + 3, 2) & 0x0FFF;
    if (at + 5 + length > end) return {};
    const ByteSpan entry = section.subspan(at, 5 + length);
    const std::size_t begin = out.size();
    out.insert(out.end(), entry.begin(), entry.end());
    if (entry[0] == kVisualStreamType) {
      const ByteSpan known = entry.subspan(5);
      if (!has_descriptor(known, kDescriptor)) out.insert(out.end(), {kDescriptor, 1, profile});
      const std::string code = faces < languages.size() ? languages[faces] : std::string();
      ++faces;
      if (code.size() == 3 && !has_descriptor(known, kLanguage)) {
        out.insert(out.end(), {kLanguage, 4});
        out.insert(out.end(), code.begin(), code.end());
        out.push_back(0);  // no type of sound
      }
      const std::size_t now = out.size() - begin - 5;
      put_u12(out, begin + 3, now);
      changed = changed || now != length;
    }
    at += 5 + length;
  }
  if (!changed || at != end) return {};
  put_u12(out, 1, out.size() + kTsCrcSize - 3);
  return out;
}

}  // namespace

std::size_t program_map_bytes(std::size_t faces, std::size_t sounds, std::size_t labelled) {
  // Header and CRC, type and PID of a stream, MPEG-4_video_descriptor, language.
  return 16 + 5 * (faces + sounds) + 3 * faces + 6 * labelled;
}

void ProgramMapFilter::rewrite(std::span<std::uint8_t> packet) {
  const std::size_t at = section_begin(packet);
  if (at == 0) return;
  const ByteSpan section = section_at(packet, at);
  if (section.empty()) return;
  const int pid = int(read_big_endian(packet, 1, 2) & 0x1FFF);
  if (pid == 0) {
    if (auto maps = read_pat(section)) map_pids_ = std::move(*maps);
    return;
  }
  const bool map = std::find(map_pids_.begin(), map_pids_.end(), pid) != map_pids_.end();
  if (!map || section[0] != kMapTable) return;
  std::vector<std::uint8_t> described = describe(section, profile_, languages_);
  if (described.empty() || at + described.size() + kTsCrcSize > packet.size()) return;
  // What follows the section in its packet must be stuffing, or it would be lost.
  const auto behind = packet.subspan(at + section.size());
  if (std::any_of(behind.begin(), behind.end(), [](std::uint8_t b) { return b != 0xFF; })) return;
  put(described, ts_crc(described), int(kTsCrcSize));
  std::copy(described.begin(), described.end(), packet.begin() + std::ptrdiff_t(at));
}

std::vector<std::uint8_t> ProgramMapFilter::push(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> out = std::move(rest_);
  out.insert(out.end(), bytes.begin(), bytes.end());
  const std::size_t whole = out.size() / kTsPacket * kTsPacket;
  rest_.assign(out.begin() + std::ptrdiff_t(whole), out.end());
  out.resize(whole);
  for (std::size_t at = 0; at < whole; at += kTsPacket) {
    rewrite(std::span(out).subspan(at, kTsPacket));
  }
  return out;
}

}  // namespace animeme::media
