// Coded sound back to samples.
#include <algorithm>
#include <span>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/detail/sound/audio_parameters.h"
#include "tools/formats/media/detail/sound/packet_decoder.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kLongestSound = 3 * 3600;  // seconds

Result<Pcm> decode_all(const EncodedAudio& audio) {
  const av::LogCapture log;
  std::int64_t end = audio.packets.back().time + audio.packets.back().duration;
  if (audio.length > 0) end = audio.length;
  if (end / audio.format.sample_rate >= kLongestSound) {
    return make_error(Code::out_of_range, "the sound is longer than 3 hours; cut it");
  }
  PacketDecoder decoder;
  if (auto opened = decoder.open(audio.format); !opened) return opened.error();
  Pcm pcm{audio.format.sample_rate,
          std::vector<float>(std::size_t(std::max<std::int64_t>(end, 0)))};
  bool any = false;
  const auto take = [&](std::int64_t at, std::span<const float> samples) -> Result<void> {
    any = any || !samples.empty();
    for (const float sample : samples) {
      if (at >= 0 && at < end) pcm.samples[std::size_t(at)] = sample;
      ++at;
    }
    return {};
  };
  for (const AudioPacket& packet : audio.packets) {
    if (auto done = decoder.decode(&packet, take); !done) return done.error();
  }
  if (auto done = decoder.decode(nullptr, take); !done) return done.error();
  if (!any) return make_error(Code::syntax, "nothing in the sound can be decoded");
  return pcm;
}

}  // namespace

Result<Pcm> decode_audio(const EncodedAudio& audio) {
  return av::guarded([&]() -> Result<Pcm> {
    if (auto legal = check_audio(audio); !legal) return legal.error();
    return decode_all(audio);
  });
}

}  // namespace animeme::media
