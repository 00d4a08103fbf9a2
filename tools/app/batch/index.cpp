#include "tools/app/batch/index.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "tools/formats/common/text.h"

namespace animeme::batch {

namespace {

constexpr std::string_view kHeader =
    "id\tstate\toutputs\tseconds\tbytes\tconfidence\twarnings\terror\thash\tversion\n";
constexpr std::size_t kFields = 10;

Error io_error(const std::string& path) {
  return make_error(Code::io, std::strerror(errno)).in_file(path);
}

// What would end a field or a line becomes a blank.
std::string field(std::string text) {
  for (char& c : text) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  return text;
}

std::vector<std::string> parted(std::string_view text, std::string_view between) {
  std::vector<std::string> list;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(between, at), text.size());
    list.emplace_back(text.substr(at, end - at));
    at = end + between.size();
  }
  return list;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
  return value;
}

}  // namespace

std::string index_name(int shard, int shards) {
  return shards <= 1 ? "index.tsv"
                     : "index." + std::to_string(shard) + "-of-" + std::to_string(shards) + ".tsv";
}

std::string_view index_header() { return kHeader; }

std::string index_line(const Entry& entry) {
  std::string line = field(entry.id) + "\t" + (entry.good ? "ok" : "error") + "\t" +
                     field(tools::joined(entry.outputs, "|")) + "\t";
  if (entry.seconds) line += tools::format("%.3f", *entry.seconds);
  line += "\t" + std::to_string(entry.bytes) + "\t";
  if (entry.confidence) line += tools::format("%.3f", *entry.confidence);
  return line + "\t" + field(tools::joined(entry.warnings, " | ")) + "\t" + field(entry.error) +
         "\t" + entry.hash + "\t" + entry.version + "\n";
}

std::optional<Entry> read_index_line(std::string_view line) {
  std::array<std::string_view, kFields> fields;
  for (std::size_t i = 0, at = 0; i < kFields; ++i) {
    const std::size_t end = line.find('\t', at);
    if ((end == std::string_view::npos) != (i + 1 == kFields)) return {};
    fields[i] = line.substr(at, end - at);
    at = end + 1;
  }
  Entry entry;
  entry.id = fields[0];
  entry.good = fields[1] == "ok";
  entry.outputs = parted(fields[2], "|");
  entry.seconds = number<double>(fields[3]);
  entry.bytes = number<std::uint64_t>(fields[4]).value_or(0);
  entry.confidence = number<double>(fields[5]);
  entry.warnings = parted(fields[6], " | ");
  entry.error = fields[7];
  entry.hash = fields[8];
  entry.version = fields[9];
  return entry;
}

Result<Index> Index::open(const std::string& path, bool repair) {
  Index index;
  index.path_ = path;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"),
                                                             std::fclose);
  if (!file) return errno == ENOENT ? Result<Index>(index) : io_error(path);
  std::int64_t offset = 0;
  std::string line;
  for (int c = 0; (c = ::getc_unlocked(file.get())) != EOF;) {
    if (c != '\n') {
      line += char(c);
      continue;
    }
    if (offset == 0 && line + "\n" != kHeader) {
      return error_at_line(Code::syntax, "this is not a batch index of this version", 1)
          .in_file(path);
    }
    const std::int64_t length = std::int64_t(line.size()) + 1;
    if (offset > 0) {
      if (const std::optional<Entry> entry = read_index_line(line)) {
        index.known_.push_back({stable_hash(entry->id),
                                entry->good ? stable_hash(entry->hash + "\t" + entry->version) : 0,
                                entry->bytes, offset, std::uint32_t(length)});
      }
    }
    offset += length;
    line.clear();
  }
  if (!line.empty() && repair && ::truncate(path.c_str(), offset) != 0) return io_error(path);
  // The last line of a clip counts.
  std::stable_sort(index.known_.begin(), index.known_.end(),
                   [](const Known& a, const Known& b) { return a.id < b.id; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < index.known_.size(); ++i) {
    if (i + 1 < index.known_.size() && index.known_[i + 1].id == index.known_[i].id) continue;
    index.known_[kept++] = index.known_[i];
  }
  index.known_.resize(kept);
  return index;
}

const Index::Known* Index::find(std::string_view id) const {
  const std::uint64_t hash = stable_hash(id);
  const auto at =
      std::lower_bound(known_.begin(), known_.end(), hash,
                       [](const Known& one, std::uint64_t key) { return one.id < key; });
  return at != known_.end() && at->id == hash ? &*at : nullptr;
}

Result<std::string> Index::line(const Known& known) const {
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return io_error(path_);
  std::string text(known.length, '\0');
  const ssize_t got = ::pread(descriptor, text.data(), text.size(), known.offset);
  ::close(descriptor);
  if (got != ssize_t(text.size())) return make_error(Code::io, "is cut short").in_file(path_);
  return text;
}

Result<IndexWriter> IndexWriter::open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return io_error(path);
  if (::lseek(descriptor, 0, SEEK_END) == 0 &&
      ::write(descriptor, kHeader.data(), kHeader.size()) != ssize_t(kHeader.size())) {
    const Error error = io_error(path);
    ::close(descriptor);
    return error;
  }
  return IndexWriter(path, descriptor);
}

IndexWriter::IndexWriter(IndexWriter&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

IndexWriter::~IndexWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> IndexWriter::add(const Entry& entry) {
  const std::string line = index_line(entry);
  if (::write(descriptor_, line.data(), line.size()) == ssize_t(line.size())) return {};
  return io_error(path_);
}

}  // namespace animeme::batch
