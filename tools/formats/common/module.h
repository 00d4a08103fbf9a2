/// @file
/// Modules: shared objects that the program loads when it first needs what they are linked with.
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace animeme::tools {

/// Loads a module by the name of its file: from beside the program (the build tree), else from
/// where it was installed to: `installed`, seen from the program, as both may have been moved.
/// `flags`: of dlopen(). nullptr: `problem` says why.
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
