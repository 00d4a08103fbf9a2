#include "tools/media/detail/mp4_fix.h"

#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include "tools/media/detail/boxes.h"

namespace animeme::media {
namespace {

constexpr std::size_t kVisualFields = 78;  // of a VisualSampleEntry, behind the box header
constexpr std::size_t kAudioFields = 28;   // of an AudioSampleEntry, version 0
constexpr std::uint8_t kEsDescriptor = 3;

// Content of an esds: version and flags, then tag 3, a length of 1 to 4 bytes, then ES_ID.
void add_es_id(Bytes bytes, const Box& esds, std::vector<std::size_t>& found) {
  std::size_t at = esds.begin + 4;
  if (at >= esds.end || bytes[at++] != kEsDescriptor) return;
  for (int i = 0; i < 4 && at < esds.end; ++i) {
    if ((bytes[at++] & 0x80) == 0) break;
  }
  if (at + 2 <= esds.end) found.push_back(at);
}

void walk(Bytes bytes, const Box& parent, std::vector<std::size_t>& found, int depth) {
  for_each_box(bytes, parent.begin, parent.end, [&](const Box& box) {
    const std::string_view type = box.type;
    if (type == "trak" || type == "mdia" || type == "minf" || type == "stbl") {
      if (depth < 8) walk(bytes, box, found, depth + 1);
    } else if (type == "stsd" && box.end - box.begin >= 8) {
      walk(bytes, {type, box.begin + 8, box.end}, found, depth + 1);
    } else if (type == "mp4v" || type == "mp4a") {
      const std::size_t fields = type == "mp4v" ? kVisualFields : kAudioFields;
      if (box.end - box.begin < fields || depth >= 8) return;
      walk(bytes, {type, box.begin + fields, box.end}, found, depth + 1);
    } else if (type == "esds") {
      add_es_id(bytes, box, found);
    }
  });
}

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

Error io_error() { return make_error(Code::io, "the finished file cannot be read again"); }

// Position and size of the top-level moov box; size 0: not found.
Result<void> find_moov(std::FILE* file, std::uint64_t& at, std::uint64_t& size) {
  at = 0;
  for (;;) {
    std::uint8_t header[16] = {};
    if (std::fseek(file, long(at), SEEK_SET) != 0) return io_error();
    const std::size_t got = std::fread(header, 1, sizeof header, file);
    if (got < 8) return make_error(Code::internal, "the finished file has no moov box");
    size = read_big_endian(header, 0, 4);
    if (size == 1 && got == 16) size = read_big_endian(header, 8, 8);
    if (std::memcmp(header + 4, "moov", 4) == 0) return {};
    if (size < 8) return make_error(Code::internal, "the finished file has no moov box");
    at += size;
  }
}

}  // namespace

std::vector<std::size_t> find_es_ids(std::span<const std::uint8_t> moov) {
  std::vector<std::size_t> found;
  const Box box = box_at(moov, 0, moov.size());
  if (box.begin != 0 && box.type == "moov") walk(moov, box, found, 0);
  return found;
}

Result<void> clear_es_ids(const std::string& path) {
  const File file(std::fopen(path.c_str(), "r+b"));
  if (!file) return io_error();
  std::uint64_t at = 0;
  std::uint64_t size = 0;
  Result<void> found = find_moov(file.get(), at, size);
  if (!found) return found;
  std::vector<std::uint8_t> moov(static_cast<std::size_t>(size));
  if (std::fseek(file.get(), long(at), SEEK_SET) != 0 ||
      std::fread(moov.data(), 1, moov.size(), file.get()) != moov.size()) {
    return io_error();
  }
  const std::uint8_t zero[2] = {0, 0};
  for (const std::size_t offset : find_es_ids(moov)) {
    if (std::fseek(file.get(), long(at + offset), SEEK_SET) != 0 ||
        std::fwrite(zero, 1, 2, file.get()) != 2) {
      return io_error();
    }
  }
  return std::fflush(file.get()) == 0 ? Result<void>() : io_error();
}

}  // namespace animeme::media
