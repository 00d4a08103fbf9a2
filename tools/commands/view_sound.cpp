#include "tools/commands/view_sound.h"

#include <stdlib.h>

#include <filesystem>

#include "tools/commands/common.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"
#include "tools/media/mux.h"

namespace animeme::tools {

namespace {

// A folder that goes away with its content.
class WorkFolder {
 public:
  WorkFolder() {
    std::error_code ignored;
    std::string pattern =
        (std::filesystem::temp_directory_path(ignored) / "animeme-XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::string& path() const { return path_; }  // empty: there is none

 private:
  std::string path_;
};

Result<media::EncodedAudio> coded_sound(const std::string& path) {
  Result<media::EncodedAudio> coded = media::read_encoded_audio(path);
  if (coded || coded.error().code != Code::unsupported) return coded;
  std::vector<std::string> warnings;
  media::ReadAudioOptions read;
  read.warnings = &warnings;
  const Result<media::Pcm> samples = media::read_audio(path, read);
  if (!samples) return samples.error();
  for (const std::string& text : warnings) warn(path + ": " + text);
  return media::encode_audio(*samples);
}

}  // namespace

Result<viewer::Sound> page_sound(const std::string& path) {
  const Result<media::EncodedAudio> coded = coded_sound(path);
  if (!coded) return coded.error();
  const WorkFolder folder;
  if (folder.path().empty()) {
    return make_error(Code::io, "there is no folder for temporary files: set TMPDIR to one");
  }
  media::MuxInput input;
  input.encoded = &*coded;
  const std::string file = folder.path() + "/sound.mp4";
  if (const auto written = media::write_mp4(file, input); !written) return written.error();
  Result<std::vector<std::uint8_t>> bytes = read_file(file);
  if (!bytes) return bytes.error();
  return viewer::Sound{std::move(*bytes), "audio/mp4"};
}

}  // namespace animeme::tools
