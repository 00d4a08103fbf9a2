// A text that is read piece by piece, of which a window is in memory. Internal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"
#include "fap/result.h"

namespace animeme::fap::detail {

/// Reads parts of the text, as large as they are. What a part is read from is in memory as a whole:
/// if its reader comes to the end of the window, the window grows and the part is read again.
class TextWindow {
 public:
  /// Fills the span and returns how many bytes it has; 0: the text is over.
  using Read = std::function<Result<std::size_t>(std::span<char>)>;

  explicit TextWindow(Read read) : read_(std::move(read)) {}

  /// read(scanner, notes) reads one part, and gives a Result. Its notes are added to `notes` once
  /// it is final. Errors: those of `read` and of the text's source.
  template <class Part>
  auto read(TextNotes& notes, const Part& part)
      -> decltype(part(std::declval<TextScanner&>(), std::declval<TextNotes&>())) {
    for (;;) {
      bool end_seen = false;
      TextScanner scanner(rest(), place_, end_seen);
      auto result = part(scanner, found_);
      const bool final = !end_seen || over_;
      if (final) {
        at_ = std::size_t(scanner.position() - buffer_.data());
        place_ = scanner.place();
        if (found_.any()) notes.add(found_);
      }
      if (found_.any()) found_ = {};
      if (final) return result;
      if (auto more = refill(); !more) return more.error();
    }
  }

  /// What is in memory and was not read yet; at least `bytes` of it if the text has so many.
  Result<std::string_view> ahead(std::size_t bytes) {
    while (!over_ && rest().size() < bytes) {
      if (auto more = refill(); !more) return more.error();
    }
    return rest();
  }
  /// Leaves these bytes out.
  void skip(std::size_t bytes) { at_ += bytes; }

 private:
  static constexpr std::size_t kLeast = 1 << 17;  // bytes that are asked for at once

  std::string_view rest() const { return {buffer_.data() + at_, size_ - at_}; }

  Result<void> refill() {
    std::copy(buffer_.data() + at_, buffer_.data() + size_, buffer_.data());
    size_ -= at_;
    at_ = 0;
    if (buffer_.size() < size_ + kLeast) buffer_.resize(2 * (size_ + kLeast));
    const Result<std::size_t> more = read_({buffer_.data() + size_, buffer_.size() - size_});
    if (!more) return more.error();
    over_ = *more == 0;
    size_ += *more;
    return {};
  }

  Read read_;
  std::vector<char> buffer_;
  std::size_t at_ = 0;    // of the first byte that was not read
  std::size_t size_ = 0;  // bytes of the buffer that are text
  bool over_ = false;
  TextPlace place_;
  TextNotes found_;  // of the part that is being read
};

}  // namespace animeme::fap::detail
