// Seeds of the corpora of heads, see make_corpus_heads.cpp.
#pragma once

#include <filesystem>
#include <string>

#include "tests/support/files.h"

namespace animeme::fuzz {

using test::Bytes;

/// Where seeds go.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& path) : path_(path) {
    std::filesystem::create_directories(path);
  }
  void add(const std::string& name, const Bytes& bytes) { test::write_bytes(path_ / name, bytes); }
  void add(const std::string& name, const std::string& text) {
    add(name, Bytes(text.begin(), text.end()));
  }

 private:
  std::filesystem::path path_;
};

/// Bytes of a picture, no two neighbours alike.
inline Bytes texels(int width, int height, int channels) {
  Bytes out;
  for (int i = 0; i < width * height * channels; ++i) out.push_back(std::uint8_t(i * 37));
  return out;
}

void make_gltf(Folder folder);
void make_pictures(Folder folder);
void make_obj(Folder folder);
void make_points(Folder folder);

}  // namespace animeme::fuzz
