// Messages of speech services (stream --say-json), and sound of a pipe: the samples do not depend
// on the pieces in which the bytes come. The first byte says in which, the second whether they are
// a WAV.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.h"
#include "tools/speech/talking/piece_message_internal.h"
#include "tools/speech/talking/sound_bytes.h"

using animeme::test::require;

namespace {

using namespace animeme;

struct Heard {
  bool fine = true;
  int rate = 0;
  std::vector<float> samples;
};

Heard hear(std::span<const std::uint8_t> bytes, std::size_t piece,
           const std::optional<speech::BareSound>& bare) {
  Heard heard;
  speech::SoundBytes sound(bare);
  while (!bytes.empty() && heard.fine) {
    const auto part = bytes.first(std::min(piece, bytes.size()));
    bytes = bytes.subspan(part.size());
    const auto ok = sound.push(part, heard.samples);
    require(ok || !ok.error().message.empty());
    heard.fine = ok.has_value();
  }
  heard.rate = sound.sample_rate();
  return heard;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto message = speech::read_message(text);
  if (!message) {
    require(!message.error().message.empty());
  } else {
    require(message->sample_rate >= 0 && message->channels >= 0);
    require(message->bytes.size() <= size && message->text.size() <= 2 * size);
  }
  if (size < 2) return 0;
  std::optional<speech::BareSound> bare;
  if (data[1] & 1) {
    bare = speech::BareSound{.channels = 1 + (data[1] >> 1) % 16};
    if (data[1] & 0x80) bare->coding = speech::SoundCoding::mulaw;
  }
  const std::span<const std::uint8_t> bytes(data + 2, size - 2);
  const Heard whole = hear(bytes, size, bare), parts = hear(bytes, std::size_t(data[0]) + 1, bare);
  require(whole.fine == parts.fine);
  if (whole.fine) require(whole.rate == parts.rate && whole.samples.size() == parts.samples.size());
  require(whole.samples.size() <= size);
  return 0;
}
