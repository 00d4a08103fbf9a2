// Sound while it is being made, with FFmpeg behind it.
#include <animeme/speech/live_sound.h>

int main() { return animeme::speech::LiveSound::open(-1, {}) ? 1 : 0; }
