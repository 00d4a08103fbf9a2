// What a person is doing at a moment.
#pragma once

#include <cstdint>

namespace animeme::dam::behaviour {

enum class Mode : std::uint8_t { idle, listening, thinking, speaking };

}  // namespace animeme::dam::behaviour
