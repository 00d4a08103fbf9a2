#include <array>
#include <string>
#include <utility>

#include "dam/signal/articulators_internal.h"
#include "dam/signal/fap_signal.h"
#include "fap/detail/text_scanner.h"

namespace animeme::dam {
namespace {

/// Of FAP 0 (none) to 68.
constexpr std::array<Articulator, 69> by_fap() {
  using enum Articulator;
  std::array<Articulator, 69> of{};
  for (const int fap : {3, 14, 15, 18}) of[std::size_t(fap)] = jaw;
  for (const int fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58}) of[std::size_t(fap)] = lips;
  for (const int fap : {6, 7, 53, 54}) of[std::size_t(fap)] = width;
  for (const int fap : {12, 13, 59, 60}) of[std::size_t(fap)] = corners;
  for (const int fap : {16, 17}) of[std::size_t(fap)] = forward;
  return of;
}
constexpr auto kByFap = by_fap();

/// The first that a name begins with, in any case: names of rigs.
constexpr std::pair<std::string_view, Articulator> kControlShapes[] = {
    {"jaw", Articulator::jaw},
    {"mouthstretch", Articulator::width},
    {"mouthdimple", Articulator::width},
    {"mouthsmile", Articulator::corners},
    {"mouthfrown", Articulator::corners},
    {"mouthpucker", Articulator::forward},
    {"mouthfunnel", Articulator::forward},
    {"mouth", Articulator::lips}};

}  // namespace

Articulator articulator_of(std::string_view control) {
  if (const int fap = fap_of_channel(control); fap > 0) return kByFap[std::size_t(fap)];
  const std::string name = fap::detail::lower_case(control);
  for (const auto& [begin, articulator] : kControlShapes)
    if (name.starts_with(begin)) return articulator;
  return Articulator::other;
}

}  // namespace animeme::dam
