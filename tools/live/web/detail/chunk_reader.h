// A body in chunks (RFC 9112, section 7.1), which libwebsockets hands on as it came.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace animeme::web {

class ChunkReader {
 public:
  /// Appends what is in the chunks to `body`. False: they are wrong, and nothing may follow.
  bool read(std::string_view bytes, std::string& body);
  /// The last chunk and what belongs to it were read; what follows is ignored.
  bool over() const { return state_ == State::over; }

 private:
  enum class State : std::uint8_t { size, data, end_of_data, trailer, over };
  bool line_ends();

  State state_ = State::size;
  std::string line_;      // of a size or trailer so far
  std::size_t left_ = 0;  // of the chunk
  std::size_t trailers_ = 0;
};

}  // namespace animeme::web
