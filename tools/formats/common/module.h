/// @file
/// Modules: shared objects that the program loads on first use, with the libraries that they are
/// linked with.
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace animeme::tools {

/// Loads a module by its file name from the program's folder (build tree), or else from
/// `installed`, a path relative to the program, as an installation may be moved. `flags`: for
/// dlopen(). Returns nullptr on failure, with the reason in `problem`.
inline void* load_module(const std::string& name, const char* installed, int flags,
                         std::string& problem) {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  problem.clear();
  for (const std::filesystem::path& place : {folder, folder / installed}) {
    const std::string path = (place / name).string();
    if (void* module = dlopen(path.c_str(), flags)) return module;
    if (std::filesystem::exists(path, ignored) || problem.empty()) problem = dlerror();
  }
  return nullptr;
}

}  // namespace animeme::tools
