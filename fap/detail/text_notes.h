// Collects what is to be said of the lines of a FAP text. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::fap::detail {

/// The quirks of real files that are read with a warning.
enum class Quirk : std::uint8_t {
  byte_order_mark,
  no_header,
  version,
  blanks_in_name,
  no_name,
  no_rate,
  no_count,
  wrong_count,
  extra_flag,
  mask_length,
  one_line,
  wrapped_mask,
  wrapped_values,
  rounded,
  single_high_level,
  high_level_range,
  first_number,
  repeated_number,
  restarted_number,
  constant_number,
  count,  // keep last
};

/// One entry per kind of note, so that memory stays constant on any input.
template <class Kind, std::size_t kKinds>
class LineNotes {
 public:
  /// `text` may be made on the fly: it is only called for at the first occurrence.
  template <class MakeText>
  void add(Kind kind, std::int64_t line, MakeText text) {
    Note& note = notes_[std::size_t(kind)];
    any_ = true;
    if (note.count++ == 0) {
      note.line = line;
      note.text = text();
    }
  }
  /// Adds what was noted behind all of this.
  void add(const LineNotes& later) {
    for (std::size_t i = 0; i < kKinds; ++i) {
      if (notes_[i].count == 0) {
        notes_[i] = later.notes_[i];
      } else {
        notes_[i].count += later.notes_[i].count;
      }
    }
    any_ = any_ || later.any_;
  }
  bool any() const { return any_; }

  /// "line N: ..." in the order of lines.
  std::vector<std::string> lines() const {
    std::vector<const Note*> seen;
    for (const Note& note : notes_) {
      if (note.count > 0) seen.push_back(&note);
    }
    std::stable_sort(seen.begin(), seen.end(),
                     [](const Note* a, const Note* b) { return a->line < b->line; });
    std::vector<std::string> lines;
    for (const Note* note : seen) {
      std::string line = "line " + std::to_string(note->line) + ": " + note->text;
      if (note->count > 1) {
        line += " (and in " + std::to_string(note->count - 1) + " more place" +
                (note->count > 2 ? "s)" : ")");
      }
      lines.push_back(std::move(line));
    }
    return lines;
  }

 private:
  struct Note {
    std::int64_t count = 0;
    std::int64_t line = 0;
    std::string text;
  };
  std::array<Note, kKinds> notes_;
  bool any_ = false;
};

/// What the reader had to interpret.
using TextNotes = LineNotes<Quirk, std::size_t(Quirk::count)>;

}  // namespace animeme::fap::detail
