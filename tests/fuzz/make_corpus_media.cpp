// Writes the seeds of fuzz_container and fuzz_encode: make_corpus_media CORPUS. Small files in
// every container and with every switch of our writers, and clips as fuzz_encode reads them from
// bytes.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/encode/encode.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/mux.h"

namespace {

using namespace animeme;
namespace fs = std::filesystem;

fs::path g_folder;

fba::AccessUnits face(int frames, int faps, double intra_seconds) {
  fap::Sequence clip;
  clip.rate = {25, 1};
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int f = 0; f < faps; ++f) frame.set(3 + f, std::int32_t(100 * std::sin(0.3 * i + f)));
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options;
  options.intra_seconds = intra_seconds;
  options.stream.plane_start_codes = fba::PlaneStartCodes::all;
  const auto stream = fba::encode(clip, options);
  if (!stream) return {};
  auto units = fba::split_access_units(*stream);
  return units ? *units : fba::AccessUnits{};
}

media::Pcm tone(int rate, double seconds) {
  media::Pcm pcm{rate, std::vector<float>(std::size_t(rate * seconds))};
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    pcm.samples[i] = float(0.2 * std::sin(0.05 * double(i)));
  }
  return pcm;
}

int g_count = 0;

void container(const std::string& extension, const media::MuxInput& input,
               const media::MuxOptions& options) {
  fs::create_directories(g_folder / "container");
  char name[60];
  std::snprintf(name, sizeof name, "made_%02d%s", g_count++, extension.c_str());
  const auto done =
      media::write_container((g_folder / "container" / name).string(), input, options);
  if (!done) std::fprintf(stderr, "%s: %s\n", name, done.error().describe().c_str());
}

void containers() {
  const fba::AccessUnits plain = face(4, 2, 0), long_one = face(12, 5, 0.2);
  const media::Pcm sound = tone(8000, 0.15), high = tone(16000, 0.1);
  for (const char* extension : {".mp4", ".mkv", ".ts", ".m4a", ".webm"}) {
    for (const fba::AccessUnits* units : {&plain, &long_one}) {
      for (const media::Pcm* pcm : {static_cast<const media::Pcm*>(nullptr), &sound, &high}) {
        const bool takes_face =
            std::string(extension) != ".m4a" && std::string(extension) != ".webm";
        if (!takes_face && (pcm == nullptr || units != &plain)) continue;
        if (pcm == &high && units == &plain) continue;
        media::MuxInput input{.face = takes_face ? units : nullptr, .audio = pcm};
        media::MuxOptions options;
        options.audio = {media::usual_codec("a" + std::string(extension)), 12000};
        container(extension, input, options);
      }
    }
  }
  media::MuxOptions options;
  options.audio = {media::AudioCodec::aac, 12000};
  const media::MuxInput both{.face = &long_one, .audio = &sound};
  options.fragmented = true;
  options.fragment_seconds = 0.1;
  container(".mp4", both, options);
  container(".mp4", {.face = &plain}, options);
  options = {.audio = options.audio, .faststart = false};
  container(".mp4", both, options);
  options.systems = true;
  container(".mp4", both, options);
  container(".mp4", {.face = &plain}, options);
  options = {.audio = options.audio, .shared_seconds = 0.2};
  container(".ts", both, options);
  container(".ts", {.face = &long_one}, options);
  options = {.audio = {media::AudioCodec::opus, 8000}};
  for (const char* extension : {".mp4", ".mkv"}) container(extension, both, options);
  const std::vector<media::TextTrack> texts = {
      {"words", "eng", {{0.02, 0.1, "a <b>bin</b> &amp;"}, {0.1, 0.2, "\u00e9"}}},
      {"phones", "zxx", {{0.02, 0.06, "B"}, {0.06, 0.1, "IH"}}}};
  media::MuxInput spoken = both;
  spoken.texts = &texts;
  for (const char* extension : {".mp4", ".mkv"}) container(extension, spoken, options);
  options.fragmented = true;
  container(".mp4", spoken, options);
}

// fuzz_encode takes its clip and options from bytes; what a byte means depends on those before, so
// lengths and mixtures of few and many values are all that is chosen here.
void clips() {
  fs::create_directories(g_folder / "encode");
  std::uint64_t state = 42;
  const auto next = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return std::uint8_t(state >> 40);
  };
  for (int i = 0; i < 80; ++i) {
    const std::size_t size = std::size_t(24) << (i % 6);
    std::string bytes(size, '\0');
    const int kind = i / 6 % 4;
    for (std::size_t k = 0; k < size; ++k) {
      const std::uint8_t any = next();
      bytes[k] = char(kind == 0   ? any
                      : kind == 1 ? any % 8
                      : kind == 2 ? (any % 4 == 0 ? next() : 0)
                                  : (k < 40 ? any : any % 16));
    }
    bytes[0] = char(i % 2);
    char name[40];
    std::snprintf(name, sizeof name, "made_%02d", i);
    std::ofstream(g_folder / "encode" / name, std::ios::binary) << bytes;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_corpus_media CORPUS\n", stderr);
    return 2;
  }
  g_folder = argv[1];
  containers();
  clips();
  return 0;
}
