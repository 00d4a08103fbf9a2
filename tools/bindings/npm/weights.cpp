// What the package exports besides animeme.h: weights of visemes. And where the members of its
// structs lie, which src/structs.js has as numbers.
#include "fap/viseme.h"

#include <cstddef>

#include "fap/tables.h"
#include "tools/bindings/c/c_internal.h"

using namespace animeme;

#define LIES_AT(type, member, place) static_assert(offsetof(type, member) == place)
static_assert(sizeof(animeme_frame) == 432 && sizeof(animeme_body) == 1496);
static_assert(sizeof(animeme_error) == 512 && sizeof(animeme_speak_options) == 176);
LIES_AT(animeme_error, line, 8);
LIES_AT(animeme_error, column, 16);
LIES_AT(animeme_error, bit, 24);
LIES_AT(animeme_error, message, 32);
LIES_AT(animeme_frame, flags, 4);
LIES_AT(animeme_frame, number, 8);
LIES_AT(animeme_frame, seconds, 16);
LIES_AT(animeme_frame, rate_num, 24);
LIES_AT(animeme_frame, value, 32);
LIES_AT(animeme_frame, present, 304);
LIES_AT(animeme_frame, viseme, 372);
LIES_AT(animeme_frame, expression, 388);
LIES_AT(animeme_frame, group_rule, 412);
LIES_AT(animeme_body, value, 16);
LIES_AT(animeme_body, present, 1200);
LIES_AT(animeme_speak_options, rate_num, 4);
LIES_AT(animeme_speak_options, style, 16);
LIES_AT(animeme_speak_options, seed, 56);
LIES_AT(animeme_speak_options, look_ahead, 64);
LIES_AT(animeme_speak_options, mood, 72);
LIES_AT(animeme_speak_options, still, 136);
LIES_AT(animeme_speak_options, tongue, 168);

struct animeme_visemes {
  fap::VisemeFitter fitter;
};

extern "C" {

/// "viseme_sil" for 0, NULL outside 0..14.
const char* animeme_viseme_name(int32_t viseme) {
  return viseme >= 0 && viseme < fap::kVisemeCount ? fap::kVisemes[std::size_t(viseme)].morph.data()
                                                   : nullptr;
}

/// As animeme_arkit_new().
animeme_status animeme_visemes_new(animeme_visemes** visemes, animeme_error* error) {
  *visemes = nullptr;
  return c::guarded(error, [&] { return c::give(visemes, std::make_unique<animeme_visemes>()); });
}

void animeme_visemes_free(animeme_visemes* visemes) { delete visemes; }

/// As animeme_arkit_fit(): 15 weights.
animeme_status animeme_visemes_fit(animeme_visemes* visemes, const animeme_frame* frame,
                                   float* weights, animeme_error* error) {
  return c::guarded(error, [&]() -> animeme_status {
    fap::Frame taken;
    const auto status = c::take_frame(frame, taken, nullptr, error);
    if (status != ANIMEME_OK) return status;
    const fap::VisemeWeights fitted = visemes->fitter.fit(taken);
    for (std::size_t i = 0; i < fitted.size(); ++i) weights[i] = float(fitted[i]);
    return status;
  });
}

}  // extern "C"
