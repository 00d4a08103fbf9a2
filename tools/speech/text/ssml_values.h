/// @file
/// Values of SSML's attributes. Internal.
#pragma once

#include <optional>
#include <string_view>

#include "tools/speech/text/ssml.h"

namespace animeme::text {

/// "500ms", "2s", "0.5s" in seconds, at most 10; nothing for anything else.
std::optional<double> seconds_of(std::string_view time);

/// The pause of `break strength="..."`; nothing if there is no such strength.
std::optional<double> break_strength(std::string_view strength);

/// A rate, pitch, range or volume in percent, on top of what is around it; nothing if it is none.
std::optional<int> rate_of(std::string_view value, int around);
std::optional<int> pitch_of(std::string_view value, int around);  ///< also of a range
/// A loudness in percent, around what it was; nothing if it is none.
std::optional<int> volume_of(std::string_view value, int around);

/// Changes what `emphasis level="..."` means; false if there is no such level.
bool emphasise(std::string_view level, Manner& manner);

/// How `say-as interpret-as="..."` reads; nothing if it is not known.
std::optional<SayAs> say_as_of(std::string_view interpret_as);

}  // namespace animeme::text
