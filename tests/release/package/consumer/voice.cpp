// Voices, or the sentence that there are none: both need what stands behind them.
#include <animeme/voice/voice.h>

int main() {
  const auto voices = animeme::voice::list_voices();
  return voices ? voices->empty() : voices.error().message.empty();
}
