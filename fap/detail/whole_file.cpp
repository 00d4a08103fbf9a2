#include "fap/detail/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "fap/detail/text_scanner.h"

namespace animeme::fap::detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFirst = 4096, kBlock = std::size_t(1) << 18;

Error too_large(std::uint64_t limit) {
  const bool mega = limit >= std::uint64_t(1) << 20;
  return make_error(Code::out_of_range,
                    "is larger than " + std::to_string(mega ? limit >> 20 : limit) +
                        (mega ? " MB" : " bytes") + ", the most that is read; give a part of it");
}

Error with_reason(const char* what, int reason) {
  return make_error(reason == ENOENT || reason == ENOTDIR ? Code::not_found : Code::io,
                    what + (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
}

Result<void> look_at(std::span<const std::uint8_t> first, const WholeLimits& limits) {
  const auto zero = [](std::uint8_t byte) { return byte == 0; };
  if (first.size() == kFirst && std::all_of(first.begin(), first.end(), zero)) {
    return make_error(Code::syntax, "begins with " + std::to_string(kFirst) +
                                        " zero bytes, so it holds nothing; get the file again");
  }
  if (limits.text) {
    const std::string_view text(reinterpret_cast<const char*>(first.data()), first.size());
    const bool wide = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
                      unmarked_utf16(text).has_value();
    const std::size_t at = text.find('\0');
    if (!wide && at != std::string_view::npos) {
      return make_error(Code::syntax, "is no text: byte " + std::to_string(at + 1) +
                                          " is zero; give a text file");
    }
  }
  return limits.look ? limits.look(first) : Result<void>();
}

// `size`: as far as it is known before.
template <class Bytes>
Result<Bytes> read_all(std::istream& in, std::uint64_t size, const WholeLimits& limits) {
  if (size > limits.bytes) return too_large(limits.bytes);
  Bytes bytes;
  std::size_t wanted = kFirst;
  const auto grow = [&] {
    const std::size_t had = bytes.size();
    bytes.resize(had + wanted);
    in.read(reinterpret_cast<char*>(bytes.data() + had), std::streamsize(wanted));
    bytes.resize(had + std::size_t(in.gcount()));
  };
  grow();
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (auto good = look_at({data, bytes.size()}, limits); !good) return good.error();
  bytes.reserve(std::size_t(size));
  wanted = kBlock;
  while (in) {
    // Where the size is known, nothing is allocated beyond it.
    if (bytes.size() < size) wanted = std::min(kBlock, std::size_t(size) - bytes.size());
    if (bytes.size() == size) wanted = 1;
    grow();
    if (bytes.size() > limits.bytes) return too_large(limits.bytes);
    wanted = kBlock;
  }
  if (in.bad()) return with_reason("cannot read", errno);
  return bytes;
}

// Devices that end, or that a person types into.
bool is_endless_device(const fs::path& path) {
  std::error_code ignored;
  const fs::file_type type = fs::status(path, ignored).type();
  if (type == fs::file_type::block) return true;
  return type == fs::file_type::character && path != "/dev/null" && path != "/dev/tty" &&
         path != "/dev/stdin";
}

template <class Bytes>
Result<Bytes> read_path(const fs::path& path, const WholeLimits& limits) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) {
    return make_error(Code::io, "this is a folder, a file is needed");
  }
  if (is_endless_device(path)) return make_error(Code::io, "this is a device, a file is needed");
  const std::uintmax_t told = fs::is_regular_file(path, unknown) ? fs::file_size(path, unknown) : 0;
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return with_reason("cannot open", errno);
  return read_all<Bytes>(in, unknown ? 0 : told, limits);
}

}  // namespace

Result<std::vector<std::uint8_t>> read_whole(const fs::path& path, const WholeLimits& limits) {
  return read_path<std::vector<std::uint8_t>>(path, limits);
}

Result<std::string> read_whole_text(const fs::path& path, WholeLimits limits) {
  limits.text = true;
  return read_path<std::string>(path, limits);
}

Result<std::vector<std::uint8_t>> read_whole(std::istream& in, const WholeLimits& limits) {
  return read_all<std::vector<std::uint8_t>>(in, 0, limits);
}

Result<std::string> read_whole_text(std::istream& in, WholeLimits limits) {
  limits.text = true;
  return read_all<std::string>(in, 0, limits);
}

}  // namespace animeme::fap::detail
