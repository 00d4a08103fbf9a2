// The functions of espeak-ng that we call, as a table of pointers: the program loads espeak-ng with
// the sound cards and desktop libraries that it brings with it when it first speaks.
#pragma once

#include <espeak-ng/speak_lib.h>

#include "fap/result.h"

namespace animeme::voice {

/// Called in child processes only: espeak-ng keeps state.
struct EspeakFunctions {
  decltype(&::espeak_Info) info;
  decltype(&::espeak_Initialize) initialize;
  decltype(&::espeak_ListVoices) list_voices;
  decltype(&::espeak_SetParameter) set_parameter;
  decltype(&::espeak_SetSynthCallback) set_synth_callback;
  decltype(&::espeak_SetVoiceByName) set_voice_by_name;
  decltype(&::espeak_Synth) synth;
};

/// The addresses of the functions. Callers link with espeak-ng.
inline constexpr EspeakFunctions kLinkedEspeak = {
    &::espeak_Info,         &::espeak_Initialize,       &::espeak_ListVoices,
    &::espeak_SetParameter, &::espeak_SetSynthCallback, &::espeak_SetVoiceByName,
    &::espeak_Synth};

/// The table. There are two definitions: that of the library (espeak_linked.cpp) is linked with
/// espeak-ng, that of the program (tools/app/late/espeak_late.cpp) loads a module with the first
/// call. Errors: unsupported (espeak-ng does not load; names the Debian packages).
const Result<const EspeakFunctions*>& espeak();

}  // namespace animeme::voice
