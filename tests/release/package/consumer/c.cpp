// Links the shared library and nothing else.
#include <animeme/animeme.h>

int main() {
  animeme_decoder* decoder = nullptr;
  if (animeme_decoder_new(&decoder, nullptr) != ANIMEME_OK) return 1;
  animeme_decoder_free(decoder);
  return animeme_has("decode") == 1 ? 0 : 1;
}
