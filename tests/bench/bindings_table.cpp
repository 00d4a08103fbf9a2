// Decodes a stream in pieces of 100 bytes, again and again for a second of the CPU, by the library
// and by its C interface: the rows of C++ and C of bindings.sh.
//   bindings_table --make wide.fba     writes the stream that all of them decode
//   bindings_table wide.fba            planes a second of C++ and C
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/bench/bench_material.h"
#include "tests/bench/two_decoders.h"

namespace {

using namespace animeme;
using Stream = std::vector<std::uint8_t>;

template <class Decode>
void row(const char* name, const Stream& stream, const Decode& decode) {
  const double begin = bench::cpu_seconds();
  std::size_t planes = 0;
  double seconds = 0;
  while (seconds < 1) {
    planes += decode(stream).planes;
    seconds = bench::cpu_seconds() - begin;
  }
  std::printf("%s\t%.0f\n", name, double(planes) / seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  if (argc == 3 && option == "--make") {
    const bench::Material material = bench::wide_face();
    std::ofstream out(argv[2], std::ios::binary);
    out.write(reinterpret_cast<const char*>(material.stream.data()),
              std::streamsize(material.stream.size()));
    return out.flush() ? 0 : 1;
  }
  std::ifstream in(option, std::ios::binary);
  const Stream stream{std::istreambuf_iterator<char>(in), {}};
  if (argc != 2 || bench::decode_by_cpp(stream).planes == 0 ||
      bench::decode_by_c(stream) != bench::decode_by_cpp(stream)) {
    std::fprintf(stderr, "usage: bindings_table [--make] STREAM\n");
    return 2;
  }
  row("C++", stream, bench::decode_by_cpp);
  row("C", stream, bench::decode_by_c);
}
