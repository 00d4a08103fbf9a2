/// @file
/// Modules: shared objects that the program loads on first use, with the libraries that they are
/// linked with. The program starts without these libraries, and runs where they are not installed.
///
/// A module exports a table of functions: a struct of pointers that both sides include. The module
/// exports it by ANIMEME_MODULE(table), the program gets it by load_functions(). For the list of
/// modules and how to add one, see tools/app/late/README.md. A target that includes this header
/// links animeme_modules, which defines ANIMEME_VERSION and ANIMEME_MODULE_FOLDER: where modules
/// are installed, as a path relative to the program, as an installation may be moved.
#pragma once

#include <dlfcn.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// A module, and what has to be installed for it.
struct Module {
  const char* file;      ///< its name, without a folder
  const char* use;       ///< what needs it, as the subject of a sentence: "text to speech"
  const char* library;   ///< what it is linked with
  const char* packages;  ///< the Debian 12 packages that have those libraries and their data
};

/// @{
/// The modules that exist.
inline constexpr Module kFfmpegModule = {"animeme_ffmpeg.so", "sound or video", "FFmpeg",
                                         "libavformat59 libswscale6"};
inline constexpr Module kEspeakModule = {"animeme_espeak.so", "text to speech", "espeak-ng",
                                         "libespeak-ng1 espeak-ng-data"};
inline constexpr Module kSphinxModule = {
    "animeme_sphinx.so", "alignment or recognition of speech", "pocketsphinx and speexdsp",
    "libpocketsphinx3 libsphinxbase3 libspeexdsp1 pocketsphinx-en-us"};
inline constexpr Module kTextModule = {"animeme_text.so", "text by script and language",
                                       "ICU, MeCab and CLD2", "libicu72 libmecab2 libcld2-0"};
inline constexpr Module kXmlModule = {"animeme_xml.so", "a face definition file in XML", "libxml2",
                                      "libxml2"};
inline constexpr Module kWebrtcModule = {
    "animeme_webrtc.so", "WebRTC", "GStreamer",
    "libgstreamer-plugins-bad1.0-0 libcurl3-gnutls gstreamer1.0-plugins-good "
    "gstreamer1.0-plugins-bad gstreamer1.0-nice"};
inline constexpr Module kMpiModule = {"animeme_mpi.so", "training in many processes", "OpenMPI",
                                      "libopenmpi3 openmpi-bin"};
/// @}

/// All of them.
inline constexpr Module kModules[] = {kFfmpegModule, kEspeakModule, kSphinxModule, kTextModule,
                                      kXmlModule,    kWebrtcModule, kMpiModule};

/// The path of a module: in the program's folder (build tree), or else where it is installed. Empty
/// if there is none.
inline std::string find_module(const Module& module) {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const std::filesystem::path& place : {folder, folder / ANIMEME_MODULE_FOLDER}) {
    if (std::filesystem::exists(place / module.file, ignored)) return place / module.file;
  }
  return {};
}

/// Loads a module. `flags`: for dlopen(). Returns nullptr on failure, with the reason in `problem`.
inline void* load_module(const Module& module, int flags, std::string& problem) {
  const std::string path = find_module(module);
  if (path.empty()) {
    problem = std::string(module.file) +
              " is neither in the folder of the program nor in " ANIMEME_MODULE_FOLDER;
    return nullptr;
  }
  void* loaded = dlopen(path.c_str(), flags);
  if (loaded == nullptr) problem = dlerror();
  return loaded;
}

/// The function that every module exports: returns its table, or nullptr if the program is of
/// another version.
using ModuleEntry = const void* (*)(const char* version, std::size_t size);
/// The name of that function.
inline constexpr const char* kModuleEntry = "animeme_module";

/// Loads a module and returns its table of functions. Errors: unsupported; the message names the
/// packages to install. Callers keep the result and do not look for a missing module again.
template <class Functions>
Result<const Functions*> load_functions(const Module& module, int flags = RTLD_NOW | RTLD_LOCAL) {
  std::string problem;
  if (void* loaded = load_module(module, flags, problem)) {
    const auto entry = reinterpret_cast<ModuleEntry>(dlsym(loaded, kModuleEntry));
    const void* table = entry == nullptr ? nullptr : entry(ANIMEME_VERSION, sizeof(Functions));
    if (table != nullptr) return static_cast<const Functions*>(table);
    problem = std::string(module.file) + " is of another version";
  }
  return make_error(Code::unsupported, std::string(module.use) + " needs " + module.library +
                                           ": apt install " + module.packages + " (" + problem +
                                           ")");
}

}  // namespace animeme::tools

/// In a module: exports `table`, a variable.
#define ANIMEME_MODULE(table)                                                               \
  extern "C" [[gnu::visibility("default")]] const void* animeme_module(const char* version, \
                                                                       std::size_t size) {  \
    const bool same = size == sizeof(table) && std::strcmp(version, ANIMEME_VERSION) == 0;  \
    return same ? &(table) : nullptr;                                                       \
  }                                                                                         \
  static_assert(true)
