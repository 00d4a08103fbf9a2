/// @file
/// The mood of a face that speaks: options of speak and stream.
#pragma once

#include <string>

#include "dam/script/mood.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --mood, which sets a text that dam::read_mood() accepts.
void add_mood_option(OptionTable& cli, std::string& mood);

/// The mood of that option; neutral if it was not given.
dam::Mood mood_of(const std::string& option);

}  // namespace animeme::tools
