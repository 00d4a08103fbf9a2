#include "dam/signal/arkit_signal.h"

#include <algorithm>
#include <cctype>

namespace animeme::dam {

fap::ArkitFrame ArkitLayout::frame(std::span<const double> row) const {
  fap::ArkitFrame values{};
  for (std::size_t c = 0; c < channel.size(); ++c)
    if (channel[c] >= 0) values[std::size_t(channel[c])] = row[c];
  return values;
}

std::optional<ArkitLayout> find_arkit_layout(std::span<const std::string> names) {
  ArkitLayout layout;
  for (const std::string& name : names) {
    const auto channel = fap::find_arkit(name);
    const bool first = channel && !layout.has[std::size_t(*channel)];
    layout.channel.push_back(first ? *channel : -1);
    if (first) layout.has.set(std::size_t(*channel));
  }
  if (layout.has.none()) return std::nullopt;
  return layout;
}

std::string arkit_spelling(int channel, std::span<const std::string> names) {
  std::string spelled(fap::kArkitNames[std::size_t(channel)]);
  bool capital = false, underscore = false;
  for (const std::string& name : names) {
    if (!fap::find_arkit(name)) continue;
    capital = capital || std::isupper(static_cast<unsigned char>(name.front())) != 0;
    underscore = underscore || name.ends_with("_L") || name.ends_with("_R");
  }
  for (const auto& [side, short_side] : {std::pair{"Left", "_L"}, std::pair{"Right", "_R"}}) {
    if (!underscore || !spelled.ends_with(side)) continue;
    spelled.replace(spelled.size() - std::string_view(side).size(), std::string::npos, short_side);
  }
  if (capital) spelled.front() = char(std::toupper(static_cast<unsigned char>(spelled.front())));
  return spelled;
}

}  // namespace animeme::dam
