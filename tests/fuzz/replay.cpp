// Runs a fuzz target over files and folders of inputs: how CTest replays the corpora with any
// compiler. Every prefix of small inputs is run too, since truncation is the most common damage;
// not behind --whole (targets that take numbers from the bytes, where a prefix is just another
// clip, or that take long), and every 29th only behind --few.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  bool whole = false;
  std::size_t step = 1;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--whole") {
      whole = true;
      continue;
    }
    if (std::string_view(argv[i]) == "--few") {
      step = 29;
      continue;
    }
    if (std::filesystem::is_directory(argv[i])) {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    } else {
      files.emplace_back(argv[i]);
    }
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    std::fprintf(stderr, "no inputs: name files or folders\n");
    return 1;
  }
  constexpr std::size_t kSmall = 2000;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in && bytes.empty() && std::filesystem::file_size(file) > 0) {
      std::fprintf(stderr, "cannot read %s\n", file.c_str());
      return 1;
    }
    const std::size_t shortest = bytes.size() <= kSmall && !whole ? 0 : bytes.size();
    for (std::size_t size = shortest; size <= bytes.size();
         size += std::clamp<std::size_t>(bytes.size() - size, 1, step)) {
      // A copy of the exact size, so that the sanitizer sees every read past the end.
      const std::vector<std::uint8_t> copy(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
      LLVMFuzzerTestOneInput(copy.data(), copy.size());
    }
  }
  std::printf("%zu inputs replayed\n", files.size());
  return 0;
}
