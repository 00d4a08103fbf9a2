#include "tools/formats/media/detail/ts/ts_sections.h"

#include <algorithm>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

constexpr std::size_t kHeader = 8;  // of a section in the long form
constexpr std::uint8_t kPatId = 0, kPmtId = 2;
constexpr std::uint8_t kRegistration = 0x05, kExtension = 0x7F, kOpusExtension = 0x80;

int pid_at(ByteSpan bytes, std::size_t at) { return int(read_big_endian(bytes, at, 2) & 0x1FFF); }
std::size_t u12_at(ByteSpan bytes, std::size_t at) {
  return read_big_endian(bytes, at, 2) & 0x0FFF;
}

/// Entries of a section of this table that is in force; nullopt: another one.
std::optional<std::span<const std::uint8_t>> entries(std::span<const std::uint8_t> section,
                                                     std::uint8_t table) {
  if (section.size() < kHeader + kTsCrcSize || section[0] != table || (section[5] & 1) == 0)
    return {};
  return section.subspan(kHeader, section.size() - kHeader - kTsCrcSize);
}

/// Number of channels of a private stream whose descriptors say that it is Opus; 0: it is not.
int opus_channels(std::span<const std::uint8_t> descriptors) {
  bool opus = false;
  int channels = 0;
  while (descriptors.size() >= 2) {
    const std::size_t size = descriptors[1];
    if (descriptors.size() < 2 + size) break;
    const auto content = descriptors.subspan(2, size);
    if (descriptors[0] == kRegistration && size >= 4) {
      opus |= content[0] == 'O' && content[1] == 'p' && content[2] == 'u' && content[3] == 's';
    }
    if (descriptors[0] == kExtension && size >= 2 && content[0] == kOpusExtension) {
      channels = content[1];
    }
    descriptors = descriptors.subspan(2 + size);
  }
  return opus && (channels == 1 || channels == 2) ? channels : 0;
}

}  // namespace

std::uint32_t ts_crc(std::span<const std::uint8_t> section) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : section) {
    crc ^= std::uint32_t(byte) << 24;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc >> 31) != 0 ? 0x04C11DB7u : 0u);
  }
  return crc;
}

void TsSections::take(std::vector<std::vector<std::uint8_t>>& complete) {
  while (bytes_.size() >= 3 && bytes_[0] != 0xFF) {
    const std::size_t size = 3 + u12_at(bytes_, 1);
    if (bytes_.size() < size) return;
    const auto end = bytes_.begin() + std::ptrdiff_t(size);
    std::vector<std::uint8_t> section(bytes_.begin(), end);
    bytes_.erase(bytes_.begin(), end);
    if (ts_crc(section) == 0) complete.push_back(std::move(section));
  }
  if (!bytes_.empty() && bytes_[0] == 0xFF) open_ = false;  // the rest only fills the packet
}

std::vector<std::vector<std::uint8_t>> TsSections::push(std::span<const std::uint8_t> payload,
                                                        bool begins) {
  std::vector<std::vector<std::uint8_t>> complete;
  if (begins) {
    if (payload.empty() || payload[0] >= payload.size()) {
      open_ = false;
      return complete;
    }
    const std::size_t tail = payload[0];
    if (open_) {
      bytes_.insert(bytes_.end(), payload.begin() + 1, payload.begin() + 1 + std::ptrdiff_t(tail));
      take(complete);
    }
    bytes_.clear();
    open_ = true;
    payload = payload.subspan(1 + tail);
  }
  if (!open_) return complete;
  bytes_.insert(bytes_.end(), payload.begin(), payload.end());
  take(complete);
  return complete;
}

std::optional<std::vector<int>> read_pat(std::span<const std::uint8_t> section) {
  const auto rows = entries(section, kPatId);
  if (!rows) return {};
  std::vector<int> pids;
  for (std::size_t at = 0; at + 4 <= rows->size(); at += 4) {
    const bool network = (*rows)[at] == 0 && (*rows)[at + 1] == 0;
    if (!network) pids.push_back(pid_at(*rows, at + 2));
  }
  return pids;
}

std::optional<TsProgram> read_pmt(std::span<const std::uint8_t> section) {
  const auto rows = entries(section, kPmtId);
  if (!rows || rows->size() < 4) return {};
  TsProgram program;
  std::size_t at = 4 + u12_at(*rows, 2);
  while (at + 5 <= rows->size()) {
    const std::uint8_t type = (*rows)[at];
    const int pid = pid_at(*rows, at + 1);
    const std::size_t size = std::min(u12_at(*rows, at + 3), rows->size() - at - 5);
    const auto descriptors = rows->subspan(at + 5, size);
    if (type == 0x10 && program.face == kTsNoPid) program.face = pid;
    if (program.sound == kTsNoPid) {
      const int channels = type == 0x06 ? opus_channels(descriptors) : 0;
      if (type == 0x0F) program.sound_codec = TsCodec::adts;
      if (channels > 0) program.sound_codec = TsCodec::opus;
      if (type == 0x0F || channels > 0) program.sound = pid;
      program.channels = channels;
    }
    at += 5 + size;
  }
  return program;
}

std::array<std::uint8_t, kTsPacket> end_of_programs(unsigned continuity_counter, unsigned version) {
  std::array<std::uint8_t, kTsPacket> packet{};
  packet.fill(0xFF);
  const std::array<std::uint8_t, 13> head = {
      kTsSync, 0x40,
      0x00,    std::uint8_t(0x10 | (continuity_counter & 15)),
      0x00,  // the section begins at once
      kPatId,  0xB0,
      0x09,    0x00,
      0x01,    std::uint8_t(0xC1 | (version & 31) << 1),
      0x00,    0x00};
  std::copy(head.begin(), head.end(), packet.begin());
  write_big_endian(packet, 13, 4, ts_crc(std::span(packet).subspan(5, 8)));
  return packet;
}

}  // namespace animeme::media
