// libFuzzer entry: whatever the bytes are, the readers must return within bounded memory and time.
#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/fuzz/require.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/text_track.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::media;
  const std::span<const std::uint8_t> file(data, size);
  const auto talk = read_container(file, {.max_bytes = 1 << 22, .max_units = 100000});
  if (talk) {
    for (std::size_t i = 0; i < talk->face.units.size(); ++i) {
      const auto& unit = talk->face.units[i];
      require(!unit.bytes.empty() && unit.duration > 0);
      require(i == 0 || unit.time > talk->face.units[i - 1].time);
    }
  }
  if (const auto coded = read_encoded_audio(file)) {
    for (std::size_t i = 0; i < coded->packets.size(); ++i) {
      const AudioPacket& packet = coded->packets[i];
      require(!packet.bytes.empty() && packet.duration > 0);
      require(i == 0 || packet.time > coded->packets[i - 1].time);
    }
  }
  const auto texts = read_text_tracks(file, {.most_cues = 100000, .most_bytes = 1 << 20});
  for (std::size_t t = 0; texts && t < texts->size(); ++t) {
    double before = 0;
    for (const TextCue& cue : (*texts)[t].cues) {
      require(cue.start >= before && cue.end > cue.start);
      require(!cue.text.empty() && cue.text == clean_text(cue.text));
      before = cue.end;
    }
  }
  return 0;
}
