// Writes the corpora of heads: make_corpus_heads tests/fuzz/corpus makes its folders gltf, picture,
// obj and points. Small files, always the same.
#include <cstdio>

#include "tests/fuzz/seeds.h"

int main(int argc, char** argv) {
  using namespace animeme::fuzz;  // NOLINT: all of it is for this
  if (argc != 2) {
    std::fprintf(stderr, "make_corpus_heads FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  make_gltf(Folder(folder / "gltf"));
  make_pictures(Folder(folder / "picture"));
  make_obj(Folder(folder / "obj"));
  make_points(Folder(folder / "points"));
  return 0;
}
