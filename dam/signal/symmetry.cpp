#include "dam/signal/symmetry.h"

#include <algorithm>
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
  std::vector<MirroredChannel> result;
  for (std::size_t own = 0; own < names.size(); ++own) {
    MirroredChannel mirrored{own, 1};
    if (const int fap = fap_of_channel(names[own]); fap > 0) {
      const fap::internal::MirrorImage image = fap::internal::mirror_image(fap);
      const auto same = [&](const std::string& n) { return fap_of_channel(n) == image.fap; };
      const auto found = std::find_if(names.begin(), names.end(), same);
      if (found != names.end()) mirrored = {std::size_t(found - names.begin()), double(image.sign)};
    } else {
      const auto found = std::find(names.begin(), names.end(), other_side(names[own]));
      if (found != names.end()) mirrored.channel = std::size_t(found - names.begin());
    }
    result.push_back(mirrored);
  }
  return result;
}

}  // namespace animeme::dam
