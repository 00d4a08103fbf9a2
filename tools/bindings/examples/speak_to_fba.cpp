// A script of phones and times to an FBA stream, by a model of yours or the built-in one:
//
//     speak_to_fba script.tsv talk.fba [me.dam]
//
// See tools/bindings/c/README.md for how to build it.
#include <animeme/animeme.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace {

struct Free {
  void operator()(animeme_model* model) const { animeme_model_free(model); }
  void operator()(animeme_clip* clip) const { animeme_clip_free(clip); }
  void operator()(std::uint8_t* bytes) const { animeme_free(bytes); }
};
template <class Handle>
using Owned = std::unique_ptr<Handle, Free>;

animeme_error error;

// The handle that a call gave out, or the end.
template <class Handle>
Owned<Handle> made(animeme_status status, Handle* handle) {
  if (status == ANIMEME_OK) return Owned<Handle>(handle);
  std::fprintf(stderr, "%s\n", error.message);
  std::exit(3);
}

std::string contents(const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path);
    std::exit(3);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

Owned<animeme_model> model_of(const char* path) {
  animeme_model* model = nullptr;
  if (path == nullptr) {
    const animeme_status status = animeme_model_builtin(&model, &error);
    return made(status, model);
  }
  const std::string bytes = contents(path);
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const animeme_status status = animeme_model_read(data, bytes.size(), &model, &error);
  return made(status, model);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: speak_to_fba script.tsv talk.fba [me.dam]\n");
    return 2;
  }
  const Owned<animeme_model> model = model_of(argc > 3 ? argv[3] : nullptr);
  const std::string script = contents(argv[1]);
  animeme_clip* clip = nullptr;
  const animeme_status spoken =
      animeme_speak(model.get(), script.data(), script.size(), nullptr, &clip, &error);
  const Owned<animeme_clip> face = made(spoken, clip);

  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  const animeme_status coded = animeme_clip_encode(face.get(), nullptr, &bytes, &size, &error);
  const Owned<std::uint8_t> stream = made(coded, bytes);
  std::ofstream out(argv[2], std::ios::binary);
  out.write(reinterpret_cast<const char*>(stream.get()), std::streamsize(size));
  out.close();
  std::printf("%zu frames, %zu bytes\n", animeme_clip_count(face.get()), size);
  return out ? 0 : 3;
}
