/// @file
/// People who talk to each other: where each of them looks, and when it hears the others.
///
///     std::vector<Attention> attention = attention_of(scripts);       // a script a person
///     add_idle_motion(signal, scripts[0], {.attention = &attention[0]});
///
/// They sit side by side, the first one at the left of the picture, and face the camera. Who
/// listens looks at who speaks; who speaks looks at the one who spoke before, else at who will
/// answer.
#pragma once

#include <span>
#include <vector>

#include "dam/behaviour/look.h"
#include "dam/script/script.h"

namespace animeme::dam {

/// A time in which others can be heard.
struct HeardSpan {
  double start = 0;  ///< seconds
  double end = 0;    ///< seconds, above `start`
};

/// A new target of the eyes.
struct TimedLook {
  double time = 0;  ///< seconds
  Look look;        ///< from then on
};

/// What a person attends to.
struct Attention {
  std::vector<HeardSpan> heard;  ///< ascending, apart
  std::vector<TimedLook> looks;  ///< ascending; the first one is at 0. Empty: nobody is there
};

/// Of each person, given what each says, in the order in which they sit. One person alone attends
/// to nothing.
std::vector<Attention> attention_of(std::span<const Script> people);

/// Where person `from` looks to see person `to`, another one.
Look look_to(std::size_t from, std::size_t to);

}  // namespace animeme::dam
