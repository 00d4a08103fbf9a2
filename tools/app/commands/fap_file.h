/// @file
/// FAP text in a file that is read as often as wanted, with a piece of it in memory at a time.
#pragma once

#include <functional>
#include <string>

#include "fap/result.h"
#include "fap/text_reader.h"
#include "tools/formats/exchange/motion.h"

namespace animeme::tools {

/// A file of FAP text.
class FapFile {
 public:
  /// Is this a file (no pipe, not standard input) with FAP text?
  static bool can_read(const std::string& path);
  /// Reads it for the first time, and prints its warnings. Errors, with the path: those of
  /// fap::read_text(), io.
  static Result<FapFile> open(const std::string& path,
                              exchange::FrameNumbers numbers = exchange::FrameNumbers::from_zero);

  const fap::TextSurvey& survey() const { return survey_; }  ///< what open() has found
  fap::TextReader reader() const;  ///< at the first frame; its errors are without the path

  using Take = std::function<Result<void>(const fap::Frame&)>;  ///< an error ends the reading
  /// All frames from the first on. Errors: those of open() and of `take`.
  Result<void> for_each(const Take& take) const;

 private:
  explicit FapFile(std::string path) : path_(std::move(path)) {}

  std::string path_;
  fap::TextSurvey survey_;
};

}  // namespace animeme::tools
