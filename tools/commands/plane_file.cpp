#include "tools/commands/plane_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>

#include "tools/exchange/file_kind.h"

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

Result<void> PlaneFile::for_each(const Take& take, std::vector<std::string>* warnings) const {
  Pieces pieces(path_, bytes_);
  fba::Decoder decoder;
  std::optional<fap::Rate> rate;
  const auto note = [&](std::int64_t bit, const std::string& text) {
    if (warnings == nullptr || warnings->size() >= kMostWarnings) return;
    warnings->push_back("bit " + std::to_string(bit) + ": " + text);
  };
  for (;;) {
    const Result<fba::Event> event = decoder.next();
    if (event && event->kind == fba::Event::Kind::warning) note(event->bit, event->text);
    if (event && event->kind == fba::Event::Kind::plane) {
      const fba::Plane& plane = event->plane;
      if (!rate) rate = plane.rate;
      if (plane.rate != *rate && plane.temporal.rate) {
        note(plane.bit_begin, "the frame rate changes; the first one is kept for all planes");
      }
      if (auto done = take(plane); !done) return done;
    }
    if (event) continue;
    const Error& error = event.error();
    if (error.code == Code::need_data) {
      const std::span<const std::uint8_t> piece = pieces.next();
      if (pieces.broken()) return make_error(Code::io, "cannot read").in_file(path_);
      decoder.push(piece);
      if (piece.empty()) decoder.finish();
      continue;
    }
    if (error.code != Code::end_of_stream) return error;
    if (warnings == nullptr) return {};
    const std::int64_t ignored = pieces.size() - error.where.bit / 8;
    if (ignored > 0) {
      note(error.where.bit, std::to_string(ignored) + " bytes after the end code are ignored");
    }
    return {};
  }
}

}  // namespace animeme::tools
