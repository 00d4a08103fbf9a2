#include "dam/signal/symmetry.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "dam/signal/fap_signal.h"
#include "fap/detail/symmetry.h"

namespace animeme::dam {
namespace {

/// "mouthSmileRight" of "mouthSmileLeft", "mouthSmile_L" of "mouthSmile_R"; else the name itself.
std::string other_side(const std::string& name) {
  constexpr std::string_view kSides[][2] = {{"Left", "Right"}, {"_L", "_R"}};
  for (const auto& sides : kSides) {
    for (int i = 0; i < 2; ++i) {
      if (!std::string_view(name).ends_with(sides[i])) continue;
      return name.substr(0, name.size() - sides[i].size()).append(sides[1 - i]);
    }
  }
  return name;
}

}  // namespace

std::vector<MirroredChannel> mirrored_channels(std::span<const std::string> names) {
  // Live heads ask for it with each piece of a stream: each name is parsed once.
  std::vector<int> faps;
  std::array<std::size_t, fap::kFapCount + 1> channel_of{};
  channel_of.fill(names.size());
  for (const std::string& name : names) {
    faps.push_back(fap_of_channel(name));
    std::size_t& first = channel_of[std::size_t(faps.back())];
    if (first == names.size()) first = faps.size() - 1;
  }
  std::vector<MirroredChannel> result;
  for (std::size_t own = 0; own < names.size(); ++own) {
    MirroredChannel mirrored{own, 1};
    if (faps[own] > 0) {
      const fap::internal::MirrorImage image = fap::internal::mirror_image(faps[own]);
      const std::size_t other = channel_of[std::size_t(image.fap)];
      if (other < names.size()) mirrored = {other, double(image.sign)};
    } else {
      const auto found = std::find(names.begin(), names.end(), other_side(names[own]));
      if (found != names.end()) mirrored.channel = std::size_t(found - names.begin());
    }
    result.push_back(mirrored);
  }
  return result;
}

}  // namespace animeme::dam
