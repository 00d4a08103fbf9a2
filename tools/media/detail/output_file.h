// Whole files or none: content goes to a temporary file in the same folder, which takes the
// wanted name at the end.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::media {

class OutputFile {
 public:
  /// Creates "<path>.partN", empty. A symbolic link is followed, so that its target is replaced.
  /// Errors: io (folder missing or not writable, or `path` is no ordinary file).
  static Result<OutputFile> create(const std::string& path);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  ///< removes the temporary file unless commit() succeeded

  const std::string& temporary() const { return temporary_; }
  /// Gives the file its name. Error: io.
  Result<void> commit();

 private:
  OutputFile() = default;
  std::string path_;
  std::string temporary_;  // empty: nothing to remove
};

}  // namespace animeme::media
