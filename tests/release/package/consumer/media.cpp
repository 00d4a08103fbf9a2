// Sound at another rate, by FFmpeg.
#include <animeme/media/audio.h>

int main() {
  const animeme::media::Pcm sound{8000, std::vector<float>(800)};
  const auto out = animeme::media::resample(sound, 16000);
  return out && out->sample_rate == 16000 ? 0 : 1;
}
