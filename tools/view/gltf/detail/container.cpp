#include "tools/view/gltf/detail/container.h"

#include <algorithm>
#include <string>

namespace animeme::gltf {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kHeader = 12;
constexpr std::size_t kChunkHeader = 8;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t(bytes[at]) | std::uint32_t(bytes[at + 1]) << 8 |
         std::uint32_t(bytes[at + 2]) << 16 | std::uint32_t(bytes[at + 3]) << 24;
}

bool is_glb(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && word(bytes, 0) == kGlbMagic;
}

// The bytes that there are, and how many there should be.
Error cut_off(std::size_t is, std::size_t wanted) {
  return make_error(Code::truncated, "the .glb file ends too early, after byte " +
                                         std::to_string(is) + " of " + std::to_string(wanted) +
                                         ": copy or export it again");
}

Result<Chunks> chunks_of_glb(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader) return cut_off(bytes.size(), kHeader + kChunkHeader);
  if (word(bytes, 4) != 2) {
    return make_error(Code::unsupported,
                      "this is glTF " + std::to_string(word(bytes, 4)) +
                          ", only version 2 can be read: export it again as glTF 2.0");
  }
  const std::size_t length = std::max<std::size_t>(word(bytes, 8), kHeader + kChunkHeader);
  if (length > bytes.size()) return cut_off(bytes.size(), length);
  const auto file = bytes.first(length);
  Chunks chunks;
  std::size_t at = kHeader;
  for (bool is_first = true; at + kChunkHeader <= file.size(); is_first = false) {
    const std::size_t size = word(file, at);
    const std::uint32_t type = word(file, at + 4);
    if (is_first != (type == kJsonChunk)) {
      return make_error(Code::syntax, "the part of the .glb file at byte " +
                                          std::to_string(at + 1) +
                                          " has a wrong type, the first must be its "
                                          "JSON: export it again");
    }
    at += kChunkHeader;
    if (size > file.size() - at) return cut_off(file.size(), at + size);
    if (is_first) chunks.json = file.subspan(at, size);
    if (type == kBinChunk && !chunks.binary) chunks.binary = file.subspan(at, size);
    at += size;
    if (type == kBinChunk && chunks.others.empty()) chunks.others = file.subspan(at);
  }
  return chunks;
}

}  // namespace

std::optional<std::size_t> glb_length(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader || !is_glb(bytes)) return std::nullopt;
  return word(bytes, 8);
}

Result<Chunks> chunks_of(std::span<const std::uint8_t> bytes) {
  if (is_glb(bytes)) return chunks_of_glb(bytes);
  if (!looks_like_json(bytes)) {
    return make_error(Code::syntax, "this is no glTF file: it begins neither as .glb nor as JSON");
  }
  return Chunks{bytes, std::nullopt};
}

Result<std::vector<std::uint8_t>> glb_front(std::string_view json, std::uint64_t binary,
                                            std::uint64_t others) {
  const std::size_t text = (json.size() + 3) / 4 * 4;
  const std::uint64_t total =
      kHeader + kChunkHeader + text + (binary > 0 ? kChunkHeader + binary : 0) + others;
  if (total > UINT32_MAX) {
    return make_error(Code::out_of_range, "the file would be larger than 4 GB");
  }
  std::vector<std::uint8_t> front;
  front.reserve(kHeader + 2 * kChunkHeader + text);
  const auto put = [&](std::uint64_t value) {
    for (int byte = 0; byte < 4; ++byte) front.push_back(std::uint8_t(value >> (8 * byte)));
  };
  put(kGlbMagic);
  put(2);
  put(total);
  put(text);
  put(kJsonChunk);
  front.insert(front.end(), json.begin(), json.end());
  front.insert(front.end(), text - json.size(), ' ');
  if (binary > 0) {
    put(binary);
    put(kBinChunk);
  }
  return front;
}

bool looks_like_json(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes.first(std::min<std::size_t>(bytes.size(), 1000))) {
    if (byte == '{') return true;
    const bool skipped = byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r' ||
                         byte == 0xEF || byte == 0xBB || byte == 0xBF;
    if (!skipped) return false;
  }
  return false;
}

}  // namespace animeme::gltf
