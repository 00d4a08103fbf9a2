// Rooms made by code: noise of a few kinds at a given level, the same on every machine.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace animeme::bench {

enum class Noise {
  white,   // a fan, a bad microphone
  hum,     // pink noise and the mains with its harmonics
  babble,  // other sentences, eight at a time
  room,    // the voice itself with an echo of 0.4 s, and pink noise
};

inline constexpr Noise kNoises[] = {Noise::white, Noise::hum, Noise::babble, Noise::room};

std::string_view name_of(Noise noise);

// Noise of root mean square 1. `others` are what babble is made of, at least one.
std::vector<float> make_noise(Noise noise, std::size_t samples, std::uint64_t seed,
                              std::span<const std::vector<float>> others);

// The voice in noise: `db` is the power between the samples `first` and `last` of the voice (with
// its echo, if the room has one) to that of the noise.
std::vector<float> in_noise(const std::vector<float>& voice, std::size_t first, std::size_t last,
                            Noise noise, double db, std::uint64_t seed,
                            std::span<const std::vector<float>> others);

}  // namespace animeme::bench
