// Speech in builds without the library of models: the names are there and say that they cannot.
#include "tools/bindings/c/c_internal.h"

namespace animeme::c {

namespace {

animeme_status cannot_speak(animeme_error* error) {
  return fail(error, ANIMEME_UNSUPPORTED, "this library was built without speech");
}

template <class Handle>
animeme_status cannot_make(Handle** out, animeme_error* error) {
  if (out == nullptr) return invalid(error, "the pointer for the handle is NULL");
  *out = nullptr;
  return cannot_speak(error);
}

}  // namespace

}  // namespace animeme::c

using namespace animeme;

animeme_status animeme_model_builtin(animeme_model** model, animeme_error* error) {
  return c::cannot_make(model, error);
}

animeme_status animeme_model_read(const uint8_t*, size_t, animeme_model** model,
                                  animeme_error* error) {
  return c::cannot_make(model, error);
}

void animeme_model_free(animeme_model*) {}

const char* animeme_model_attribution(const animeme_model*) { return nullptr; }

animeme_status animeme_speak(const animeme_model*, const char*, size_t,
                             const animeme_speak_options*, animeme_clip** clip,
                             animeme_error* error) {
  return c::cannot_make(clip, error);
}

animeme_status animeme_speech_new(const animeme_model*, const animeme_speak_options*,
                                  animeme_speech** speech, animeme_error* error) {
  return c::cannot_make(speech, error);
}

void animeme_speech_free(animeme_speech*) {}

animeme_status animeme_speech_push(animeme_speech*, double, double, const char*,
                                   animeme_error* error) {
  return c::cannot_speak(error);
}

animeme_status animeme_speech_finish(animeme_speech*, animeme_error* error) {
  return c::cannot_speak(error);
}

animeme_status animeme_speech_next(animeme_speech*, animeme_frame*, animeme_error* error) {
  return c::cannot_speak(error);
}
