#include "tools/formats/common/module.h"
#include "tools/speech/voice/espeak_internal.h"

ANIMEME_MODULE(animeme::voice::kLinkedEspeak);
