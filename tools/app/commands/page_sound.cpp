#include "tools/app/commands/page_sound.h"

#include "tools/app/commands/common.h"
#include "tools/formats/programs/scratch_folder.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::tools {

Result<PageSound> page_sound(const std::string& path, const SoundSettings& settings) {
  const bool as_it_is = settings.codec.empty() && settings.bit_rate == 0;
  Result<media::EncodedAudio> coded = speech::read_coded_sound(
      path, [as_it_is](media::AudioCodec) { return as_it_is; },
      audio_settings(settings, "sound.mp4"), terminal_log());
  if (!coded) return coded.error();
  const speech::SoundInput sound{std::move(*coded), {}};
  const auto folder = ScratchFolder::make();
  if (!folder) {
    return make_error(Code::io, "there is no folder for temporary files: set TMPDIR to one");
  }
  media::MuxInput input;
  sound.give_to(input);
  const std::string file = ((*folder)->path() / "sound.mp4").string();
  if (const auto written = media::write_mp4(file, input); !written) return written.error();
  Result<std::vector<std::uint8_t>> bytes = read_file(file);
  if (!bytes) return bytes.error();
  return PageSound{{std::move(*bytes), "audio/mp4"}, sound.seconds()};
}

}  // namespace animeme::tools
