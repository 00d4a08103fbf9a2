// Decodes a stream in pieces of 100 bytes, again and again for a second of the CPU, by the library
// and by its C interface: the rows of C++ and C of bindings.sh.
//   bindings_table --make wide.fba     writes the stream that all of them decode
//   bindings_table wide.fba            planes a second of C++ and C
#include <animeme/animeme.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "tests/bench/bench_material.h"

namespace {

using namespace animeme;
using Stream = std::vector<std::uint8_t>;

constexpr std::size_t kPiece = 100;  // bytes that arrive at a time

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
}

std::size_t planes_of_cpp(const Stream& stream) {
  fba::Decoder decoder;
  std::size_t planes = 0;
  for (std::size_t at = 0; at < stream.size(); at += kPiece) {
    decoder.push({stream.data() + at, std::min(kPiece, stream.size() - at)});
    while (const auto event = decoder.next()) planes += event->kind == fba::Event::Kind::plane;
  }
  return planes;
}

std::size_t planes_of_c(const Stream& stream) {
  animeme_decoder* decoder = nullptr;
  if (animeme_decoder_new(&decoder, nullptr) != ANIMEME_OK) return 0;
  std::size_t planes = 0;
  animeme_frame frame;
  animeme_frame_init(&frame, sizeof frame);
  for (std::size_t at = 0; at < stream.size(); at += kPiece) {
    animeme_decoder_push(decoder, stream.data() + at, std::min(kPiece, stream.size() - at),
                         nullptr);
    while (animeme_decoder_next(decoder, &frame, nullptr, nullptr) == ANIMEME_OK) ++planes;
  }
  animeme_decoder_free(decoder);
  return planes;
}

template <class Decode>
void row(const char* name, const Stream& stream, const Decode& decode) {
  const double begin = cpu_seconds();
  std::size_t planes = 0;
  double seconds = 0;
  while (seconds < 1) {
    planes += decode(stream);
    seconds = cpu_seconds() - begin;
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
  if (argc != 2 || planes_of_cpp(stream) == 0 || planes_of_c(stream) != planes_of_cpp(stream)) {
    std::fprintf(stderr, "usage: bindings_table [--make] STREAM\n");
    return 2;
  }
  row("C++", stream, planes_of_cpp);
  row("C", stream, planes_of_c);
}
