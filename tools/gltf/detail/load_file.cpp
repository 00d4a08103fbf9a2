#include <filesystem>
#include <fstream>
#include <iterator>

#include "tools/gltf/detail/file.h"

namespace animeme::gltf {

namespace fs = std::filesystem;

Result<Bytes> bytes_of(const std::string& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    return make_error(Code::not_found, path + " is a folder");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return make_error(Code::not_found, "there is no file " + path);
  Bytes bytes{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) return make_error(Code::io, "cannot read " + path);
  return bytes;
}

LoadFile files_of(std::string folder) {
  return [folder = std::move(folder)](const std::string& uri) -> Result<Bytes> {
    if (uri.find("://") != std::string::npos) {
      return make_error(Code::unsupported,
                        "files of the web are not loaded: save " + uri + " beside the .gltf");
    }
    const fs::path path = fs::path(uri).lexically_normal();
    if (path.is_absolute() || path.empty() || *path.begin() == "..") {
      return make_error(Code::unsupported,
                        "\"" + uri + "\" lies outside of the folder of the .gltf: move it there");
    }
    return bytes_of((fs::path(folder) / path).string());
  };
}

}  // namespace animeme::gltf
