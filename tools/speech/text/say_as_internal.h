// What the elements say-as and sub of SSML make of their text. Inside of utterance.cpp.
#pragma once

#include <string>

#include "tools/speech/text/said.h"

namespace animeme::text {

/// Letters and digits one by one.
Said say_apart(const Said& said);

/// Digits one by one, with a pause where something else is between.
Said say_telephone(const Said& said);

/// Other words (UTF-8) that stand for all of it; as it is if there are none.
Said say_instead(const Said& said, const std::string& words);

/// The digits of it as "5th"; as it is if there are none, or the language has no such words.
Said say_ordinal(const Said& said, const std::string& language);

/// By the order of its format: `say-as interpret-as="date" format="dmy"`; as it is if it is no
/// date.
Said say_date(const Said& said, const std::string& format, const std::string& language);

}  // namespace animeme::text
