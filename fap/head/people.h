/// @file
/// People to choose from: built-in heads by name, changed by words behind it.
///
///     auto parameters = animeme::head::parse_head("woman:skin=5:hair=black-bob:age=60:glasses");
///     animeme::head::Head head = *animeme::head::make_head(*parameters);
///
/// A description is a name and any number of words, each after a colon:
///
/// | word | values |
/// |---|---|
/// | `skin=N` | 1 (very light) to 6 (very dark), after the phototypes of Fitzpatrick, or `#RRGGBB`
/// | | `hair=COLOUR`, `hair=FORM`, `hair=COLOUR-FORM` | kHairColours or `#RRGGBB`; kHairForms | |
/// `eyes=COLOUR` | kEyeColours or `#RRGGBB` | | `age=YEARS` | 5 to 90; default: that of the name |
/// | `glasses`, `glasses=round`, `glasses=square` | |
/// | `beard`, `beard=stubble`, `beard=full` | |
/// | `clothes=#RRGGBB` | |
///
/// A later word wins over an earlier one. Two descriptions of one head may differ; the name of the
/// head (Head::name) is the description as it was written.
#pragma once

#include <array>
#include <string_view>

#include "fap/head/model.h"
#include "fap/result.h"

namespace animeme::head {

/// Names of parse_head(): those of head_parameters() and six more people.
extern const std::array<std::string_view, 9> kPeople;
/// Names of colours behind `hair=`.
extern const std::array<std::string_view, 8> kHairColours;
/// Names of forms behind `hair=`, in the order of HairStyle.
extern const std::array<std::string_view, 7> kHairForms;
/// Names of colours behind `eyes=`.
extern const std::array<std::string_view, 6> kEyeColours;

/// Whether the text begins with a name of kPeople, alone or before a colon; it may have errors
/// behind it.
bool names_person(std::string_view text);

/// The parameters of a description. Errors: not_found (no such name), invalid_argument (an unknown
/// word, or a value outside its range), with a sentence that says what there is.
Result<HeadParameters> parse_head(std::string_view text);

}  // namespace animeme::head
