// Compares speed and sound quality of the two searches of FFmpeg's AAC encoder: the table of
// tools/formats/media/containers.md, section 5.1.
//
//     build/release/bin/sound_table [SOUND ...]
//
// Without arguments: the sample of this project, sentences of espeak-ng, and recordings of the
// shared data if they exist.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/sound_measures.h"
#include "tests/support/shared.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/speech/voice/voice.h"

namespace {

using namespace animeme;
namespace fs = std::filesystem;

struct Material {
  std::string name;
  std::vector<media::Pcm> sounds;
};

constexpr const char* kSentences[] = {
    "The north wind and the sun were disputing which was the stronger, when a traveller came along "
    "wrapped in a warm cloak.",
    "She sells sea shells by the sea shore; the shells that she sells are sea shells, I am sure.",
    "Peter Piper picked a peck of pickled peppers."};

Material spoken() {
  Material out{"espeak-ng", {}};
  for (const char* text : kSentences) {
    const auto speech = voice::speak_text(text);
    if (speech) out.sounds.push_back(speech->audio);
  }
  return out;
}

// `count` files of a folder, at equal distances.
Material recorded(const std::string& name, const fs::path& folder, std::size_t count) {
  Material out{name, {}};
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < count && !files.empty(); ++i) {
    const auto sound = media::read_audio(files[i * files.size() / count]);
    if (sound) out.sounds.push_back(*sound);
  }
  return out;
}

struct Row {
  double cpu = 0, bits = 0, seconds = 0;
  bench::SoundDistance mean;
};

bool measure(const media::Pcm& sound, const media::AudioSettings& settings, Row& row) {
  const std::clock_t begin = std::clock();
  const auto coded = media::encode_audio(sound, settings);
  row.cpu += double(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!coded) {
    std::fprintf(stderr, "%s\n", coded.error().describe().c_str());
    return false;
  }
  const auto heard = media::decode_audio(*coded);
  if (!heard || heard->sample_rate != sound.sample_rate) {
    std::fprintf(stderr, "the sound comes back at another rate; give one that AAC has\n");
    return false;
  }
  for (const media::AudioPacket& packet : coded->packets)
    row.bits += 8.0 * double(packet.bytes.size());
  row.seconds += sound.duration();
  const auto one = bench::sound_distance(sound.samples, heard->samples, sound.sample_rate);
  const double all = double(row.mean.frames + one.frames), part = double(one.frames);
  if (all == 0) return true;
  const auto mix = [&](double& mean, double value) { mean += (value - mean) * part / all; };
  mix(row.mean.snr, one.snr);
  mix(row.mean.spectrum, one.spectrum);
  mix(row.mean.nmr, one.nmr);
  mix(row.mean.disturbed, one.disturbed);
  row.mean.frames += one.frames;
  return true;
}

struct Coder {
  const char* name;
  media::AudioSettings settings;
};

}  // namespace

int main(int count, char** arguments) {
  std::vector<Material> all;
  for (int i = 1; i < count; ++i) {
    const auto sound = media::read_audio(arguments[i]);
    if (!sound) {
      std::fprintf(stderr, "%s\n", sound.error().describe().c_str());
      return 1;
    }
    all.push_back({fs::path(arguments[i]).filename().string(), {*sound}});
  }
  if (all.empty()) {
    const fs::path sample = fs::path(test::kSourceFolder) / "tools/release/samples/voice.wav";
    if (const auto sound = media::read_audio(sample.string()))
      all.push_back({"voice.wav", {*sound}});
    all.push_back(spoken());
    const fs::path shared = test::shared_dir() / "data";
    all.push_back(recorded("GRID, one speaker", shared / "grid_s1" / "audio", 20));
    all.push_back(recorded("GRID, other speakers", shared / "grid_others" / "audio", 10));
  }
  constexpr Coder kCoders[] = {
      {"two-loop", {.bit_rate = 64000, .aac_search = media::AacSearch::two_loop}},
      {"fast", {.bit_rate = 64000, .aac_search = media::AacSearch::fast}},
      {"two-loop", {.bit_rate = 48000, .aac_search = media::AacSearch::two_loop}},
      {"fast", {.bit_rate = 48000, .aac_search = media::AacSearch::fast}}};
  std::printf(
      "| sound | seconds | rate | search | kbit/s | CPU ms/s | SNR dB | spectrum dB | NMR dB | "
      "disturbed |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Material& material : all) {
    if (material.sounds.empty()) continue;
    for (const Coder& coder : kCoders) {
      Row row;
      for (const media::Pcm& sound : material.sounds) {
        if (!measure(sound, coder.settings, row)) return 1;
      }
      std::printf("| %s | %.1f | %d | %s | %.1f | %.1f | %.1f | %.2f | %.1f | %.1f %% |\n",
                  material.name.c_str(), row.seconds, material.sounds.front().sample_rate,
                  coder.name, row.bits / row.seconds * 1e-3, row.cpu / row.seconds * 1e3,
                  row.mean.snr, row.mean.spectrum, row.mean.nmr, 100 * row.mean.disturbed);
    }
  }
  return 0;
}
