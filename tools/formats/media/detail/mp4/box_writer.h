// Building the boxes and descriptors of MPEG-4 files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {

/// Big endian bytes with boxes in boxes: begin() writes a header whose size end() fills in.
class BoxWriter {
 public:
  void u8(unsigned value) { bytes_.push_back(std::uint8_t(value)); }
  void u16(unsigned value) { put(bytes_, value, 2); }
  void u32(std::uint64_t value) { put(bytes_, value, 4); }
  void u32(std::initializer_list<std::uint64_t> values) {
    for (const std::uint64_t value : values) u32(value);
  }
  void u64(std::uint64_t value) { put(bytes_, value, 8); }
  void zeros(std::size_t count) { bytes_.resize(bytes_.size() + count); }
  void text(std::string_view text) {
    for (const char c : text) u8(std::uint8_t(c));
  }
  void raw(std::span<const std::uint8_t> bytes) { append(bytes_, bytes); }

  void begin(std::string_view type) {
    open_.push_back(bytes_.size());
    u32(0);
    text(type);
  }
  void begin_full(std::string_view type, unsigned version, unsigned flags) {
    begin(type);
    u32(std::uint32_t(version) << 24 | flags);
  }
  void end() {
    write_big_endian(bytes_, open_.back(), 4, bytes_.size() - open_.back());
    open_.pop_back();
  }

  /// A descriptor (14496-1): tag, length in four bytes of seven bits, content.
  void descriptor(unsigned tag, std::span<const std::uint8_t> content) {
    u8(tag);
    for (const unsigned shift : {21u, 14u, 7u}) u8(0x80 | (content.size() >> shift & 0x7F));
    u8(content.size() & 0x7F);
    raw(content);
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::vector<std::size_t> open_;
};

}  // namespace animeme::media
