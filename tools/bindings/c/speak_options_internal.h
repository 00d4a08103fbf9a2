// The options of speech, which builds without it have, too. Not installed.
#pragma once

#include "tools/bindings/c/animeme.h"

namespace animeme::c {

/// What the caller wants; null: the defaults. A struct that cannot be is a failure.
animeme_status take_speak_options(const animeme_speak_options* given,
                                  animeme_speak_options& options, animeme_error* error);

}  // namespace animeme::c
