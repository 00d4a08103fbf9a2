#include "tools/app/commands/plane_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>

#include "tools/app/commands/damage.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/exchange/file_kind.h"
#include "tools/formats/exchange/motion.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

constexpr std::size_t kReadBytes = 1 << 16;
constexpr std::size_t kMostWarnings = 100;

// Bytes from a file or from memory, piece by piece.
class Pieces {
 public:
  Pieces(const std::string& path, std::span<const std::uint8_t> bytes) : rest_(bytes) {
    if (path.empty()) return;
    file_.emplace(path, std::ios::binary);
    buffer_.resize(kReadBytes);
  }

  // Empty: there is no more.
  std::span<const std::uint8_t> next() {
    std::span<const std::uint8_t> piece;
    if (file_) {
      file_->read(reinterpret_cast<char*>(buffer_.data()), std::streamsize(buffer_.size()));
      piece = {buffer_.data(), std::size_t(file_->gcount())};
    } else {
      piece = rest_.subspan(0, std::min(kReadBytes, rest_.size()));
      rest_ = rest_.subspan(piece.size());
    }
    read_ += std::int64_t(piece.size());
    return piece;
  }
  bool broken() const { return file_ && file_->bad(); }
  std::int64_t read() const { return read_; }  // bytes so far
  // Bytes in all, which are read up to the end.
  std::int64_t size() {
    while (!next().empty()) {
    }
    return read_;
  }

 private:
  std::optional<std::ifstream> file_;
  std::vector<std::uint8_t> buffer_;
  std::span<const std::uint8_t> rest_;
  std::int64_t read_ = 0;
};

}  // namespace

bool PlaneFile::can_read(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream in(path, std::ios::binary);
  std::uint8_t head[4] = {};
  in.read(reinterpret_cast<char*>(head), sizeof head);
  return in && exchange::kind_of(head) == exchange::FileKind::fba_stream;
}

std::optional<PlaneFile> PlaneFile::repaired(const std::string& name) const {
  const auto bytes = path_.empty() ? bytes_ : read_file(path_);
  if (!bytes) return std::nullopt;
  if (auto joined = fba::join_streams(*bytes)) {
    warn(name + ": " + exchange::note_of(*joined));
    return PlaneFile(std::move(joined->stream));
  }
  if (is_strict()) return std::nullopt;
  auto repaired = fba::repair_stream(*bytes);
  if (!repaired || repaired->damage.empty()) return std::nullopt;
  report_damage(name, repaired->damage);
  return PlaneFile(std::move(repaired->stream));
}

struct PlaneReader::Impl {
  explicit Impl(const std::string& given, std::span<const std::uint8_t> bytes)
      : path(given), pieces(given, bytes) {}

  void note(std::int64_t bit, const std::string& text) {
    if (warnings.size() < kMostWarnings) {
      warnings.push_back("bit " + std::to_string(bit) + ": " + text);
    }
  }

  std::string path;
  Pieces pieces;
  fba::Decoder decoder;
  fba::Event event;
  std::optional<fap::Rate> rate;
  std::optional<fba::StreamInfo> info;
  std::vector<std::string> warnings;
};

PlaneReader::PlaneReader(const PlaneFile& file)
    : impl_(std::make_unique<Impl>(file.path_, file.bytes_)) {}
PlaneReader::~PlaneReader() = default;

const std::vector<std::string>& PlaneReader::warnings() const { return impl_->warnings; }
const fba::StreamInfo& PlaneReader::info() const {
  static const fba::StreamInfo kNothing;
  return impl_->info ? *impl_->info : kNothing;
}
std::size_t PlaneReader::bytes() const { return std::size_t(impl_->pieces.read()); }

Result<const fba::Plane*> PlaneReader::next() {
  for (;;) {
    Result<fba::Event> event = impl_->decoder.next();
    if (!event) {
      const Error& error = event.error();
      if (error.code == Code::need_data) {
        const std::span<const std::uint8_t> piece = impl_->pieces.next();
        if (impl_->pieces.broken()) return make_error(Code::io, "cannot read").in_file(impl_->path);
        impl_->decoder.push(piece);
        if (piece.empty()) impl_->decoder.finish();
        continue;
      }
      if (error.code != Code::end_of_stream) return error;
      const std::int64_t ignored = impl_->pieces.size() - error.where.bit / 8;
      if (ignored > 0) {
        impl_->note(error.where.bit,
                    std::to_string(ignored) + " bytes after the end code are ignored");
      }
      return nullptr;
    }
    impl_->event = std::move(*event);
    const fba::Plane& plane = impl_->event.plane;
    switch (impl_->event.kind) {
      case fba::Event::Kind::info:
        if (!impl_->info) impl_->info = impl_->event.info;
        break;
      case fba::Event::Kind::warning:
        impl_->note(impl_->event.bit, impl_->event.text);
        break;
      case fba::Event::Kind::plane:
        if (!impl_->rate) impl_->rate = plane.rate;
        if (plane.rate != *impl_->rate && plane.temporal.rate) {
          impl_->note(plane.bit_begin,
                      "the frame rate changes; the first one is kept for all planes");
        }
        return &plane;
    }
  }
}

Result<void> PlaneFile::for_each(const Take& take, std::vector<std::string>* warnings) const {
  PlaneReader reader(*this);
  for (;;) {
    const Result<const fba::Plane*> plane = reader.next();
    if (!plane) return plane.error();
    if (*plane == nullptr) break;
    if (auto done = take(**plane); !done) return done;
  }
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), reader.warnings().begin(), reader.warnings().end());
  }
  return {};
}

}  // namespace animeme::tools
