#include "fap/players.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"
#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

constexpr std::size_t kRoomForName = 254;  // bytes, of Xface

enum class Trouble : std::uint8_t {
  header,
  rate,
  name,
  comment,
  blank,
  flags,
  number,
  values,
  side,
  missing,
  high_level,
  beside,
  count,
  end,
  kinds,  // keep last
};

std::optional<std::int64_t> whole_number(std::string_view word) {
  std::int64_t value = 0;
  const char* last = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), last, value);
  if (code != std::errc() || stop != last) return std::nullopt;
  return value;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != line.npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::string names_of(const Mask& mask) {
  std::string text;
  int more = 0;
  for (const FapInfo& fap : kFaps) {
    if (!mask[std::size_t(fap.number)]) continue;
    if (text.size() > 60) {
      ++more;
    } else {
      text += (text.empty() ? "FAP " : ", ") + std::to_string(fap.number);
    }
  }
  return more == 0 ? text : text + " and " + std::to_string(more) + " more";
}

class PlayerCheck {
 public:
  PlayerCheck(std::string_view text, const PlayerOptions& options)
      : text_(text), options_(options) {}

  std::vector<std::string> problems() {
    if (header()) {
      bool whole = true;
      while (whole && next_line()) whole = frame();
      if (whole) end();
    }
    return notes_.lines();
  }

 private:
  // The next line with something in it; those without are trouble if one more follows.
  bool next_line() {
    for (std::int64_t blank = 0; !text_.empty(); ++line_) {
      const std::size_t end = text_.find('\n');
      const std::string_view line = text_.substr(0, end);
      last_newline_ = end != text_.npos;
      text_.remove_prefix(last_newline_ ? end + 1 : text_.size());
      words_ = words_of(line);
      if (words_.empty()) {
        if (blank == 0) blank = line_;
        continue;
      }
      if (blank != 0) tell(Trouble::blank, blank, "a blank line, the Java Greta counts it");
      if (words_.front().front() != '#') {
        at_ = line_++;
        return true;
      }
      tell(Trouble::comment, line_,
           at_ == 0 ? "a comment, the Java Greta reads no frames behind it"
                    : "a comment, Xface crashes and the Java Greta misreads what follows");
    }
    return false;
  }

  bool header() {
    line_ = 1;
    if (!next_line()) {
      tell(Trouble::header, 1, "there is no header and no frame");
      return false;
    }
    if (words_.size() != 4 || !words_[0].starts_with("2.")) {
      tell(Trouble::header, at_,
           "this is not a header '2.1 name rate frames' of four words, without which Greta refuses "
           "the text and Xface crashes");
      return false;
    }
    const auto rate = whole_number(words_[2]);
    if (!rate || *rate < 1) {
      tell(Trouble::rate, at_,
           "the rate " + detail::in_quotes(words_[2]) +
               " is not whole: Greta refuses it, Xface truncates it");
    }
    if (words_[1].size() > kRoomForName) {
      tell(Trouble::name, at_, "the name is longer than 254 bytes, for which Xface has no room");
    }
    count_ = whole_number(words_[3]).value_or(-1);
    count_line_ = at_;
    return true;
  }

  bool frame() {
    Mask mask;
    if (words_.size() != std::size_t(kFapCount)) {
      tell(Trouble::flags, at_, "a mask has " + std::to_string(words_.size()) + " words, not 68");
      return false;
    }
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (words_[i] != "0" && words_[i] != "1") {
        tell(Trouble::flags, at_, "a mask has " + detail::in_quotes(words_[i]) + " for 0 or 1");
        return false;
      }
      mask[i + 1] = words_[i] == "1";
    }
    look_at(mask);
    if (!next_line()) {
      tell(Trouble::values, at_, "no values follow the last mask");
      return false;
    }
    return values(mask);
  }

  void look_at(const Mask& mask) {
    Mask lonely;
    for (const FapInfo& fap : kFaps) {
      if (mask[std::size_t(fap.number)] && fap.mirror != 0 && !mask[std::size_t(fap.mirror)]) {
        lonely.set(std::size_t(fap.mirror));
      }
    }
    if (lonely.any()) {
      tell(Trouble::side, at_, "the other side is present but not " + names_of(lonely));
    }
    if (const Mask gone = ever_ & ~mask; gone.any()) {
      tell(Trouble::missing, at_,
           names_of(gone) + " was present before and is missing: Xface shows 0");
    }
    ever_ |= mask;
    Mask low = mask;
    low.reset(1);
    low.reset(2);
    if (low == mask) return;
    if (low.any()) {
      tell(Trouble::beside, at_,
           "FAP 1 or 2 with low-level FAPs: Greta drops the former, Xface the latter");
    } else if (!options_.high_level) {
      tell(Trouble::high_level, at_,
           "Greta ignores FAP 1 and 2; animeme decode --expand converts them to low-level "
           "FAPs");
    }
  }

  bool values(const Mask& mask) {
    const std::size_t wanted = 1 + mask.count() + (mask[1] ? 3 : 0) + (mask[2] ? 5 : 0);
    if (words_.size() != wanted) {
      tell(Trouble::values, at_,
           "the line has " + std::to_string(words_.size()) + " words for a number and " +
               std::to_string(wanted - 1) + " values");
      return false;
    }
    for (const std::string_view word : words_) {
      if (whole_number(word)) continue;
      tell(Trouble::values, at_,
           detail::in_quotes(word) + " is not a whole number: Greta misreads it");
      break;
    }
    const std::optional<std::int64_t> number = whole_number(words_.front());
    if (number && *number != frames_) {
      tell(Trouble::number, at_,
           "the number of frame " + std::to_string(frames_) + " is " + std::to_string(*number) +
               ": Xface, which takes it as an index, crashes, and Greta loses time");
    }
    ++frames_;
    return true;
  }

  void end() {
    if (count_ != frames_) {
      tell(Trouble::count, count_line_,
           "the header says " + std::to_string(count_) + " frames, there are " +
               std::to_string(frames_));
    }
    if (!last_newline_) {
      tell(Trouble::end, line_ - 1, "no newline at the end, where Greta hangs");
    }
  }

  void tell(Trouble trouble, std::int64_t line, std::string text) {
    notes_.add(trouble, line, [&] { return std::move(text); });
  }

  std::string_view text_;  // what is still to be read
  PlayerOptions options_;
  std::vector<std::string_view> words_;  // of the line at_
  std::int64_t line_ = 1;                // the next one
  std::int64_t at_ = 0;
  std::int64_t count_ = 0;
  std::int64_t count_line_ = 1;
  std::int64_t frames_ = 0;
  Mask ever_;
  bool last_newline_ = true;
  detail::LineNotes<Trouble, std::size_t(Trouble::kinds)> notes_;
};

}  // namespace

std::vector<std::string> player_problems(std::string_view text, const PlayerOptions& options) {
  return PlayerCheck(text, options).problems();
}

}  // namespace animeme::fap
