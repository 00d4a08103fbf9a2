// Writes the seeds of fuzz_engines: some faces by each protocol, two senders, a goodbye, presets.
//   make_corpus_engines FOLDER
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tools/live/engines/detail/live_link.h"
#include "tools/live/engines/detail/unified.h"
#include "tools/live/engines/detail/vmc.h"

using namespace animeme;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kFrames = 16;

void add(Bytes& seed, int time, int sender, const Bytes& datagram) {
  seed.push_back(std::uint8_t(time));
  seed.push_back(std::uint8_t(sender));
  seed.push_back(std::uint8_t(datagram.size() >> 8));
  seed.push_back(std::uint8_t(datagram.size()));
  seed.insert(seed.end(), datagram.begin(), datagram.end());
}

engines::Face face_of(int frame) {
  engines::Face face;
  face.arkit[17] = 0.05 * frame;  // jawOpen
  face.arkit[53] = 0.02 * frame;  // headPitch
  face.presets[0] = 0.05 * frame;
  return face;
}

Bytes live_link(int senders) {
  Bytes seed{0};
  for (int i = 0; i < kFrames; ++i) {
    engines::LiveLinkPacket packet;
    packet.frame = 2 * i;
    packet.values = face_of(i).arkit;
    packet.face = i != 5;
    for (int sender = 0; sender < senders; ++sender) {
      packet.subject = sender == 0 ? "One" : "Two";
      packet.device = engines::device_of(packet.subject);
      if (sender == 0 && i > 12) continue;
      add(seed, i == 13 ? 255 : 16, sender, engines::write_live_link(packet));
      if (i == 13) add(seed, 255, sender, engines::write_live_link(packet));
    }
  }
  return seed;
}

Bytes vmc(engines::ShapeNames names) {
  Bytes seed{1};
  for (int i = 0; i < kFrames; ++i) {
    for (const Bytes& datagram :
         engines::osc_bundles(engines::vmc_messages(face_of(i), i / 30.0, names, true))) {
      add(seed, 8, 0, datagram);
    }
  }
  const engines::OscMessage end = engines::vmc_end();
  add(seed, 8, 0, engines::osc_bundles({&end, 1})[0]);
  return seed;
}

Bytes unified() {
  Bytes seed{5};
  engines::UnifiedWriter writer("v2");
  for (int i = 0; i < kFrames; ++i) {
    bool first = true;
    for (const Bytes& datagram : engines::osc_bundles(writer.write(face_of(i).arkit, i / 30.0))) {
      add(seed, first ? 16 : 0, 0, datagram);
      first = false;
    }
  }
  return seed;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_corpus_engines FOLDER\n");
    return 2;
  }
  const std::string folder = std::string(argv[1]) + "/";
  const std::pair<const char*, Bytes> seeds[] = {{"live_link", live_link(1)},
                                                 {"two_phones", live_link(2)},
                                                 {"vmc_arkit", vmc(engines::ShapeNames::arkit)},
                                                 {"vmc_presets", vmc(engines::ShapeNames::vrm0)},
                                                 {"unified", unified()}};
  for (const auto& [name, bytes] : seeds) {
    std::ofstream file(folder + name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!file) return 1;
  }
  return 0;
}
