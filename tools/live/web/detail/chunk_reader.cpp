#include "tools/live/web/detail/chunk_reader.h"

#include <algorithm>
#include <charconv>

namespace animeme::web {
namespace {

constexpr std::size_t kMostLine = 256;  // of a size with its extension
constexpr std::size_t kMostTrailers = 4096;
constexpr std::size_t kMostDigits = 8;  // of a size

}  // namespace

// At the end of a line. False: it is none that may be here.
bool ChunkReader::line_ends() {
  if (line_.ends_with('\r')) line_.pop_back();
  if (state_ == State::trailer) {
    if (line_.empty()) state_ = State::over;
    trailers_ += line_.size() + 2;
    line_.clear();
    return trailers_ <= kMostTrailers;
  }
  if (state_ == State::end_of_data) {
    state_ = State::size;
    return line_.empty();
  }
  std::string_view digits = std::string_view(line_).substr(0, line_.find(';'));
  while (digits.ends_with(' ') || digits.ends_with('\t')) digits.remove_suffix(1);
  if (digits.empty() || digits.size() > kMostDigits) return false;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), left_, 16);
  if (read.ec != std::errc() || read.ptr != digits.data() + digits.size()) return false;
  state_ = left_ > 0 ? State::data : State::trailer;
  line_.clear();
  return true;
}

bool ChunkReader::read(std::string_view bytes, std::string& body) {
  while (!bytes.empty() && state_ != State::over) {
    if (state_ == State::data) {
      const std::size_t size = std::min(left_, bytes.size());
      body.append(bytes.substr(0, size));
      bytes.remove_prefix(size);
      left_ -= size;
      if (left_ == 0) state_ = State::end_of_data;
      continue;
    }
    const char next = bytes.front();
    bytes.remove_prefix(1);
    if (next == '\n') {
      if (!line_ends()) return false;
    } else {
      line_ += next;
      if (line_.size() > (state_ == State::trailer ? kMostTrailers : kMostLine)) return false;
    }
  }
  return true;
}

}  // namespace animeme::web
