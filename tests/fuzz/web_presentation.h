// A face and a sound for a web server that is to be attacked, and for the seeds of the attack.
#pragma once

#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "codec/encode/live.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/live.h"

namespace animeme::fuzz {

struct WebPresentation {
  media::LiveInfo info;
  std::vector<media::LiveUnit> units;  ///< a second of face, then of sound
};

inline WebPresentation web_presentation() {
  WebPresentation show;
  show.info.face_config = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47};
  fba::LiveEncoder encoder({.intra_seconds = 0.4});
  for (int i = 0; i < 25; ++i) {
    fap::Frame frame;
    for (int fap = 3; fap < 9; ++fap) frame.set(fap, 10 * ((i * fap) % 17) - 80);
    if (i % 5 == 0) {
      frame.mask.set(1);
      frame.viseme = {2, 5, 20};
    }
    auto unit = encoder.write(frame);
    if (!unit) std::abort();
    show.units.push_back(
        {media::LiveTrack::face, std::move(*unit), encoder.intra(), i * 1000, 1000});
  }
  media::Pcm tone{16000, std::vector<float>(16000)};
  for (std::size_t i = 0; i < tone.samples.size(); ++i) {
    tone.samples[i] = 0.3F * std::sin(float(i) * 0.2F);
  }
  auto sound = media::encode_audio(tone);
  if (!sound) std::abort();
  show.info.audio = sound->format;
  for (media::AudioPacket& packet : sound->packets) {
    show.units.push_back(
        {media::LiveTrack::audio, std::move(packet.bytes), false, packet.time, packet.duration});
  }
  return show;
}

}  // namespace animeme::fuzz
