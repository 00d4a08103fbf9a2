#include "dam/model/file_frame_internal.h"

#include <array>
#include <cstring>
#include <limits>

#include "dam/model/bytes_internal.h"
#include "fap/detail/whole_file.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kMagic = 8, kHeader = kMagic + 2 + 2 + 8, kChecksum = 4;

// kCrcTables[k][b]: what the byte b does to the checksum once k more bytes have followed it.
using CrcTable = std::array<std::uint32_t, 256>;
constexpr std::array<CrcTable, 4> make_crc_tables() {
  std::array<CrcTable, 4> tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) != 0 ? 0xEDB88320u : 0u);
    tables[0][i] = c;
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t i = 0; i < 256; ++i)
      tables[k][i] = (tables[k - 1][i] >> 8) ^ tables[0][tables[k - 1][i] & 0xFF];
  return tables;
}
constexpr auto kCrcTables = make_crc_tables();

/// CRC-32 as in zip and PNG.
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t c = 0xFFFFFFFFu;
  std::size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) {  // four bytes at a time
    const std::uint8_t* b = &bytes[i];
    c = kCrcTables[3][(c ^ b[0]) & 0xFF] ^ kCrcTables[2][((c >> 8) ^ b[1]) & 0xFF] ^
        kCrcTables[1][((c >> 16) ^ b[2]) & 0xFF] ^ kCrcTables[0][(c >> 24) ^ b[3]];
  }
  for (; i < bytes.size(); ++i) c = kCrcTables[0][(c ^ bytes[i]) & 0xFF] ^ (c >> 8);
  return ~c;
}

std::string the(const FileFormat& format) { return "the " + std::string(format.what); }

struct Header {
  std::uint64_t size = 0;  // of the body
  bool newer_minor = false;
};

// `first`: the beginning of a file of `file_size` bytes.
Result<Header> read_header(const FileFormat& format, std::span<const std::uint8_t> first,
                           std::size_t file_size) {
  if (first.size() < kMagic || std::memcmp(first.data(), format.magic.data(), kMagic) != 0)
    return make_error(Code::syntax, "this is not a " + std::string(format.what) + " of Animeme");
  if (first.size() < kHeader || file_size < kHeader + kChecksum)
    return make_error(Code::truncated, the(format) + " ends within its header");
  ByteReader header(first.subspan(kMagic));
  const auto major = header.next<std::uint16_t>(), minor = header.next<std::uint16_t>();
  const auto size = header.next<std::uint64_t>();
  if (major != format.major)
    return make_error(Code::unsupported, the(format) + " has version " + std::to_string(major) +
                                             "." + std::to_string(minor) + ", this program reads " +
                                             std::to_string(format.major) + ".x; use a " +
                                             (major > format.major ? "newer" : "matching") +
                                             " version of Animeme or " +
                                             std::string(format.remedy));
  const std::size_t there = file_size - kHeader - kChecksum;
  if (size > there) return make_error(Code::truncated, the(format) + " is cut off");
  if (size < there) return damaged_file(format, "bytes behind its end");
  return Header{size, minor > format.minor};
}

}  // namespace

Error damaged_file(const FileFormat& format, const std::string& how) {
  return make_error(Code::syntax, the(format) + " is damaged (" + how + "); get it again or " +
                                      std::string(format.remedy));
}

std::vector<std::uint8_t> frame_file(const FileFormat& format, std::span<const std::uint8_t> body) {
  ByteWriter file;
  file.bytes.reserve(kHeader + body.size() + kChecksum);
  file.bytes.assign(format.magic.begin(), format.magic.end());
  file.put(format.major, format.minor, std::uint64_t(body.size()));
  file.bytes.insert(file.bytes.end(), body.begin(), body.end());
  file.put(crc32(file.bytes));
  return std::move(file.bytes);
}

Result<FileBody> open_frame(const FileFormat& format, std::span<const std::uint8_t> file) {
  const auto header = read_header(format, file, file.size());
  if (!header) return header.error();
  ByteReader checksum(file.last(kChecksum));
  if (crc32(file.first(file.size() - kChecksum)) != checksum.next<std::uint32_t>())
    return damaged_file(format, "its checksum does not match");
  return FileBody{file.subspan(kHeader, std::size_t(header->size)), header->newer_minor};
}

Result<std::vector<std::uint8_t>> load_file(const FileFormat& format,
                                            const std::filesystem::path& path) {
  fap::detail::WholeLimits limits;
  limits.bytes = std::numeric_limits<std::int64_t>::max();  // its header says how many they are
  limits.look = [&](std::span<const std::uint8_t> first) -> Result<void> {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    const auto stated = read_header(format, first, unknown ? first.size() : std::size_t(size));
    return stated ? Result<void>() : stated.error();
  };
  auto bytes = fap::detail::read_whole(path, limits);
  if (bytes) return bytes;
  Error error = bytes.error();
  if (error.code == Code::not_found) error.message = "cannot open " + the(format);
  return std::move(error).in_file(path.string());
}

}  // namespace animeme::dam
