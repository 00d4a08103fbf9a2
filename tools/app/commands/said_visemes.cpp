#include "tools/app/commands/said_visemes.h"

#include <algorithm>
#include <optional>

#include "dam/speaking/viseme_curves.h"
#include "fap/tables.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

namespace {

bool is_mouth(int fap) {
  const int group = fap::info(fap).group;
  return group == 2 || group == 6 || group == 8;
}

bool moves_mouth(const fap::Frame& frame) {
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (frame.mask[std::size_t(fap)] && is_mouth(fap)) return true;
  }
  return false;
}

// FAP 1 holds until another one comes, or a mouth by other FAPs: nullopt where none is shown.
std::vector<fap::VisemeWeights> by_fap_1(const fap::Sequence& coded, const fap::Sequence& shown) {
  std::vector<fap::VisemeWeights> weights;
  std::optional<fap::Viseme> held;
  std::size_t next = 0;
  bool any = false;
  for (const fap::Frame& frame : shown.frames) {
    for (; next < coded.frames.size() && coded.frames[next].number <= frame.number; ++next) {
      const fap::Frame& sent = coded.frames[next];
      if (sent.mask[1]) {
        if (sent.viseme.def) return {};
        held = sent.viseme;
      } else if (moves_mouth(sent)) {
        held.reset();
      }
    }
    fap::VisemeWeights silence{};
    silence[0] = 1;
    weights.push_back(held ? fap::coded_viseme(*held) : silence);
    any = any || weights.back()[0] < 1;
  }
  if (!any) weights.clear();
  return weights;
}

}  // namespace

void add_mouth_option(OptionTable& cli, std::string& mouth) {
  cli.add("--mouth", mouth,
          "What moves the mouth of a head with its own visemes where phones (or FAP 1) are known: "
          "these visemes, as modelled, or the FAPs")
      ->one_of(std::string(kMouthByVisemes) + " " + kMouthByFaps)
      ->show_default();
}

std::vector<fap::VisemeWeights> said_visemes(const FaceInput& input, const fap::Sequence& shown,
                                             const dam::Script& script, const std::string& mouth) {
  if (mouth == kMouthByFaps) return {};
  if (!script.phones.empty()) return dam::viseme_weights(script, shown, input.start);
  return by_fap_1(input.clip, shown);
}

}  // namespace animeme::tools
