/// @file
/// A whole folder or none: files go into a temporary folder beside the wanted one, whose name
/// nobody can foresee.
#pragma once

#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::tools {

/// Whether a folder of this name is there and can be written into, or could be made with those
/// above it. Nothing stays behind. Errors: io.
Result<void> try_output_folder(const std::string& path);

/// A folder that takes its name when all its files are written.
class OutputFolder {
 public:
  /// May a folder that is there be replaced? Told by the names of the files in it.
  using Replaceable = bool (*)(std::string_view file);

  /// Creates the temporary folder. Errors: io (not writable; `path` is there and is no folder, or
  /// holds a file that is not `replaceable`).
  static Result<OutputFolder> create(const std::string& path, Replaceable replaceable);
  OutputFolder(OutputFolder&& other) noexcept;  ///< the other one no longer removes anything
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();  ///< removes what has not been committed, and puts the old folder back

  /// Path of a file in the temporary folder.
  std::string file(const std::string& name) const { return temporary_ + "/" + name; }
  /// Gives the folder its name; the old one is kept aside until keep(). Error: io.
  Result<void> commit();
  /// Removes the old folder for good.
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
