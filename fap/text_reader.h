/// @file
/// FAP text (fap/text.h) frame by frame, for clips that do not fit into memory. The text is read
/// twice: what it holds as a whole is known from the first time.
///
///     Result<TextSurvey> survey = survey_text(open_again());
///     if (!survey) return survey.error();
///     TextReader reader(open_again(), *survey);
///     for (;;) {
///       Result<const Frame*> frame = reader.next();
///       if (!frame) return frame.error();
///       if (*frame == nullptr) break;
///       use(**frame);
///     }
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/text.h"

namespace animeme::fap {

/// Gives the next bytes of a text: fills the span and returns how many bytes were written; 0: the
/// text is over. Its errors are passed on.
using ReadTextPiece = std::function<Result<std::size_t>(std::span<char>)>;

/// What is known of a text after it was read once.
struct TextSurvey {
  ReadTextOptions options;            ///< as they were given
  Rate rate;                          ///< frames per second
  std::string name;                   ///< as Sequence::name
  std::int64_t frames = 0;            ///< how many TextReader gives
  std::int64_t last = -1;             ///< number of the last one; -1: there is none
  Mask mask;                          ///< the FAPs that occur
  bool constant_number = false;       ///< all frames have the same number in the text
  std::vector<std::string> warnings;  ///< those of read_text()
};

/// Reads a whole text. Safe for untrusted input. Memory: half a megabyte, or four times the longest
/// stretch of comments, blank lines and one frame. Errors: those of read_text() and of `read`.
Result<TextSurvey> survey_text(ReadTextPiece read, const ReadTextOptions& options = {});

/// Gives the frames of read_text(), one after the other.
class TextReader {
 public:
  /// `read` gives the text from its beginning, `survey` is that of the same text.
  TextReader(ReadTextPiece read, const TextSurvey& survey);
  TextReader(TextReader&&) noexcept;  ///< movable
  TextReader& operator=(TextReader&&) noexcept;
  ~TextReader();

  /// The next frame, valid until the next call; null: there are no more. Errors: those of `read`;
  /// those of survey_text() if the text has changed since.
  Result<const Frame*> next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap
