#include "tools/formats/media/detail/mp4/mp4_fix.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/detail/mp4/box_writer.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/mp4/fragment_index.h"
#include "tools/formats/media/detail/tracks/text_samples.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kInitialObjectDescriptor = 0x10, kTrackReference = 0x0E;
constexpr std::size_t kProfileBytes = 7;  // of an initial object descriptor without streams

// Content of an esds: version and flags, then tag 3, a length of 1 to 4 bytes, then ES_ID.
void add_es_id(Bytes bytes, const Box& esds, std::vector<std::size_t>& found) {
  std::size_t at = esds.begin + 4;
  if (at >= esds.end || bytes[at++] != kEsDescriptor) return;
  for (int i = 0; i < 4 && at < esds.end; ++i) {
    if ((bytes[at++] & 0x80) == 0) break;
  }
  if (at + 2 <= esds.end) found.push_back(at);
}

bool holds_tables(std::string_view type) {
  return type == "moov" || type == "trak" || type == "mdia" || type == "minf" || type == "stbl";
}

void walk(Bytes bytes, const Box& parent, std::vector<std::size_t>& found, int depth) {
  for_each_box(bytes, parent.begin, parent.end, [&](const Box& box) {
    const std::string_view type = box.type;
    if (holds_tables(type)) {
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

// Tracks of MPEG-4 systems, in their order.
std::vector<std::uint32_t> tracks_with_descriptor(Bytes moov, const Box& whole) {
  std::vector<std::uint32_t> ids;
  for_each_box(moov, whole.begin, whole.end, [&](const Box& box) {
    if (box.type != "trak") return;
    std::vector<std::size_t> found;
    walk(moov, box, found, 0);
    if (!found.empty()) ids.push_back(track_id(moov, box));
  });
  return ids;
}

// next_track_ID, the last field of mvhd: libavformat counts only the tracks that had a sample when
// it wrote the contents of fragments.
void set_next_track_id(std::span<std::uint8_t> moov, const Box& whole) {
  constexpr std::size_t kSize = 100;  // of the content of mvhd, short form
  std::uint32_t last = 0;
  for_each_box(moov, whole.begin, whole.end, [&](const Box& box) {
    if (box.type == "trak") last = std::max(last, track_id(moov, box));
  });
  for_each_box(moov, whole.begin, whole.end, [&](const Box& box) {
    if (box.type != "mvhd" || box.end - box.begin < kSize) return;
    write_big_endian(moov, box.end - 4, 4, last + 1);
  });
}

// The content of iods as libavformat writes it, with the tracks behind the profiles.
void put_iods(BoxWriter& out, Bytes content, const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kHeader = 4 + 5;  // version and flags, tag, length in four bytes
  const bool known = content.size() == kHeader + kProfileBytes &&
                     content[4] == kInitialObjectDescriptor && content[8] == kProfileBytes;
  out.begin("iods");
  if (!known) {
    out.raw(content);
    out.end();
    return;
  }
  BoxWriter descriptor;
  descriptor.raw(content.subspan(kHeader));
  for (const std::uint32_t id : ids) {
    BoxWriter number;
    number.u32(id);
    descriptor.descriptor(kTrackReference, number.bytes());
  }
  out.u32(0);
  out.descriptor(kInitialObjectDescriptor, descriptor.bytes());
  out.end();
}

Result<void> shift_table(std::span<std::uint8_t> moov, const Box& table, std::uint64_t shift) {
  const std::size_t width = table.type == "co64" ? 8 : 4;
  const std::size_t first = table.begin + 8;  // version, flags, count
  for (std::size_t at = first; at + width <= table.end; at += width) {
    const std::uint64_t offset = read_big_endian(moov, at, width) + shift;
    if (width == 4 && offset > UINT32_MAX) {
      return make_error(Code::out_of_range,
                        "the file is too large to begin with its contents; write it without "
                        "faststart, or as .mkv");
    }
    write_big_endian(moov, at, width, offset);
  }
  return {};
}

Result<void> shift_in(std::span<std::uint8_t> moov, const Box& parent, std::uint64_t shift) {
  Result<void> done;
  for_each_box(moov, parent.begin, parent.end, [&](const Box& box) {
    if (!done) return;
    if (holds_tables(box.type)) done = shift_in(moov, box, shift);
    if (box.type == "stco" || box.type == "co64") done = shift_table(moov, box, shift);
  });
  return done;
}

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// A finished file that is opened again.
class Patch {
 public:
  explicit Patch(const std::string& path) : file_(std::fopen(path.c_str(), "r+b")) {}
  bool good() const { return file_ != nullptr; }
  std::size_t read(std::uint64_t at, std::span<std::uint8_t> bytes) {
    if (std::fseek(file_.get(), long(at), SEEK_SET) != 0) return 0;
    return std::fread(bytes.data(), 1, bytes.size(), file_.get());
  }
  bool write(std::uint64_t at, std::span<const std::uint8_t> bytes) {
    return std::fseek(file_.get(), long(at), SEEK_SET) == 0 &&
           std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
  }
  bool end_at(std::uint64_t size) {
    return std::fflush(file_.get()) == 0 && ::ftruncate(::fileno(file_.get()), off_t(size)) == 0;
  }
  std::uint64_t size() {
    return std::fseek(file_.get(), 0, SEEK_END) == 0 ? std::uint64_t(std::ftell(file_.get())) : 0;
  }
  // Moves [begin, end) to `to`, in either direction.
  bool move(std::uint64_t begin, std::uint64_t end, std::uint64_t to) {
    std::vector<std::uint8_t> block(std::size_t(1) << 20);
    for (std::uint64_t done = 0; done < end - begin;) {
      const auto count = std::size_t(std::min<std::uint64_t>(block.size(), end - begin - done));
      const std::span<std::uint8_t> part(block.data(), count);
      // What is overwritten has been moved already.
      const std::uint64_t at = to > begin ? end - begin - done - count : done;
      if (read(begin + at, part) != count || !write(to + at, part)) return false;
      done += count;
    }
    return true;
  }

 private:
  std::unique_ptr<std::FILE, Closer> file_;
};

struct BoxPlace {
  std::uint64_t at = 0;
  std::uint64_t size = 0;
};

struct FileBoxes {
  BoxPlace brand, contents;         // ftyp and moov; size 0: not there
  std::vector<BoxPlace> fragments;  // moof
};

FileBoxes find_boxes(Patch& file) {
  FileBoxes found;
  std::uint64_t at = 0;
  for (;;) {
    std::array<std::uint8_t, 16> header{};
    const std::size_t got = file.read(at, header);
    if (got < 8) return found;
    std::uint64_t size = read_big_endian(header, 0, 4);
    if (size == 1 && got == 16) size = read_big_endian(header, 8, 8);
    if (size < 8) return found;
    if (std::memcmp(header.data() + 4, "ftyp", 4) == 0) found.brand = {at, size};
    if (std::memcmp(header.data() + 4, "moov", 4) == 0) found.contents = {at, size};
    if (std::memcmp(header.data() + 4, "moof", 4) == 0) found.fragments.push_back({at, size});
    at += size;
  }
}

// Goes through the fragments of the file.
Result<FragmentIndex> read_fragments(Patch& file, Bytes moov, const std::vector<BoxPlace>& places) {
  FragmentIndex index(moov);
  std::vector<std::uint8_t> moof;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::uint64_t end = i + 1 < places.size() ? places[i + 1].at : file.size();
    moof.resize(std::size_t(places[i].size));
    if (file.read(places[i].at, moof) != moof.size()) return write_error(AVERROR(EIO));
    index.add(moof, end - places[i].at);
  }
  return index;
}

// The completed contents to their place; everything from `tail` to `end` moves behind them, and the
// file ends there.
bool replace(Patch& file, std::uint64_t at, std::uint64_t tail, std::uint64_t end,
             std::span<const std::uint8_t> moov) {
  const std::uint64_t next = at + moov.size();
  return file.move(tail, end, next) && file.write(at, moov) && file.end_at(next + end - tail);
}

}  // namespace

std::vector<std::size_t> find_es_ids(std::span<const std::uint8_t> moov) {
  std::vector<std::size_t> found;
  const Box box = box_at(moov, 0, moov.size());
  if (box.begin != 0 && box.type == "moov") walk(moov, box, found, 0);
  return found;
}

std::vector<std::uint8_t> complete_moov(std::span<const std::uint8_t> moov, const TrackTypes& types,
                                        std::optional<std::uint64_t> duration) {
  std::vector<std::uint8_t> cleared(moov.begin(), moov.end());
  for (const std::size_t at : find_es_ids(moov)) cleared[at] = cleared[at + 1] = 0;
  const Box whole = box_at(cleared, 0, cleared.size());
  if (whole.begin == 0) return cleared;
  set_next_track_id(cleared, whole);
  hide_texts(cleared);
  const std::vector<std::uint32_t> ids = tracks_with_descriptor(cleared, whole);
  const Bytes bytes(cleared);
  BoxWriter out;
  out.begin("moov");
  for_each_box(bytes, whole.begin, whole.end, [&](const Box& box) {
    const Bytes content = bytes.subspan(box.begin, box.end - box.begin);
    if (box.type == "iods") {
      put_iods(out, content, ids);
    } else if (box.type == "trak" && becomes_metadata(bytes, box, types)) {
      put_metadata(out, bytes, box);
    } else {
      out.begin(box.type);
      if (box.type == "mvex" && duration) {
        out.begin_full("mehd", 1, 0);
        out.u64(*duration);
        out.end();
      }
      out.raw(content);
      out.end();
    }
  });
  out.end();
  if (!types.marks.empty()) return marked_moov(out.bytes(), types.marks);
  return out.bytes();
}

Result<void> shift_chunks(std::span<std::uint8_t> moov, std::uint64_t shift) {
  return shift_in(moov, {"", 0, moov.size()}, shift);
}

Result<void> complete_mp4(const std::string& path, Layout layout, const TrackTypes& types) {
  const auto failed = [] { return write_error(AVERROR(errno != 0 ? errno : EIO)); };
  errno = 0;
  Patch file(path);
  if (!file.good()) return failed();
  const auto [brand, contents, fragments] = find_boxes(file);
  if (contents.size == 0) {
    return make_error(Code::internal, "the finished file has no moov box");
  }
  std::vector<std::uint8_t> old(static_cast<std::size_t>(contents.size));
  if (file.read(contents.at, old) != old.size()) return failed();
  const std::uint64_t moov_end = contents.at + contents.size;
  if (layout == Layout::indexed && !fragments.empty()) {
    Result<FragmentIndex> index = read_fragments(file, old, fragments);
    if (!index) return index.error();
    std::vector<std::uint8_t> moov = complete_moov(old, types, index->duration());
    append(moov, index->boxes());
    return replace(file, contents.at, moov_end, file.size(), moov) ? Result<void>() : failed();
  }
  std::vector<std::uint8_t> moov = complete_moov(old, types);
  const std::uint64_t brand_end = brand.at + brand.size;
  const bool last = moov_end == file.size();
  if (last && layout != Layout::as_written && contents.at > brand_end) {
    if (auto shifted = shift_chunks(moov, moov.size()); !shifted) return shifted;
    return replace(file, brand_end, brand_end, contents.at, moov) ? Result<void>() : failed();
  }
  // Data behind the contents lies in fragments, which count from their own beginnings.
  return replace(file, contents.at, moov_end, file.size(), moov) ? Result<void>() : failed();
}

}  // namespace animeme::media
