/// @file
/// Atomic output of a folder: files are written to a temporary folder with an unpredictable name
/// next to it.
#pragma once

#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::tools {

/// Checks that a folder exists and is writable, or can be created with its parents. Leaves nothing
/// behind. Errors: io.
Result<void> try_output_folder(const std::string& path);

/// A folder that gets its name when all its files are written.
class OutputFolder {
 public:
  /// Decides by the names of its files whether an existing folder may be replaced.
  using Replaceable = bool (*)(std::string_view file);

  /// Creates the temporary folder. Errors: io (not writable; `path` exists and is not a folder, or
  /// has a file that is not `replaceable`).
  static Result<OutputFolder> create(const std::string& path, Replaceable replaceable);
  OutputFolder(OutputFolder&& other) noexcept;  ///< movable
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();  ///< removes an uncommitted folder and restores the old one

  /// Path of a file in the temporary folder.
  std::string file(const std::string& name) const { return temporary_ + "/" + name; }
  /// Renames the folder to its final name; the old one is preserved until keep(). Errors: io.
  Result<void> commit();
  /// Removes the old folder.
  void keep();

 private:
  OutputFolder() = default;
  std::string path_;
  std::string temporary_;  // empty: has its name, or nothing to remove
  std::size_t note_ = 0;   // in the list of unfinished files
  std::string old_;        // where the old folder is kept; empty: there is none
  bool committed_ = false;
};

}  // namespace animeme::tools
