#include "tools/formats/media/detail/mp4/growing_mp4.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/mp4/mp4_fix.h"

namespace animeme::media {
namespace {

constexpr std::size_t kTypeAt = 4;         // in a box
constexpr std::size_t kFullBoxHeader = 4;  // version and flags, in front of the length in mehd
constexpr std::array<std::uint8_t, 4> kFree = {'f', 'r', 'e', 'e'};
constexpr std::array<std::uint8_t, 4> kFragment = {'m', 'o', 'o', 'f'};

}  // namespace

GrowingMp4::~GrowingMp4() {
  if (file_ >= 0) ::close(file_);
}

Result<void> GrowingMp4::open(const std::string& path) {
  file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  return file_ >= 0 ? Result<void>() : write_error(AVERROR(errno));
}

void GrowingMp4::take(std::span<const std::uint8_t> bytes) {
  taken_.insert(taken_.end(), bytes.begin(), bytes.end());
}

bool GrowingMp4::put(std::uint64_t at, std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(file_, bytes.data(), bytes.size(), off_t(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += std::uint64_t(count);
    bytes = bytes.subspan(std::size_t(count));
  }
  return true;
}

/// `bytes` with contents that have a length; where that stands is noted. Unchanged: there are no
/// contents yet.
std::vector<std::uint8_t> GrowingMp4::complete_head(Bytes bytes) {
  const Box moov = find_box(bytes, {"", 0, bytes.size()}, "moov");
  std::vector<std::uint8_t> out(bytes.begin(), bytes.end());
  if (moov.begin == 0) return out;
  const std::size_t begin = moov.begin - 8;
  const auto contents = complete_moov(bytes.subspan(begin, moov.end - begin), TrackTypes(), 0);
  out.resize(begin);
  out.insert(out.end(), contents.begin(), contents.end());
  const Box whole = find_box(out, {"", begin, out.size()}, "moov");
  const Box extends = find_box(out, whole, "mvex");
  const Box length = find_box(out, extends, "mehd");
  if (length.begin != 0) length_at_ = end_ + length.begin + kFullBoxHeader;
  out.insert(out.end(), bytes.begin() + std::ptrdiff_t(moov.end), bytes.end());
  return out;
}

Result<void> GrowingMp4::write(std::uint64_t ticks) {
  std::vector<std::uint8_t> bytes = length_at_ ? taken_ : complete_head(taken_);
  taken_.clear();
  // Readers refuse a file that ends within a moof. Whoever kills the program while it writes leaves
  // free space there.
  std::vector<std::size_t> fragments;
  for_each_box(bytes, 0, bytes.size(), [&](const Box& box) {
    if (box.type == "moof") fragments.push_back(box.begin - 8 + kTypeAt);
  });
  for (const std::size_t at : fragments) {
    std::copy(kFree.begin(), kFree.end(), bytes.begin() + std::ptrdiff_t(at));
  }
  bool good = put(end_, bytes);
  for (const std::size_t at : fragments) good = good && put(end_ + at, kFragment);
  end_ += bytes.size();
  if (length_at_) {
    std::array<std::uint8_t, 8> length{};
    write_big_endian(length, 0, 8, ticks);
    good = good && put(*length_at_, length);
  }
  return good ? Result<void>() : write_error(AVERROR(errno));
}

}  // namespace animeme::media
